"""Small helpers that all tables share."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

from engine.arrays import FloatArray, IntArray

Row = TypeVar("Row")


def lists_by_line(line: IntArray) -> list[list[Any]]:
    """Return an empty list for each line, given the line of each member (members,)."""
    return [[] for _ in range(int(line.max(initial=-1)) + 1)]


def finite_or_none(value: float) -> float | None:
    """Return the value, or None if it is not finite."""
    return value if math.isfinite(value) else None


def numbers(column: FloatArray) -> list[float | None]:
    """Return the numbers of a column (rows,), None in place of those that are not finite."""
    cells = column.astype(np.object_)
    cells[~np.isfinite(column)] = None
    values: list[float | None] = cells.tolist()
    return values


def filled_rows(kind: type[Row], columns: Mapping[str, Iterable[Any]]) -> Iterator[Row]:
    """Yield rows of a frozen dataclass without slots from columns of some of its fields; the others are None.

    Its constructor sets every field by a call, which takes two to four times as long.

    Raises
    ------
    AttributeError
        If a column is no field.
    """
    blank = dict.fromkeys(field.name for field in fields(kind))  # type: ignore[arg-type]
    names = tuple(columns)
    if unknown := columns.keys() - blank.keys():
        raise AttributeError(f"{kind.__name__} has no fields {', '.join(sorted(unknown))}")
    for cells in zip(*columns.values(), strict=False):  # some repeat one cell without end
        row = object.__new__(kind)
        vars(row).update(blank)
        vars(row).update(zip(names, cells, strict=True))
        yield row
