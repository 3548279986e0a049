"""Hours and probability of galloping a year, against Weibull's distribution and a climate drawn hour by hour."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine.analysis import analyse
from engine.outcome import Outcome
from engine.progress import finished
from engine.result import Result, RiskRow
from engine.risk.expectation import Motion, ranges_across, risk_rows, rows_over_samples
from engine.risk.winds import WindRanges
from engine.spec import Analysis, Climate, Icing, Line, Model, Ranged, Wind, WindSector
from tests.builders import source_line

SECTOR = WindSector(direction=0.0, share=1.0, shape=Ranged(2.0), scale=Ranged(6.0), width=0.0)
CLIMATE = Climate(math.radians(90.0), (SECTOR,), (Icing("glaze", 0.012, hours=Ranged(40.0)),))
EVENTS = Icing("glaze", 0.012, events=Ranged(2.0), event_hours=Ranged(20.0), persistence=Ranged(5.0))
MOTION: Motion = (Model.HYBRID, 1)
RANGES = WindRanges(((3.0, 9.0),), ())
ASKED = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(2.0, 4.0), critical_wind_limit=20.0)


def below(speed: float, shape: float = 2.0, scale: float = 6.0) -> float:
    return 1.0 - math.exp(-((speed / scale) ** shape))


def risk(ranges: WindRanges = RANGES, climate: Climate = CLIMATE) -> RiskRow:
    (row,) = rows_over_samples([{MOTION: ranges}], climate)
    return row


@cache
def analysed(line: Line) -> Result:
    return finished(analyse(line, ASKED))


def test_hours_are_those_of_icing_times_weibulls_share() -> None:
    row = risk()
    expected = 40.0 * (below(9.0) - below(3.0))
    assert (row.hours_a_year, row.hours_lowest, row.hours_highest) == pytest.approx((expected,) * 3, rel=1e-13)
    assert (row.ice, row.thickness_m, row.loops, row.unknown_hours_a_year, row.samples) == ("glaze", 0.012, 1, 0.0, 1)
    assert (row.probability_a_year, row.violation_hours_a_year) == (None, None)


def test_zero_icing_and_no_motion_give_zero_hours_and_everything_unstable_all() -> None:
    none = replace(EVENTS, events=Ranged(0.0))
    assert risk(climate=replace(CLIMATE, icing=(none,))).hours_a_year == 0.0
    assert risk(climate=replace(CLIMATE, icing=(none,))).probability_a_year == 0.0
    assert risk(WindRanges((), ())).hours_highest == 0.0
    assert risk(WindRanges(((0.0, math.inf),), ())).hours_a_year == pytest.approx(40.0, rel=1e-13)


def test_unknown_winds_count_in_the_upper_end_only() -> None:
    row = risk(WindRanges(((3.0, 9.0),), ((9.0, math.inf),)))
    assert row.hours_a_year == pytest.approx(40.0 * (below(9.0) - below(3.0)), rel=1e-13)
    assert row.unknown_hours_a_year == pytest.approx(40.0 * (1.0 - below(9.0)), rel=1e-12)
    assert row.hours_lowest == row.hours_a_year
    assert row.hours_highest == pytest.approx(40.0 * (1.0 - below(3.0)), rel=1e-13)


def test_the_ranges_of_icing_reach_the_ends() -> None:
    row = risk(climate=replace(CLIMATE, icing=(Icing("glaze", hours=Ranged(40.0, 10.0, 90.0)),)))
    share = below(9.0) - below(3.0)
    found = (row.hours_lowest, row.hours_a_year, row.hours_highest)
    assert found == pytest.approx((10.0 * share, 40.0 * share, 90.0 * share), rel=1e-13)


def test_a_year_has_galloping_if_the_wind_of_any_event_comes_into_the_range() -> None:
    row = risk(climate=replace(CLIMATE, icing=(EVENTS,)))
    share = below(9.0) - below(3.0)
    assert row.hours_a_year == pytest.approx(40.0 * share, rel=1e-13)
    assert row.probability_a_year == pytest.approx(1.0 - math.exp(-2.0 * (1.0 - (1.0 - share) ** 4)), rel=1e-13)
    assumed = risk(climate=replace(CLIMATE, icing=(replace(EVENTS, persistence=None),)))
    assert assumed.probability_lowest == pytest.approx(1.0 - math.exp(-2.0 * share), rel=1e-13)
    assert assumed.probability_highest == pytest.approx(1.0 - math.exp(-2.0 * (1.0 - (1.0 - share) ** 20)), rel=1e-13)
    assert assumed.probability_lowest is not None
    assert assumed.probability_highest is not None
    assert assumed.probability_a_year is not None
    assert assumed.probability_lowest < assumed.probability_a_year < assumed.probability_highest


def test_years_drawn_hour_by_hour_agree() -> None:
    sectors = (
        replace(SECTOR, direction=math.radians(20.0), share=0.3, width=math.radians(60.0)),
        replace(SECTOR, direction=math.radians(250.0), share=0.7, width=math.radians(90.0), scale=Ranged(9.0)),
    )
    rare = replace(EVENTS, events=Ranged(0.5))
    climate = Climate(math.radians(75.0), sectors, (rare,))
    row = risk(climate=climate)
    draw, years = np.random.default_rng(3), 40_000
    events = draw.poisson(0.5, years)
    n = 4 * int(events.sum())  # an event of 20 hours has four winds of 5 hours
    chosen = draw.random(n) < 0.3
    spread = draw.random(n) - 0.5
    angle = np.where(chosen, 20.0 + 60.0 * spread, 250.0 + 90.0 * spread) - 75.0
    across = np.where(chosen, 6.0, 9.0) * draw.weibull(2.0, n) * np.abs(np.sin(np.radians(angle)))
    gallops = ((across > 3.0) & (across < 9.0)).reshape(-1, 4)
    of_year = np.bincount(np.repeat(np.arange(years), events), weights=5.0 * gallops.sum(axis=1), minlength=years)
    assert row.hours_a_year == pytest.approx(of_year.mean(), abs=4.0 * of_year.std() / math.sqrt(years))
    assert row.probability_a_year == pytest.approx(np.mean(of_year > 0.0), abs=4.0 * math.sqrt(0.25 / years))


def test_kinds_of_ice_have_their_rows_and_one_together() -> None:
    snow = replace(EVENTS, kind="wet_snow", thickness=None, events=Ranged(1.0))
    rows = rows_over_samples([{MOTION: RANGES}], replace(CLIMATE, icing=(EVENTS, snow)))
    assert [row.ice for row in rows] == ["glaze", "wet_snow", None]
    glaze, wet, both = rows
    assert both.hours_a_year == pytest.approx(glaze.hours_a_year + wet.hours_a_year, rel=1e-13)
    assert glaze.probability_a_year is not None
    assert wet.probability_a_year is not None
    never = (1.0 - glaze.probability_a_year) * (1.0 - wet.probability_a_year)
    assert both.probability_a_year == pytest.approx(1.0 - never, rel=1e-13)


def test_samples_give_their_mean_and_an_interval_that_holds_them() -> None:
    samples = [{MOTION: WindRanges(((onset, 9.0),), ())} for onset in (3.0, 5.0, 7.0)]
    (row,) = rows_over_samples(samples, CLIMATE)
    alone = [risk(sample[MOTION]).hours_a_year for sample in samples]
    assert row.hours_a_year == pytest.approx(sum(alone) / 3.0, rel=1e-13)
    assert row.hours_lowest == pytest.approx(alone[2] + 0.05 * (alone[1] - alone[2]), rel=1e-12)
    assert row.hours_highest == pytest.approx(alone[0] - 0.05 * (alone[0] - alone[1]), rel=1e-12)
    assert row.samples == 3


def test_a_line_with_a_climate_has_its_risk_from_the_onset_on() -> None:
    line = replace(source_line(2), climate=CLIMATE)
    result = analysed(line)
    onset = result.critical_wind_speeds[0].wind_speed_m_per_s
    assert [(row.model, row.loops) for row in result.risk] == [("hybrid", 1), ("hybrid", None)]
    assert result.risk[1].hours_a_year == pytest.approx(40.0 * (below(20.0) - below(onset)), rel=1e-12)
    assert result.risk[1].unknown_hours_a_year == pytest.approx(40.0 * (1.0 - below(20.0)), rel=1e-6)
    assert analysed(source_line(2)).risk == ()
    assert risk_rows(result, line, replace(ASKED, risk=False)) == ()


def test_a_yawed_wind_needs_no_more_across_the_line() -> None:
    straight = replace(source_line(2), climate=CLIMATE)
    yawed = replace(straight, wind=Wind(1.2929, yaw=math.radians(40.0)))
    onsets = [analysed(line).critical_wind_speeds[0].wind_speed_m_per_s for line in (straight, yawed)]
    assert onsets[1] > 1.2 * onsets[0]
    moving = [ranges_across(analysed(line), line, ASKED)[MOTION].moving[0][0] for line in (straight, yawed)]
    assert moving[1] == pytest.approx(moving[0], rel=1e-6)


def test_a_statically_unstable_line_is_unknown_all_the_iced_time() -> None:
    line = replace(source_line(2), climate=CLIMATE)
    result = analysed(line)
    broken = tuple(replace(row, outcome=Outcome.STATICALLY_UNSTABLE, vertical_m=None) for row in result.limit_cycles)
    row = risk_rows(replace(result, limit_cycles=broken), line, ASKED)[-1]
    assert (row.hours_a_year, row.unknown_hours_a_year) == pytest.approx((0.0, 40.0))
    assert row.hours_highest == pytest.approx(40.0)
