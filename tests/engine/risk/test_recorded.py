"""Risk of a record of iced hours: counts, exact intervals, and agreement with the climate it was drawn from."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from engine.arrays import FloatArray
from engine.outcome import InvalidSpec
from engine.result import RiskRow
from engine.risk.expectation import Motion, rows_over_samples
from engine.risk.recorded import TAIL, interval_of_sum, recorded_hours, recorded_probability
from engine.risk.winds import WindRanges
from engine.spec import Climate, IcedRecord, Icing, Model, Ranged, WindSector

RANGE = ((3.0, 9.0),)
RECORD = IcedRecord(years=4.0, events=((1.0, 4.0, 5.0), (2.0,), (10.0, 8.0)))
DRAWN = 1000
MOTION: Motion = (Model.HYBRID, 1)


def risk(climate: Climate, ranges: WindRanges) -> RiskRow:
    (row,) = rows_over_samples([{MOTION: ranges}], climate)
    return row


def test_hours_within_the_range_are_counted() -> None:
    value, lowest, highest = recorded_hours(RECORD, RANGE)
    assert value == pytest.approx(3.0 / 4.0, rel=1e-14)
    assert lowest < value < highest
    rate, _, _ = recorded_probability(RECORD, RANGE)
    assert rate == pytest.approx(1.0 - math.exp(-2.0 / 4.0), rel=1e-14)


def test_events_of_one_hour_have_poissons_exact_interval() -> None:
    record = IcedRecord(years=10.0, events=((5.0,),) * 7)
    _, lowest, highest = recorded_hours(record, RANGE)
    exact = (0.5 * chi2.ppf(0.025, 14) / 10.0, 0.5 * chi2.ppf(0.975, 16) / 10.0)
    assert (lowest, highest) == pytest.approx(exact, rel=1e-12)
    _, rare, likely = recorded_probability(record, RANGE)
    assert (rare, likely) == pytest.approx([1.0 - math.exp(-rate) for rate in exact], rel=1e-12)


def test_no_galloping_in_the_record_leaves_an_upper_end() -> None:
    value, lowest, highest = recorded_hours(RECORD, ((20.0, math.inf),))
    assert (value, lowest) == (0.0, 0.0)
    assert highest == pytest.approx(3.0 * -math.log(0.025) / 4.0, rel=1e-12)  # an event of three hours


def test_unknown_winds_are_apart_and_in_the_upper_end() -> None:
    row = risk(Climate(0.0, record=RECORD), WindRanges(RANGE, ((9.0, math.inf),)))
    assert (row.hours_a_year, row.unknown_hours_a_year, row.ice) == (0.75, 0.25, None)
    assert row.hours_highest == recorded_hours(RECORD, (*RANGE, (9.0, math.inf)))[2]
    assert row.probability_a_year == recorded_probability(RECORD, RANGE)[0]


def test_records_drawn_from_a_climate_hold_its_risk_in_their_intervals() -> None:
    sector = WindSector(direction=0.0, share=1.0, shape=Ranged(2.0), scale=Ranged(6.0), width=0.0)
    icing = Icing("glaze", events=Ranged(2.0), event_hours=Ranged(12.0), persistence=Ranged(1.0))
    known = risk(Climate(math.pi / 2, (sector,), (icing,)), WindRanges(RANGE, ()))
    assert known.probability_a_year is not None
    draw, years, held, likely = np.random.default_rng(5), 20.0, 0, 0
    for _ in range(200):
        winds = 6.0 * draw.weibull(2.0, (draw.poisson(2.0 * years), 12))
        record = IcedRecord(years, tuple(tuple(row) for row in winds.tolist()))
        row = risk(Climate(math.pi / 2, record=record), WindRanges(RANGE, ()))
        assert row.probability_lowest is not None
        assert row.probability_highest is not None
        held += row.hours_lowest <= known.hours_a_year <= row.hours_highest
        likely += row.probability_lowest <= known.probability_a_year <= row.probability_highest
    assert min(held, likely) >= 184  # 95 % of 200 are 190, two standard deviations 6


def missed(rate: float, draw: Callable[[np.random.Generator, int], FloatArray], largest: float | None) -> FloatArray:
    """Return the share of drawn sums whose interval lies above, and below, what is to be expected."""
    generator, beyond = np.random.default_rng(11), np.zeros(2)
    expected = rate * float(draw(generator, 200_000).mean())
    for _ in range(DRAWN):
        weights = draw(generator, int(generator.poisson(rate)))
        most = float(weights.max(initial=1.0)) if largest is None else largest
        _, low, high = interval_of_sum(weights, most)
        beyond += expected < low, expected > high
    return beyond / DRAWN


@pytest.mark.parametrize("rate", [1.0, 3.0, 12.0])
@pytest.mark.parametrize(
    ("draw", "largest"),
    [
        (lambda generator, n: np.full(n, 3.0), 3.0),
        (lambda generator, n: generator.integers(1, 25, n).astype(float), 24.0),
        (lambda generator, n: np.where(generator.random(n) < 0.1, 48.0, 2.0), 48.0),
    ],
)
def test_intervals_of_sums_miss_at_either_end_as_rarely_as_they_say(
    draw: Callable[[np.random.Generator, int], FloatArray], largest: float, rate: float
) -> None:
    deviation = math.sqrt(TAIL * (1.0 - TAIL) / DRAWN)
    assert (missed(rate, draw, largest) <= TAIL + 3.0 * deviation).all()


def test_a_record_of_few_events_does_not_know_its_longest() -> None:
    above, below = missed(3.0, lambda generator, n: generator.geometric(0.1, n).astype(float), None)
    assert above <= TAIL
    assert 2.0 * TAIL < below < 0.2


@pytest.mark.parametrize(
    ("climate", "field", "word"),
    [
        (lambda: Climate(0.0, record=replace(RECORD, events=())), "climate.record.events", "must hold an event"),
        (lambda: Climate(0.0, record=replace(RECORD, events=((),))), "climate.record.events.0", "must hold an hour"),
        (lambda: Climate(0.0, record=replace(RECORD, years=0.0)), "climate.record.years", "greater than zero"),
        (lambda: Climate(0.0, record=replace(RECORD, years=1e-4)), "climate.record.years", "must hold the 6 hours"),
        (lambda: Climate(0.0, record=IcedRecord(1.0, ((-1.0,),))), "climate.record.events.0.0", "at least zero"),
        (lambda: Climate(0.0, icing=(Icing("x", hours=Ranged(1.0)),), record=RECORD), "climate.icing", "absent"),
    ],
)
def test_a_record_that_cannot_be_names_its_field(climate, field: str, word: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InvalidSpec) as error:
        climate()
    assert [fault.field for fault in error.value.faults if word in fault.rule] == [field]
