"""Where each value of a line came from."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum

from engine.known.estimate import Estimate
from engine.outcome import Fault, require


class Origin(StrEnum):
    """Whether a value was given, read in a catalogue, computed from others, or assumed."""

    GIVEN = "given"
    CATALOGUE = "catalogue"
    COMPUTED = "computed"
    ASSUMED = "assumed"


@dataclass(frozen=True, slots=True)
class Assumption:
    """One value of a line: dotted path of its field, value, unit, origin, the sentence that says whence.

    lowest, highest: the range of an assumed value, None for others; choices: the names of the possibilities of which it
    is the number, from 0, none where every value of the range is one.
    """

    path: str
    value: float
    unit: str
    origin: Origin
    source: str
    lowest: float | None = None
    highest: float | None = None
    choices: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check that the value is finite, in its range and one of its choices; only assumed ones have a range."""
        ranged = self.lowest is not None and self.highest is not None
        require(
            None if math.isfinite(self.value) else Fault(self.path, self.value, "must be a finite number"),
            None
            if ranged == (self.origin is Origin.ASSUMED)
            else Fault(self.path, self.origin.value, "must have a range if and only if it is assumed"),
            self._range_fault(),
            Fault(self.path, self.value, f"must be a whole number, of {', '.join(self.choices)}")
            if self.choices and self.value != round(self.value)
            else None,
        )

    def _range_fault(self) -> Fault | None:
        if self.lowest is None or self.highest is None or self.lowest <= self.value <= self.highest:
            return None
        return Fault(
            self.path, self.value, f"must lie between {self.lowest:g} and {self.highest:g} {self.unit}".rstrip()
        )


@dataclass(frozen=True, slots=True)
class Provenance:
    """The values of a line by path, in the order in which they were settled."""

    rows: tuple[Assumption, ...] = ()

    def __getitem__(self, path: str) -> float:
        """Return a value by its path."""
        value = self.get(path)
        if value is None:
            raise KeyError(path)
        return value

    def get(self, path: str) -> float | None:
        """Return a value by its path, None if there is none."""
        return next((row.value for row in self.rows if row.path == path), None)

    def __contains__(self, path: object) -> bool:
        """Return whether there is a value of a path."""
        return any(row.path == path for row in self.rows)

    def extended(self, rows: Iterable[Assumption]) -> "Provenance":
        """Return the values with further ones behind them."""
        return Provenance((*self.rows, *rows))


def given(path: str, value: float, unit: str) -> Assumption:
    """Return a value that the user stated."""
    return Assumption(path, value, unit, Origin.GIVEN, "as given")


def from_catalogue(path: str, value: float, unit: str, source: str) -> Assumption:
    """Return a value of a catalogue's row."""
    return Assumption(path, value, unit, Origin.CATALOGUE, source)


def computed(path: str, value: float, unit: str, source: str) -> Assumption:
    """Return a value that follows from others."""
    return Assumption(path, value, unit, Origin.COMPUTED, source)


def assumed(path: str, estimate: Estimate, chosen: Mapping[str, float]) -> Assumption:
    """Return an estimated value, or another one of its range if that is chosen for its path.

    Raises
    ------
    InvalidSpec
        If the chosen value lies outside the range.
    """
    value = chosen.get(path, estimate.value)
    row = (path, value, estimate.unit, Origin.ASSUMED, estimate.source)
    return Assumption(*row, estimate.lowest, estimate.highest)
