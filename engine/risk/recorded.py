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
    return _interval(_hours(record, intervals) / record.years, max(map(len, record.events)) / record.years)


def recorded_probability(record: IcedRecord, intervals: Sequence[Interval]) -> Range:
    """Return the probability of a year with at least one such hour, if such events come as a Poisson process."""
    events = np.minimum(_hours(record, intervals), 1.0) / record.years
    value, lowest, highest = (-math.expm1(-rate) for rate in _interval(events, 1.0 / record.years))
    return value, lowest, highest


def _hours(record: IcedRecord, intervals: Sequence[Interval]) -> FloatArray:
    """Return the hours of each event within the intervals: (events,)."""
    within = [[any(low <= wind < high for low, high in intervals) for wind in winds] for winds in record.events]
    return np.array([float(sum(hours)) for hours in within])


def _interval(weights: FloatArray, largest: float) -> Range:
    """Return a sum of weights of events that come as a Poisson process, with its interval by a gamma distribution.

    Fay and Feuer, Statistics in Medicine 16 (1997) 791-801: exact for equal weights, on the safe side for others.

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
