"""Clearances to phases that no spacer ties, from computed motions and by ellipses."""

from dataclasses import replace

import numpy as np
import pytest

from engine.clearance import EllipseMethod, galloping_ellipse
from engine.report.phases.clearances import with_clearances
from engine.result import Orbit, PhaseClearanceRow, Result
from engine.spec import Line, Model, Phase
from tests.builders import only, run, source_line

LINE = replace(source_line(1), required_clearance=5.0)
ASKED = only(Model.HYBRID, wind_speeds=(4.0,), loops=(1,))


def of_motion(line: Line, vertical: float, horizontal: float = 0.0) -> list[PhaseClearanceRow]:
    """Return the rows of a made-up motion V = vertical cos(t), W = horizontal sin(t)."""
    base = run(LINE, ASKED)
    row = next(r for r in base.limit_cycles if r.kind == "periodic")
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
