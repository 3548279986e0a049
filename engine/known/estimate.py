"""A value that no one measured on the line in question, with the range in which it may lie and its source."""

import math
from dataclasses import dataclass

from engine.outcome import Fault, require


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value with its unit, the lowest and highest value that are plausible, and the sentence that says whence."""

    value: float
    unit: str
    lowest: float
    highest: float
    source: str

    def __post_init__(self) -> None:
        """Check that the range is finite and holds the value."""
        finite = all(math.isfinite(number) for number in (self.lowest, self.value, self.highest))
        inside = finite and self.lowest <= self.value <= self.highest
        rule = f"must lie between the lowest and the highest ({self.lowest} and {self.highest})"
        require(None if inside else Fault("value", self.value, rule))
