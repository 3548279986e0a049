"""Rules that several parts of a specification share; each returns a fault, or None if the value keeps the rule."""

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise

from engine.outcome import Fault


def finite(name: str, value: float | None) -> Fault | None:
    """Require a finite number; None passes."""
    if value is not None and not math.isfinite(value):
        return Fault(name, value, "must be a finite number")
    return None


def positive(name: str, value: float | None) -> Fault | None:
    """Require a finite number greater than zero; None passes."""
    if value is not None and not (math.isfinite(value) and value > 0.0):
        return Fault(name, value, "must be a finite number greater than zero")
    return None


def not_negative(name: str, value: float | None) -> Fault | None:
    """Require a finite number of at least zero; None passes."""
    if value is not None and not (math.isfinite(value) and value >= 0.0):
        return Fault(name, value, "must be a finite number of at least zero")
    return None


def stretch_faults(start: float, stop: float) -> Iterator[Fault | None]:
    """Require that a stretch [m] starts at zero or later and before it ends."""
    yield not_negative("start", start)
    yield finite("stop", stop)
    yield None if start < stop else Fault("stop", stop, f"must be greater than the start ({start})")


def overlap_faults(stretches: Iterable[tuple[str, float, float]]) -> Iterator[Fault]:
    """Yield a fault for every stretch (field, start, stop) [m] that starts before its left neighbour ends."""
    for (_, start, stop), (field, begins, ends) in pairwise(sorted(stretches, key=lambda stretch: stretch[1:])):
        if begins < stop:
            yield Fault(field, (begins, ends), f"must not overlap the stretch from {start} to {stop}")
