"""Wind speeds at which a required clearance is broken: between those asked for, and what is not known of them."""

import math
from dataclasses import replace
from functools import cache

import pytest

from engine.analysis import analyse
from engine.outcome import Stability
from engine.progress import finished
from engine.result import PhaseClearanceRow, Result
from engine.risk.expectation import risk_rows
from engine.risk.violations import asks_for_clearance, violation_ranges
from engine.risk.winds import WindRanges
from engine.spec import Analysis, Climate, Icing, Line, Model, Ranged, WindSector
from tests.builders import source_line

WINDS = (2.0, 4.0, 6.0, 8.0)
ASKED = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=WINDS, critical_wind_limit=20.0)
RANGES = WindRanges(((3.0, 20.0),), ((20.0, math.inf),))
SECTOR = WindSector(direction=0.0, share=1.0, shape=Ranged(2.0), scale=Ranged(6.0), width=0.0)
LINE: Line = replace(source_line(2), climate=Climate(0.5 * math.pi, (SECTOR,), (Icing("glaze", hours=Ranged(40.0)),)))


@cache
def analysed() -> Result:
    return finished(analyse(LINE, ASKED))


def row(wind: float, ok: bool | None, *, required: float | None = 1.5, loops: int = 1) -> PhaseClearanceRow:
    return PhaseClearanceRow(
        phase="this",
        other_phase="top",
        method="computed",
        together="any phase angle",
        model="hybrid",
        loops=loops,
        wind_speed_m_per_s=wind,
        branch=0,
        stability=Stability.STABLE,
        position_m=60.0,
        distance_m=1.0,
        required_m=required,
        margin_m=-0.5,
        ok=ok,
    )


def found(*rows: PhaseClearanceRow) -> WindRanges:
    return violation_ranges(replace(analysed(), clearances=rows), ASKED, Model.HYBRID, 1, RANGES)


def test_it_is_broken_between_winds_at_which_it_is_and_unknown_beside_them() -> None:
    answer = found(row(4.0, True), row(6.0, False), row(8.0, False))
    assert answer == WindRanges(((6.0, 8.0),), ((4.0, 6.0), (8.0, 20.0), (20.0, math.inf)))


def test_from_rest_to_a_motion_that_keeps_it_nothing_breaks_it() -> None:
    kept = found(row(4.0, True), row(6.0, True), row(8.0, True))
    assert kept == WindRanges((), ((8.0, 20.0), (20.0, math.inf)))
    assert found(row(4.0, False), row(6.0, False), row(8.0, False)).unknown[0] == (3.0, 4.0)


def test_galloping_without_a_clearance_is_unknown() -> None:
    answer = found(row(4.0, None), row(6.0, True, loops=2))
    assert answer.moving == ()
    assert [part for part in answer.unknown if part[0] < 8.0] == [(3.0, 4.0), (4.0, 6.0), (6.0, 8.0)]


def test_hours_of_violation_are_weibulls_share_of_the_broken_winds() -> None:
    clearances = (row(4.0, True), row(6.0, False), row(8.0, False))
    (risk, _) = risk_rows(replace(analysed(), clearances=clearances), LINE, ASKED)
    above = [math.exp(-((wind / 6.0) ** 2)) for wind in (4.0, 6.0, 8.0)]
    assert risk.violation_hours_a_year == pytest.approx(40.0 * (above[1] - above[2]), rel=1e-12)
    assert risk.violation_hours_highest == pytest.approx(40.0 * above[0], rel=1e-12)
    assert risk.hours_a_year > 40.0 * above[0]
    unasked = replace(analysed(), clearances=(row(4.0, None, required=None),))
    assert not asks_for_clearance(unasked)
    assert risk_rows(unasked, LINE, ASKED)[0].violation_hours_a_year is None
