"""The risk over samples, held to a span whose onset is a formula."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine.progress import finished
from engine.result import Result
from engine.risk.winds import WindRanges
from engine.spec import Climate, Icing, Model, Ranged, Uncertainty, WindSector
from engine.uncertainty.outcomes import State, without_answer
from engine.uncertainty.risk import risk_over_samples
from engine.uncertainty.weighing import analyse_with_samples
from tests.engine.uncertainty.den_hartog_line import ASKED, INPUTS, UNKNOWNS, constant, line_of

SECTOR = WindSector(direction=0.0, share=1.0, shape=Ranged(2.0), scale=Ranged(6.0), width=0.0)
CLIMATE = Climate(0.5 * math.pi, (SECTOR,), (Icing("glaze", hours=Ranged(40.0)),))


@cache
def weighed() -> Result:
    line = replace(line_of({}), climate=CLIMATE)
    return finished(analyse_with_samples(line, ASKED, UNKNOWNS, Uncertainty(128, 1)))


def test_expected_hours_are_those_of_quadrature_over_the_assumptions() -> None:
    ratio, density, factor = (each.at(np.linspace(0.005, 0.995, 100)) for each in INPUTS)
    onsets = constant() * ratio[:, None, None] / (density[:, None] * factor)
    limit = ASKED.critical_wind_limit
    hours = 40.0 * np.maximum(np.exp(-((onsets / 6.0) ** 2)) - math.exp(-((limit / 6.0) ** 2)), 0.0)
    row = next(row for row in weighed().risk if row.loops == 1)
    assert row.samples == 128
    assert row.hours_a_year == pytest.approx(hours.mean(), rel=0.02)
    assert row.hours_lowest == pytest.approx(np.quantile(hours, 0.025), abs=0.6)
    assert row.hours_lowest < row.hours_a_year < row.hours_highest


def test_without_a_climate_there_is_no_risk() -> None:
    result = finished(analyse_with_samples(line_of({}), ASKED, UNKNOWNS, Uncertainty(4, 1)))
    assert result.risk == ()


def test_a_sample_without_an_answer_is_unknown_and_an_impossible_one_left_out() -> None:
    moving = replace(without_answer(State.GALLOPS, 1), ranges={(Model.HYBRID, 1): WindRanges(((0.0, math.inf),), ())})
    samples = [moving, without_answer(State.UNKNOWN, 1), without_answer(State.IMPOSSIBLE, 1)]
    (row,) = risk_over_samples((), samples, CLIMATE)
    assert row.samples == 2
    assert (row.hours_a_year, row.unknown_hours_a_year) == pytest.approx((20.0, 20.0))
    alone = weighed().risk
    assert risk_over_samples(alone, samples[1:], CLIMATE) == alone


def test_violations_stay_those_of_the_line_alone() -> None:
    (alone,) = [row for row in weighed().risk if row.loops == 1]
    broken = replace(alone, violation_hours_a_year=3.0, violation_hours_highest=5.0)
    moving = replace(without_answer(State.GALLOPS, 1), ranges={(Model.HYBRID, 1): WindRanges(((0.0, math.inf),), ())})
    (row,) = risk_over_samples([broken], [moving], CLIMATE)
    assert (row.hours_a_year, row.violation_hours_a_year, row.violation_hours_highest) == pytest.approx(
        (40.0, 3.0, 5.0)
    )
