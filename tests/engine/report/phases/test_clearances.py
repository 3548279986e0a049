"""Clearances to phases that no spacer ties, from computed motions and by ellipses."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine.clearance import EllipseMethod, galloping_ellipse
from engine.report.phases.clearances import with_clearances
from engine.result import Orbit, PhaseClearanceRow, Result
from engine.spec import BlowOut, Line, Model, Phase
from tests.builders import only, run, source_line

LINE = replace(source_line(1), required_clearance=5.0)
ASKED = only(Model.HYBRID, wind_speeds=(4.0,), loops=(1,))


def of_motion(line: Line, vertical: float, horizontal: float = 0.0, loops: int = 1) -> list[PhaseClearanceRow]:
    """Return the rows of a made-up motion V = vertical cos(t), W = horizontal sin(t)."""
    base = run(LINE, ASKED)
    row = next(r for r in base.limit_cycles if r.kind == "periodic")
    row = replace(row, loops=loops, observed_at_m=LINE.span.length / (2.0 * loops))
    orbit = Orbit(0, (0.0, vertical, 0.0), (0.0, 0.0, horizontal), (0.0, 0.0, 0.0))
    result: Result = with_clearances(replace(base, limit_cycles=(row,), orbits=(orbit,)), line)
    return [row for row in result.clearances if row.method == "computed"]


def test_copies_gallop_alike_at_any_phase_angle() -> None:
    (row,) = of_motion(replace(LINE, phases=(Phase("top", 7.0, 0.0),)), 0.8)
    assert (row.phase, row.other_phase, row.together) == ("this", "top", "any phase angle")
    assert row.distance_m == pytest.approx(7.0 - 2.0 * 0.8, rel=1e-4)
    assert row.margin_m == pytest.approx(0.4, rel=1e-3)
    assert row.ok is True
    (beside,) = of_motion(replace(LINE, phases=(Phase("side", 0.0, 6.0),)), 0.8, 0.3)
    assert beside.distance_m == pytest.approx(6.0 - 2.0 * 0.3, rel=1e-4)


def test_a_phase_with_ice_of_its_own_rests_as_it_hangs() -> None:
    slack = replace(source_line(1), span=replace(LINE.span, horizontal_tension=20_000.0))
    rows = of_motion(replace(LINE, phases=(Phase("low", -7.0, 0.0, line=slack), Phase("top", 7.0, 0.0))), 0.8)
    low = next(row for row in rows if row.other_phase == "low")
    # twice the rise over 8 c: the sag grows with the weight over the tension
    deeper = 2.379 * 9.81 * 125.88**2 / 8.0 * (1.0 / 20e3 - 1.0 / 30e3)
    assert low.together == "at rest"
    assert low.distance_m == pytest.approx(7.0 + deeper - 0.8, rel=2e-4)
    assert {(row.phase, row.other_phase) for row in rows} == {("this", "low"), ("this", "top"), ("low", "top")}


def test_ellipses_of_equal_phases_above_each_other_leave_the_spacing_less_the_major_axis() -> None:
    result = run(replace(LINE, phases=(Phase("top", 7.0, 0.0),)), ASKED)
    rows = {str(row.method): row for row in result.clearances if row.method != "computed"}
    assert set(rows) == {"davison", "toye", "cigre", "aeso"}
    for method in (EllipseMethod.DAVISON, EllipseMethod.TOYE):
        ellipse = galloping_ellipse(method, result.static.sag_m, 125.88, 0.0286, 1)
        assert ellipse is not None
        assert rows[method.value].distance_m == pytest.approx(7.0 - ellipse.major_axis, rel=1e-4)
    assert (rows["toye"].loops, rows["davison"].loops) == (2, 1)
    assert rows["davison"].wind_speed_m_per_s is None
    cigre = galloping_ellipse(EllipseMethod.CIGRE, result.static.sag_m, 125.88, 0.0286, 1)
    assert (cigre is None) == (rows["cigre"].distance_m is None)


def test_the_verdict_tells_the_smallest_distance_of_stable_motions() -> None:
    line = replace(LINE, phases=(Phase("top", 7.0, 0.0), Phase("low", -6.0, 0.0)))
    result = run(line, ASKED)
    known = [row.distance_m or np.inf for row in result.clearances if row.stability == "stable"]
    assert result.verdict[0].clearance_m == min(known)
    assert result.verdict[0].clearance_ok is True
    assert result.verdict[0].clearance_margin_m == min(
        row.margin_m
        for row in result.clearances
        if row.margin_m is not None and row.method == "computed" and row.stability == "stable"
    )
    assert f"; keeps {min(known):.1f} m to the next phase" in result.verdict[0].sentence
    unasked = run(replace(line, required_clearance=None), ASKED)
    assert unasked.verdict[0].clearance_ok is None
    assert unasked.verdict[0].clearance_margin_m is None
    assert unasked.verdict[0].clearance_m == min(known)


def test_beside_a_phase_that_hangs_otherwise_the_nearest_place_is_sought() -> None:
    slack = replace(source_line(1), span=replace(LINE.span, horizontal_tension=10_000.0))
    (row,) = of_motion(replace(LINE, phases=(Phase("top", 9.0, 0.0, line=slack),)), 0.8, loops=2)
    deeper = 2.379 * 9.81 * 125.88**2 / 8.0 * (1.0 / 10e3 - 1.0 / 30e3)
    share = np.arange(17) / 16.0
    left = 9.0 - 4.0 * deeper * share * (1.0 - share) - 0.8 * np.abs(np.sin(2.0 * np.pi * share))
    assert row.distance_m == pytest.approx(left.min(), rel=2e-3)
    assert row.position_m == pytest.approx(125.88 * share[left.argmin()])
    assert row.position_m not in (None, pytest.approx(125.88 / 4.0))


@pytest.mark.parametrize("given", [20.0, None])
def test_phases_are_swung_by_the_wind_each_by_its_own_weight(given: float | None) -> None:
    windy = replace(LINE, wind=replace(LINE.wind, blow_out=BlowOut(given, 1.0)))
    light = replace(windy, conductor=replace(LINE.conductor, mass=1.0), required_clearance=None)
    line = replace(windy, phases=(Phase("copy", 7.0, 0.0), Phase("light", 14.0, 0.0, line=light)))
    copy, other, _ = of_motion(line, 0.8)
    speed = 20.0 if given is not None else 4.0
    drag = 0.5 * LINE.wind.air_density * speed**2 * LINE.conductor.diameter
    swings = [math.atan(drag / (mass * 9.81)) for mass in (2.379, 1.0)]
    assert copy.distance_m == pytest.approx(7.0 - 2.0 * 0.8, rel=1e-4)
    assert copy.span_swing_angle_deg == pytest.approx(math.degrees(swings[0]), rel=1e-3)
    sags = [
        mass * 9.81 / math.cos(swing) * 125.88**2 / (8.0 * 30e3)
        for mass, swing in zip((2.379, 1.0), swings, strict=True)
    ]
    beside = sags[0] * math.sin(swings[0]) - sags[1] * math.sin(swings[1])
    above = 14.0 + sags[0] * math.cos(swings[0]) - sags[1] * math.cos(swings[1])
    assert other.distance_m == pytest.approx(math.hypot(above, beside) - 0.8, rel=0.02)


def test_ellipses_have_the_columns_of_reports() -> None:
    result = run(replace(LINE, phases=(Phase("top", 1.0, 0.0),)), ASKED)
    rows = {str(row.method): row for row in result.clearances if row.method != "computed"}
    sag = result.static.sag_m
    davison = rows["davison"]
    assert davison.ahead_span_length_m == 125.88
    assert davison.mid_span_sag_m == pytest.approx(sag)
    assert davison.major_axis_m == pytest.approx(1.25 * sag + 0.3048)
    assert davison.minor_axis_m == pytest.approx(0.4 * (1.25 * sag + 0.3048))
    assert davison.b_distance_m == pytest.approx(0.25 * sag)
    assert davison.distance_m is not None
    assert davison.distance_m < 0.0
    assert davison.overlap_m == -davison.distance_m
    computed = next(row for row in result.clearances if row.method == "computed")
    assert computed.major_axis_m is None
    assert computed.mid_span_sag_m == pytest.approx(sag)


def test_a_quasi_periodic_motion_is_within_the_box_of_its_ranges() -> None:
    base = run(LINE, ASKED)
    row = next(r for r in base.limit_cycles if r.kind == "periodic")
    ranges: dict[str, Any] = {"vertical_m": 0.8, "horizontal_m": 0.3, "torsional_rad": 0.0}
    middles: dict[str, Any] = {"vertical_middle_m": 0.1, "horizontal_middle_m": -0.05, "torsional_middle_rad": 0.0}
    torus = replace(row, kind="quasi_periodic", **ranges, **middles)
    line = replace(LINE, phases=(Phase("top", 7.0, 0.0), Phase("side", 0.0, 6.0)))
    found = with_clearances(replace(base, limit_cycles=(torus,), orbits=()), line)
    rows = [row for row in found.clearances if row.method == "computed" and row.phase == "this"]
    assert [row.distance_m for row in rows] == pytest.approx([7.0 - 2.0 * 0.8, 6.0 - 2.0 * 0.3], rel=1e-4)
    resting = replace(line, phases=(Phase("top", 7.0, 0.0, ice=replace(LINE.ice, eccentricity_y=1e-3)),))
    found = with_clearances(replace(base, limit_cycles=(torus,), orbits=()), resting)
    assert found.clearances[0].distance_m == pytest.approx(7.0 - 0.9, rel=1e-4)
