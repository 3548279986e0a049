"""A section: a run of spans between two dead ends, with suspension strings between them. Theory section 16."""

from collections.abc import Iterator
from dataclasses import dataclass

from engine.outcome import Fault, require
from engine.spec.environment import Ice
from engine.spec.rules import finite, positive


@dataclass(frozen=True, slots=True)
class SectionSpan:
    """One span of a section: its horizontal length [m], and what it does not share with the span of interest.

    level_difference: height of its right end above the left one [m]; ice, and profile of (position [m], factor phi) of
    the wind: None for those of the span of interest, with positions in proportion to the length.
    """

    length: float
    level_difference: float = 0.0
    ice: Ice | None = None
    profile: tuple[tuple[float, float], ...] | None = None

    def __post_init__(self) -> None:
        """Check the rules of the numbers."""
        require(positive("length", self.length), *self._level_faults())

    def _level_faults(self) -> Iterator[Fault | None]:
        yield finite("level_difference", self.level_difference)
        if abs(self.level_difference) > self.length > 0.0:
            rule = f"must not exceed the span's length ({self.length}), up or down"
            yield Fault("level_difference", self.level_difference, rule)


@dataclass(frozen=True, slots=True)
class SuspensionString:
    """An insulator string of length l [m] and weight W [N], as a whole, that swings along and across the line."""

    length: float
    weight: float

    def __post_init__(self) -> None:
        """Check that both are positive."""
        require(positive("length", self.length), positive("weight", self.weight))


@dataclass(frozen=True, slots=True)
class Section:
    """Spans from the left to the right dead end, and the strings at the supports between them.

    span_of_interest: the number of the span that the line describes, from 1.

    Raises
    ------
    InvalidSpec
        If there is not one string fewer than spans, or the span of interest is not among them.
    """

    spans: tuple[SectionSpan, ...]
    strings: tuple[SuspensionString, ...]
    span_of_interest: int = 1

    def __post_init__(self) -> None:
        """Check the number of strings and of the span of interest."""
        require(*self._faults())

    def _faults(self) -> Iterator[Fault]:
        spans, strings = len(self.spans), len(self.strings)
        if spans < 2:
            yield Fault("section.spans", spans, "must be at least 2 spans; without a section, a line is a single span")
        elif strings != spans - 1:
            rule = f"must be one string fewer than spans, which is {spans - 1} for {spans} spans"
            yield Fault("section.strings", strings, rule)
        if not 1 <= self.span_of_interest <= max(spans, 1):
            rule = f"must be the number of one of the spans, from 1 to {spans}"
            yield Fault("section.span_of_interest", self.span_of_interest, rule)
