"""Limit cycles of the source's lines: the twelve orbits and the trends of theory section 10."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from engine.analysis import analyse_stack
from engine.progress import finished
from engine.result import LimitCycleRow, Result
from engine.spec import Analysis, Line, Model, Span
from tests.builders import run, source_line, stable_cycles

# n, loops, wind speed: vertical [m], horizontal [m], torsional [rad]
SECTION_10 = {
    (1, 1, 4.0): (0.1303, 0.0101, 0.0895),
    (1, 1, 6.0): (0.2484, 0.0242, 0.1260),
    (1, 2, 4.0): (0.2291, 0.2124, 0.1591),
    (1, 2, 6.0): (0.5177, 0.4462, 0.3324),
    (2, 1, 4.0): (0.1568, 0.0099, 0.0020),
    (2, 1, 6.0): (0.2884, 0.0275, 0.0041),
    (2, 2, 4.0): (0.0988, 0.3571, 0.0145),
    (2, 2, 6.0): (0.1966, 0.9425, 0.0385),
    (3, 1, 4.0): (0.1560, 0.0100, 0.0027),
    (3, 1, 6.0): (0.2856, 0.0276, 0.0055),
    (3, 2, 4.0): (0.1055, 0.3568, 0.0221),
    (3, 2, 6.0): (0.2152, 0.9196, 0.0574),
}
WINDS = (4.0, 4.5, 5.0, 5.5, 6.0)
HYBRID = Analysis(models=(Model.HYBRID,), wind_speeds=WINDS)


@lru_cache
def source_result(subconductors: int) -> Result:
    """Return what the hybrid model says of a source line."""
    return run(source_line(subconductors), HYBRID)


def one_cycle(result: Result, loops: int, wind_speed: float) -> LimitCycleRow:
    """Return the only stable cycle."""
    (row,) = stable_cycles(result, loops=loops, wind_speed=wind_speed)
    return row


def amplitudes(row: LimitCycleRow) -> tuple[float, float, float]:
    """Return vertical, horizontal and torsional amplitude."""
    assert row.vertical_m is not None
    assert row.horizontal_m is not None
    assert row.torsional_rad is not None
    return row.vertical_m, row.horizontal_m, row.torsional_rad


@pytest.mark.parametrize(("key", "expected"), SECTION_10.items())
def test_section_10_orbits(key: tuple[int, int, float], expected: tuple[float, float, float]) -> None:
    subconductors, loops, wind_speed = key
    row = one_cycle(source_result(subconductors), loops, wind_speed)
    # One percent is asked for; figures are printed to 1e-4, which is 5 % of the smallest and so is added.
    for found, printed in zip(amplitudes(row), expected, strict=True):
        assert found == pytest.approx(printed, rel=0.01, abs=0.6e-4)
    assert row.observed_at_m == pytest.approx(125.88 / (2 * loops), rel=1e-3)  # arc and chord differ by 4e-4
    assert row.vertical_ratio == pytest.approx(expected[0] / 1.5419, rel=0.011)  # s_a of H = 30 kN by the catenary


@pytest.mark.parametrize("subconductors", [1, 2, 3, 4])
def test_section_10_figure_3_one_loop_is_vertical_and_two_loops_horizontal_but_for_the_single(
    subconductors: int,
) -> None:
    for wind_speed in WINDS:
        one = one_cycle(source_result(subconductors), 1, wind_speed)
        two = one_cycle(source_result(subconductors), 2, wind_speed)
        assert amplitudes(one)[0] > 7.0 * amplitudes(one)[1]
        assert (amplitudes(two)[1] > amplitudes(two)[0]) == (subconductors > 1)


@pytest.mark.parametrize("subconductors", [1, 2, 3, 4])
@pytest.mark.parametrize("loops", [1, 2])
def test_section_10_figure_7_amplitudes_grow_with_wind(subconductors: int, loops: int) -> None:
    table = np.array([amplitudes(one_cycle(source_result(subconductors), loops, w))[:2] for w in WINDS])
    assert (np.diff(table, axis=0) > 0.0).all()


def test_section_10_figure_7_number_of_subconductors_hardly_matters_at_one_loop() -> None:
    vertical = [amplitudes(one_cycle(source_result(n), 1, 5.0))[0] for n in (2, 3, 4)]
    assert max(vertical) < 1.02 * min(vertical)


def stack_at_4(lines: list[Line]) -> dict[int, list[tuple[float, float, float]]]:
    """Return for one and two loops the amplitudes of every line at 4 m/s."""
    results = finished(analyse_stack(lines, replace(HYBRID, wind_speeds=(4.0,))))
    return {k: [amplitudes(one_cycle(r, k, 4.0)) for r in results] for k in (1, 2)}


@pytest.mark.parametrize("subconductors", [2, 3, 4])
def test_section_10_figure_8_amplitudes_over_sag_grow_with_tension(subconductors: int) -> None:
    line = source_line(subconductors)
    tension = np.array([24e3, 27e3, 30e3, 33e3, 36e3])
    lines = [replace(line, span=Span(125.88, horizontal_tension=float(h))) for h in tension]
    sag = 2.379 * 9.81 * 125.88**2 / (8.0 * tension)
    for table in stack_at_4(lines).values():
        ratios = np.array(table)[:, :2] / sag[:, None]
        assert (np.diff(ratios, axis=0) > 0.0).all()


@pytest.mark.parametrize("subconductors", [2, 3, 4])
def test_section_10_figure_9_amplitudes_grow_as_the_span_shortens_against_its_sag(subconductors: int) -> None:
    line = source_line(subconductors)
    # L_x/s_a is 8 H/(p L_x): it rises as the span gets shorter, so amplitude over sag is what grows.
    lengths = np.array([200.0, 175.0, 150.0, 125.0, 100.0])
    lines = [replace(line, span=Span(float(x), horizontal_tension=30e3)) for x in lengths]
    sag = 2.379 * 9.81 * lengths**2 / (8.0 * 30e3)
    for table in stack_at_4(lines).values():
        ratios = np.array(table)[:, :2] / sag[:, None]
        assert (np.diff(ratios, axis=0) > 0.0).all()


@pytest.mark.parametrize("subconductors", [2, 3])
def test_section_10_figure_4_amplitude_falls_as_the_critical_speed_rises(subconductors: int) -> None:
    line = source_line(subconductors)
    ratios = (3e-4, 5.15e-4, 7e-4)
    lines = [replace(line, damping=replace(line.damping, vertical_ratio=z, horizontal_ratio=z)) for z in ratios]
    table = np.array([[np.hypot(a[0], a[1]) for a in rows] for rows in stack_at_4(lines).values()])
    assert (np.diff(table, axis=1) < 0.0).all()
    onsets = [run(x, replace(HYBRID, loops=(1,), wind_speeds=())).critical_wind_speeds[0] for x in lines]
    assert (np.diff([row.wind_speed_m_per_s for row in onsets]) > 0.0).all()


def test_section_7_3_triple_with_little_torsional_damping_has_two_stable_cycles_at_12() -> None:
    line = source_line(3, torsional_ratio=0.0308)
    for winds in ((12.0,), (4.0, 8.0, 12.0)):
        result = run(line, replace(HYBRID, loops=(2,), wind_speeds=winds))
        small, large = sorted(amplitudes(row)[1] for row in stable_cycles(result, loops=2, wind_speed=12.0))
        assert large / small == pytest.approx(2.0, abs=0.2)  # "differ by a factor of two"
