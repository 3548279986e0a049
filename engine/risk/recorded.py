"""Hours and probability of galloping a year from the iced hours that a weather record holds, with 95 % intervals."""

import math
from collections.abc import Sequence

import numpy as np

from engine.arrays import FloatArray
from engine.risk.winds import Interval
from engine.spec import IcedRecord

TAIL = 0.025  # of the probability, at either end of an interval

Range = tuple[float, float, float]
"""Value, lowest and highest."""


def recorded_hours(record: IcedRecord, intervals: Sequence[Interval]) -> Range:
    """Return the hours a year with the wind across the line within any of the intervals.

    Parameters
    ----------
    record : IcedRecord
    intervals : sequence of pairs
        Wind speeds across the line [m/s], disjoint.
    """
    return interval_of_sum(_hours(record, intervals) / record.years, max(map(len, record.events)) / record.years)


def recorded_probability(record: IcedRecord, intervals: Sequence[Interval]) -> Range:
    """Return the probability of a year with at least one such hour, if such events come as a Poisson process."""
    events = np.minimum(_hours(record, intervals), 1.0) / record.years
    value, lowest, highest = (-math.expm1(-rate) for rate in interval_of_sum(events, 1.0 / record.years))
    return value, lowest, highest


def _hours(record: IcedRecord, intervals: Sequence[Interval]) -> FloatArray:
    """Return the hours of each event within the intervals: (events,)."""
    within = [[any(low <= wind < high for low, high in intervals) for wind in winds] for winds in record.events]
    return np.array([float(sum(hours)) for hours in within])


def interval_of_sum(weights: FloatArray, largest: float) -> Range:
    """Return a sum of weights of events that come as a Poisson process, with its interval by a gamma distribution.

    Fay and Feuer, Statistics in Medicine 16 (1997) 791-801; their text was not at hand, so the formula was derived and
    tried. Weights of mean m and mean square s that come with a rate L add up to L m with the variance L s. The gamma
    distributions have the sum and the variance that were seen, at the upper end with one event more, the largest. For
    equal weights they are the exact interval of a Poisson rate. For others, the expected sum lies beyond either end in
    fewer than 2.5 % of drawn records (`tests/engine/risk/test_recorded.py`) if no event can add more than the largest.
    Where ten events or fewer were seen, their longest may be too short: then it lay beyond the upper end in a tenth of
    the records for geometric lengths, and in half of them where one event in ten is 24 times as long as the others.

    Parameters
    ----------
    weights : (events,)
        What each event adds.
    largest : float
        The most that a single event adds.
    """
    total, square = float(weights.sum()), float((weights**2).sum())
    lowest = _gamma_quantile(TAIL, total, square) if total > 0.0 else 0.0
    return total, lowest, _gamma_quantile(1.0 - TAIL, total + largest, square + largest**2)


def _gamma_quantile(probability: float, mean: float, variance: float) -> float:
    """Return a quantile of the gamma distribution with this mean and variance."""
    from scipy.special import gammaincinv  # noqa: PLC0415 - scipy loads slowly, and only weather records need it

    return float(gammaincinv(mean**2 / variance, probability) * variance / mean)
