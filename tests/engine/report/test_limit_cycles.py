import math
from dataclasses import replace

import pytest

from engine.models.relative_wind import FASTEST
from engine.outcome import Outcome
from engine.spec import AerodynamicModel, Analysis, Line, Model
from tests.builders import ICE_AT_40, only, run, source_line, stable_cycles

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
        assert len(orbit.vertical) == 2 * (result.limit_cycles[orbit.cycle].harmonics or 0) + 1
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


def driven(torsional_ratio: float, drag: float) -> Line:
    line = source_line(2, torsional_ratio=torsional_ratio)
    return replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, at_rest=(0.0, drag, 0.0))))


@pytest.mark.parametrize("model", [AerodynamicModel.PUBLISHED, AerodynamicModel.RELATIVE_WIND])
def test_largest_velocity_is_that_of_the_fastest_sub_conductor(model: AerodynamicModel) -> None:
    """At mid-span of a cycle in one loop, where V is largest and Theta' adds r Theta' to it."""
    asked = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(6.0,), aerodynamic_model=model)
    result = run(driven(0.308, 1.0), asked)
    (orbit,) = result.orbits
    row = result.limit_cycles[orbit.cycle]
    assert row.frequency_hz is not None
    rate = 2.0 * math.pi * row.frequency_hz / 6.0
    largest = 0.0
    for tau in (2.0 * math.pi * i / 2000.0 for i in range(2000)):
        v, w, theta = (rate * value(slope(of), tau) for of in (orbit.vertical, orbit.horizontal, orbit.torsional))
        largest = max(largest, *(math.hypot(v - z * theta, w) for z in (-0.2355, 0.2355)))
    assert row.largest_velocity_ratio == pytest.approx(largest, rel=3e-3)


def slope(series: tuple[float, ...]) -> tuple[float, ...]:
    """Differentiate (mean, cos 1, sin 1, ...) by the phase."""
    pairs = ((k * series[2 * k], -k * series[2 * k - 1]) for k in range(1, len(series) // 2 + 1))
    return (0.0, *(number for pair in pairs for number in pair))


def test_a_cycle_beyond_the_range_of_the_expanded_load_says_so() -> None:
    """A steep lift curve without drag drives the motion beyond the velocities up to which the expansion holds."""
    asked = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(2.5, 6.0))
    fast = replace(asked, aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
    line = driven(0.308, 0.0)
    steep = replace(line.ice.aerodynamics, vertical=(-2.0, 0.0, 8.0))
    result = run(replace(line, ice=replace(line.ice, aerodynamics=steep)), fast)
    cycles = [row for row in result.limit_cycles if row.kind == "periodic"]
    assert cycles
    for row in cycles:
        assert row.largest_velocity_ratio is not None
        assert (row.outcome is Outcome.OUTSIDE_FIT) == (row.largest_velocity_ratio > FASTEST)
    count = sum(row.outcome is Outcome.OUTSIDE_FIT for row in cycles)
    assert count
    assert any(text.startswith(f"In {count} cycles a sub-conductor moves faster") for text in result.warnings)


def test_a_stable_cycle_larger_than_the_sag_keeps_its_numbers_and_says_what_it_is() -> None:
    line = source_line(2)
    wide = replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, fitted_range=3.0)))
    for x in (line, wide):
        result = run(x, only(Model.HYBRID, loops=(2,), wind_speeds=(6.0, 10.0)))
        small, large = (stable_cycles(result, loops=2, wind_speed=wind)[0] for wind in (6.0, 10.0))
        assert (small.horizontal_ratio, large.horizontal_ratio) == pytest.approx((0.615, 1.787), abs=2e-3)
        assert (small.outcome, large.outcome) == (Outcome.CONVERGED, Outcome.BEYOND_DATA)
        assert sum("over the static sag" in warning for warning in result.warnings) == 1


def test_an_unstable_cycle_beyond_thirty_degrees_has_its_outcome_but_no_warning() -> None:
    result = run(source_line(1), only(Model.HYBRID, loops=(1,), wind_speeds=(6.0,)))
    (row,) = (row for row in result.limit_cycles if row.stability == "unstable" and row.kind == "periodic")
    assert row.largest_angle_of_attack_rad == pytest.approx(0.847, abs=2e-3)
    assert row.outcome is Outcome.BEYOND_DATA
    assert not any("vouch for" in warning for warning in result.warnings)


def test_a_wind_speed_without_a_stable_motion_says_so_whatever_its_unstable_cycles_are() -> None:
    # With the cubic coefficient of lift turned round the cycle is unstable: it bounds the basin of rest, and beyond the
    # critical wind speed nothing bounds the motion.
    line = source_line(2)
    lift = (ICE_AT_40.vertical[0], ICE_AT_40.vertical[1], -ICE_AT_40.vertical[2])
    line = replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, vertical=lift)))
    result = run(line, only(Model.HYBRID, loops=(1,), wind_speeds=(2.0, 6.0)))
    for wind in (2.0, 6.0):
        rows = [row for row in result.limit_cycles if row.wind_speed_m_per_s == wind]
        stable = any(row.stability == "stable" for row in rows)
        missing = [row.outcome for row in rows if row.vertical_m is None]
        assert stable != bool(missing)
        assert missing in ([], [Outcome.NO_BOUNDED_MOTION])
