"""Small helpers that all tables share."""

import math
from typing import Any

from engine.arrays import IntArray


def lists_by_line(line: IntArray) -> list[list[Any]]:
    """Return an empty list for each line, given the line of each member (members,)."""
    return [[] for _ in range(int(line.max(initial=-1)) + 1)]


def finite_or_none(value: float) -> float | None:
    """Return the value, or None if it is not finite."""
    return value if math.isfinite(value) else None
