"""Rows of static equilibria over whole analyses."""

import math
from dataclasses import replace

import pytest

from engine.mechanics.coefficients import fit_measured
from engine.outcome import Outcome
from engine.spec import Analysis, Line, Model, StaticTwist
from tests.builders import run, source_line
from tests.engine.synthetic_table import measured, with_table

SOLVED = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(4.0, 10.0), static_twist=StaticTwist.SOLVED)


def light(line: Line) -> Line:
    """Return a line whose ice does not turn it in still air."""
    return replace(line, ice=replace(line.ice, eccentricity_y=0.0, eccentricity_z=0.0))


def test_equilibria_have_a_row_at_every_wind_speed() -> None:
    rows = run(light(with_table(source_line(1), 20.0)), SOLVED).static_equilibria
    assert [row.wind_speed_m_per_s for row in rows if row.equilibrium == 0] == [4.0, 10.0]
    assert {row.outcome for row in rows} == {Outcome.CONVERGED}
    for row in rows:
        assert row.twist_rad is not None
        assert row.largest_twist_rad == pytest.approx(row.twist_rad, rel=1e-6)
    assert abs(rows[-1].twist_rad or 0.0) > abs(rows[0].twist_rad or 0.0)


def test_the_twist_in_the_wind_comes_upon_that_in_still_air() -> None:
    """A section that the ice has turned stands at another angle of its table: as if it had been given there."""
    line = with_table(source_line(2), 20.0)
    result = run(line, SOLVED)
    assert result.static.twist_rad is not None
    still = math.degrees(result.static.twist_rad)
    given = run(light(with_table(source_line(2), 20.0 + still)), SOLVED)
    assert abs(still) > 0.05
    for row, expected in zip(result.static_equilibria, given.static_equilibria, strict=True):
        assert row.twist_rad == pytest.approx(expected.twist_rad, rel=0.03)


def test_lines_without_a_table_and_analyses_without_the_twist_have_no_rows() -> None:
    assert run(source_line(1), SOLVED).static_equilibria == ()
    assert (
        run(with_table(source_line(2), 20.0), replace(SOLVED, static_twist=StaticTwist.NEGLECTED)).static_equilibria
        == ()
    )


def test_a_table_with_a_gap_is_named_in_a_warning() -> None:
    whole = measured(20.0)
    kept = [i for i, angle in enumerate(whole.angle) if not -1.2 < angle < -0.8]
    angle, lift, drag, moment = (
        tuple(column[i] for i in kept) for column in (whole.angle, whole.lift, whole.drag, whole.moment)
    )
    table = replace(whole, angle=angle, lift=lift, drag=drag, moment=moment)
    line = source_line(2)
    line = replace(line, ice=replace(line.ice, aerodynamics=fit_measured(table)))
    result = run(line, SOLVED)
    assert result.static_equilibria == ()
    (sentence,) = (text for text in result.warnings if "gap" in text)
    assert "ice.aerodynamics.table" in sentence
