"""Dynamic tensions of cycles against the tension of the span at every instant."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.outcome import Outcome
from engine.spec import AerodynamicModel, Analysis, Line, LongitudinalInertia, Model, Stretching
from tests.builders import run, source_line

ASKED = Analysis(
    loops=(1, 2),
    models=(Model.HYBRID,),
    wind_speeds=(6.0,),
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    aerodynamic_model=AerodynamicModel.RELATIVE_WIND,
    stretching=Stretching.INCLUDED,
)


def iced(rated_strength: float | None = None) -> Line:
    """Return the source's twin line with coefficients at rest."""
    line = source_line(2)
    aerodynamics = replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))
    conductor = replace(line.conductor, rated_strength=rated_strength)
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics), conductor=conductor)


def test_every_cycle_has_a_row_with_the_support_steeper_than_mid_span() -> None:
    result = run(iced(140e3), ASKED)
    moving = [row for row in result.limit_cycles if row.kind != "equilibrium"]
    assert len(result.tensions) == len(moving) > 1
    static = result.static
    steepness = math.cosh(125.88 / 2.0 / static.catenary_parameter_m)
    for row in result.tensions:
        assert row.outcome is Outcome.CONVERGED
        assert row.smallest_horizontal_n is not None
        assert row.largest_horizontal_n is not None
        assert row.smallest_horizontal_n < static.horizontal_tension_n < row.largest_horizontal_n
        assert row.largest_at_support_n == pytest.approx(steepness * row.largest_horizontal_n)
        assert row.largest_share_of_rated_strength == pytest.approx(steepness * row.largest_horizontal_n / 140e3)


def test_the_range_is_that_of_many_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = run(iced(), ASKED).tensions
    monkeypatch.setattr("engine.report.tensions.SAMPLES", 4096)
    for row, fine in zip(rows, run(iced(), ASKED).tensions, strict=True):
        ends = [(one.smallest_horizontal_n or 0.0, one.largest_horizontal_n or 0.0) for one in (row, fine)]
        assert ends[0] == pytest.approx(ends[1], rel=0.0, abs=1e-4 * (ends[1][1] - ends[1][0]))


def test_without_a_rated_strength_there_is_no_share_of_it() -> None:
    result = run(iced(), ASKED)
    assert {row.largest_share_of_rated_strength for row in result.tensions} == {None}


def test_neglected_stretching_has_no_tensions() -> None:
    asked = replace(ASKED, stretching=Stretching.NEGLECTED)
    assert run(iced(), asked).tensions == ()


def test_a_conductor_that_would_go_slack_has_no_tension_and_says_so() -> None:
    line = replace(iced(), span=replace(source_line(2).span, horizontal_tension=3000.0))
    stiff = replace(line, supports=replace(line.supports, longitudinal_stiffness=1e7))
    result = run(stiff, replace(ASKED, wind_speeds=(25.0,)))
    slack = [row for row in result.tensions if row.outcome is Outcome.SLACK]
    assert slack
    assert {row.largest_horizontal_n for row in slack} == {None}
    outcomes = {row.outcome for row in result.limit_cycles}
    assert Outcome.SLACK in outcomes
    assert np.isfinite(result.static.sag_m)
