"""Probability, its interval, quantiles, and how much they still change with the number of samples."""

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from engine.uncertainty.outcomes import AtWind, State

Value = TypeVar("Value")
NORMAL = 1.959963984540054  # quantile 0.975 of the normal distribution


def wilson(hits: int, trials: int) -> tuple[float, float]:
    """Return the 95 % interval of a probability (Wilson 1927, Probable inference, the law of succession).

    It holds for independent trials. Samples that fill the ranges evenly scatter less, so it is on the safe side.

    Parameters
    ----------
    hits, trials : int
        Without trials the interval is all there is, 0 to 1.
    """
    if trials == 0:
        return 0.0, 1.0
    share, square = hits / trials, NORMAL**2 / trials
    middle = (share + square / 2.0) / (1.0 + square)
    half = NORMAL / (1.0 + square) * math.sqrt(share * (1.0 - share) / trials + square / (4.0 * trials))
    return max(middle - half, 0.0) if hits else 0.0, min(middle + half, 1.0) if hits < trials else 1.0


def probability(states: Sequence[State]) -> float | None:
    """Return the share of galloping among the samples with an answer, None if there is none."""
    hits = sum(state in (State.GALLOPS, State.SIZE_UNKNOWN) for state in states)
    rests = sum(state is State.RESTS for state in states)
    return hits / (hits + rests) if hits + rests else None


def probability_interval(states: Sequence[State]) -> tuple[float, float]:
    """Return the 95 % interval of the probability, as wide as the samples without an answer could make it.

    A sample that breaks a rule is no line that could stand, and does not count.
    """
    possible = [state for state in states if state is not State.IMPOSSIBLE]
    hits = sum(state in (State.GALLOPS, State.SIZE_UNKNOWN) for state in possible)
    rests = sum(state is State.RESTS for state in possible)
    return wilson(hits, len(possible))[0], wilson(len(possible) - rests, len(possible))[1]


def quantile(values: Sequence[float], share: float) -> float | None:
    """Return a quantile (Hazen) of the values that are known, None if it is infinite or none is known."""
    known = np.sort(np.array([value for value in values if not math.isnan(value)]))
    if known.size == 0:
        return None
    place = min(max(share * known.size - 0.5, 0.0), known.size - 1.0)
    low, high = known[math.floor(place)], known[math.ceil(place)]
    if not math.isfinite(high):
        return None
    return float(low + (place - math.floor(place)) * (high - low))


def sizes(winds: Sequence[AtWind], direction: int) -> list[float]:
    """Return the amplitude of each sample in a direction."""
    return [wind.amplitudes[direction] for wind in winds]


def change(estimate: Callable[[Sequence[Value]], float | None], values: Sequence[Value]) -> float | None:
    """Return by how much an estimate changes from the first half of the samples to all, None if one has no value."""
    half, whole = estimate(values[: len(values) // 2]), estimate(values)
    return None if half is None or whole is None else whole - half
