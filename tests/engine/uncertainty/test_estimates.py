"""Probabilities, their intervals, and quantiles."""

import math

import pytest
from scipy.stats import binomtest

from engine.uncertainty.estimates import change, probability, probability_interval, quantile, wilson
from engine.uncertainty.outcomes import State

YES, WILD, NO = State.GALLOPS, State.SIZE_UNKNOWN, State.RESTS


@pytest.mark.parametrize(("hits", "trials"), [(0, 10), (1, 10), (45, 64), (64, 64), (500, 1024)])
def test_the_interval_is_that_of_wilson(hits: int, trials: int) -> None:
    interval = binomtest(hits, trials).proportion_ci(method="wilson")
    assert wilson(hits, trials) == pytest.approx((interval.low, interval.high), abs=1e-12)


def test_without_trials_everything_is_possible() -> None:
    assert wilson(0, 0) == (0.0, 1.0)


def test_only_samples_with_an_answer_make_the_probability() -> None:
    states = [YES, WILD, NO, State.UNKNOWN, State.STATICALLY_UNSTABLE, State.IMPOSSIBLE]
    assert probability(states) == pytest.approx(2.0 / 3.0)
    assert probability([State.UNKNOWN]) is None


def test_samples_without_an_answer_widen_the_interval_to_both_sides() -> None:
    known = [YES] * 30 + [NO] * 10
    low, high = probability_interval(known)
    assert (low, high) == wilson(30, 40)
    wider = probability_interval([*known, *[State.UNKNOWN] * 10])
    assert wider == (wilson(30, 50)[0], wilson(40, 50)[1])
    assert wider[0] < low < high < wider[1]
    assert probability_interval([*known, State.IMPOSSIBLE]) == (low, high)


def test_quantiles_interpolate_between_the_middles_of_equal_shares() -> None:
    values = [4.0, 1.0, 3.0, 2.0]
    assert quantile(values, 0.5) == 2.5
    assert quantile(values, 0.125) == 1.0
    assert quantile(values, 0.0) == 1.0
    assert quantile(values, 1.0) == 4.0
    assert quantile(values, 0.25) == 1.5


def test_quantiles_among_infinite_values_are_none_and_unknown_ones_do_not_count() -> None:
    values = [1.0, 2.0, math.inf, math.nan]
    assert quantile(values, 0.5) == 2.0
    assert quantile(values, 0.95) is None
    assert quantile([math.nan], 0.5) is None
    assert quantile([], 0.5) is None


def test_the_change_is_that_from_the_first_half_to_all() -> None:
    assert change(probability, [YES, NO, YES, YES]) == pytest.approx(0.75 - 0.5)
    assert change(probability, [State.UNKNOWN, YES]) is None
