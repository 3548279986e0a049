"""What is uncertain of a line: a number within a range, or one of several choices."""

from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.outcome import Fault, require

FACTOR = 2.0  # a range that spans this factor is one of orders of magnitude


@dataclass(frozen=True, slots=True)
class Interval:
    """An assumed number: path of its field, its value, and the range in which nothing is more plausible than the rest.

    Values are uniform over the range. Where it spans a factor of two or more their logarithms are: such a range says by
    which factor the value may be wrong, and uniform values would crowd at its upper end. The zero of an angle or of a
    temperature in degrees is chosen freely, so that these have no factors: has_factors is False for them.
    """

    path: str
    value: float
    lowest: float
    highest: float
    has_factors: bool = True

    def __post_init__(self) -> None:
        """Check that the range is not empty and holds the value."""
        inside = self.lowest <= self.value <= self.highest and self.lowest < self.highest
        rule = f"must lie between the lowest and a higher highest ({self.lowest} and {self.highest})"
        require(None if inside else Fault(self.path, self.value, rule))

    @property
    def logarithmic(self) -> bool:
        """Whether the logarithms of the values are uniform."""
        return self.has_factors and self.lowest > 0.0 and self.highest >= FACTOR * self.lowest

    def at(self, unit: FloatArray) -> FloatArray:
        """Return the values whose share of the range, by probability, is given (0 to 1), of any shape."""
        if self.logarithmic:
            values = self.lowest * (self.highest / self.lowest) ** unit
        else:
            values = self.lowest + (self.highest - self.lowest) * unit
        return np.clip(values, self.lowest, self.highest)


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several possibilities, such as shapes of ice, with their weights; its value is a number from 0.

    value: number of the possibility that the line has by itself.
    """

    path: str
    value: float
    weights: tuple[float, ...]

    def __post_init__(self) -> None:
        """Check that there is a choice, that weights are positive, and that the value is one of the numbers."""
        numbers = range(len(self.weights))
        require(
            None if len(self.weights) > 1 else Fault(self.path, self.weights, "must offer two possibilities or more"),
            None
            if all(weight > 0.0 for weight in self.weights)
            else Fault(self.path, self.weights, "must be positive"),
            None if self.value in numbers else Fault(self.path, self.value, f"must be one of {list(numbers)}"),
        )

    @property
    def shares(self) -> tuple[float, ...]:
        """The probability of each possibility."""
        whole = sum(self.weights)
        return tuple(weight / whole for weight in self.weights)

    def number(self, unit: FloatArray) -> IntArray:
        """Return the possibilities at given shares of the probability (0 to 1), of any shape."""
        inner = np.array(list(accumulate(self.shares))[:-1])
        return np.searchsorted(inner, unit, side="right").astype(np.intp)

    def at(self, unit: FloatArray) -> FloatArray:
        """Return the numbers of the possibilities at given shares of the probability, as floats."""
        return self.number(unit).astype(np.float64)


Uncertain = Interval | Choice
