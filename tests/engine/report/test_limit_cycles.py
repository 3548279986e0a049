import math
from dataclasses import replace

import pytest

from engine.outcome import Outcome
from engine.spec import (
    Analysis,
)
from tests.builders import ICE_AT_40, run, source_line, stable_cycles

SHORT = Analysis(loops=(1, 2), wind_speeds=(5.0,))


def test_equilibrium_has_amplitude_zero_and_no_branch() -> None:
    equilibria = [row for row in run(source_line(2), SHORT).limit_cycles if row.kind == "equilibrium"]
    assert len(equilibria) == len(SHORT.models) * len(SHORT.loops)
    for row in equilibria:
        assert (row.vertical_m, row.horizontal_m, row.torsional_rad) == (0.0, 0.0, 0.0)
        assert row.branch is None
        assert row.frequency_hz is None


def test_non_dimensional_columns_follow_section_8() -> None:
    result = run(source_line(2), SHORT)
    (row,) = stable_cycles(result, loops=2, wind_speed=5.0)
    assert row.vertical_m is not None
    assert row.horizontal_m is not None
    assert row.vertical_ratio == pytest.approx(row.vertical_m / result.static.sag_m, rel=1e-12)
    assert row.horizontal_ratio == pytest.approx(row.horizontal_m / result.static.sag_m, rel=1e-12)
    # f is the lowest vertical frequency: that of one loop, 0.4816 Hz.
    assert row.reduced_wind_speed == pytest.approx(5.0 / (0.4816 * 125.88), rel=1e-3)


def test_orbits_are_the_series_of_their_rows() -> None:
    result = run(source_line(2), SHORT)
    periodic = [i for i, row in enumerate(result.limit_cycles) if row.kind == "periodic"]
    assert [orbit.cycle for orbit in result.orbits] == periodic
    for orbit in result.orbits:
        row = result.limit_cycles[orbit.cycle]
        pairs = ((orbit.vertical, row.vertical_m), (orbit.horizontal, row.horizontal_m))
        for series, amplitude in (*pairs, (orbit.torsional, row.torsional_rad)):
            samples = [value(series, 2.0 * math.pi * i / 2000.0) for i in range(2000)]
            assert 0.5 * (max(samples) - min(samples)) == pytest.approx(amplitude, rel=1e-3)


def value(series: tuple[float, ...], tau: float) -> float:
    """Evaluate (mean, cos 1, sin 1, ...) at a phase."""
    harmonics = range(1, len(series) // 2 + 1)
    return series[0] + sum(series[2 * k - 1] * math.cos(k * tau) + series[2 * k] * math.sin(k * tau) for k in harmonics)


def test_cycles_beyond_the_fit_say_so() -> None:
    line = source_line(2)
    narrow = replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, fitted_range=0.01)))
    wide = replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, fitted_range=3.0)))
    outcomes = [{r.outcome for r in run(x, SHORT).limit_cycles if r.kind == "periodic"} for x in (narrow, wide)]
    assert outcomes == [{Outcome.OUTSIDE_FIT}, {Outcome.CONVERGED}]
    assert any("fitted" in warning for warning in run(narrow, SHORT).warnings)


def test_a_cycle_leaves_the_fit_where_its_largest_angle_of_attack_does() -> None:
    line = source_line(2)
    angles = [row.largest_angle_of_attack_rad for row in run(line, SHORT).limit_cycles]
    known = [angle for angle in angles if angle is not None]
    middle = (min(known) + max(known)) / 2.0
    fitted = replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, fitted_range=middle)))
    rows = run(fitted, SHORT).limit_cycles
    assert [row.largest_angle_of_attack_rad for row in rows] == angles
    assert {row.outcome for row in rows if row.largest_angle_of_attack_rad is not None} == {
        Outcome.CONVERGED,
        Outcome.OUTSIDE_FIT,
    }
    for row in rows:
        if row.kind == "equilibrium":
            assert row.largest_angle_of_attack_rad is None
        else:
            assert row.largest_angle_of_attack_rad is not None
            assert (row.outcome is Outcome.OUTSIDE_FIT) == (row.largest_angle_of_attack_rad > middle)
