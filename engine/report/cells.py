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
    values: list[float | None] = column.tolist()
    for row in np.flatnonzero(~np.isfinite(column)).tolist():
        values[row] = None
    return values


def filled_rows(kind: type[Row], columns: Mapping[str, Iterable[Any]], alike: Mapping[str, Any]) -> Iterator[Row]:
    """Yield rows of a frozen dataclass without slots from columns of equal length; fields without a column are None.

    Its constructor sets every field by a call, which takes two to four times as long.

    Parameters
    ----------
    kind : type
    columns : mapping
        Columns by the names of their fields.
    alike : mapping
        Cells that are the same in all rows.

    Raises
    ------
    AttributeError
        If a column is no field.
    """
    blank = dict.fromkeys(field.name for field in fields(kind))  # type: ignore[arg-type]
    names = tuple(columns)
    if unknown := (columns.keys() | alike.keys()) - blank.keys():
        raise AttributeError(f"{kind.__name__} has no fields {', '.join(sorted(unknown))}")
    blank |= alike
    for cells in zip(*columns.values(), strict=True):
        row, filled = object.__new__(kind), blank.copy()
        filled.update(zip(names, cells, strict=True))
        object.__setattr__(row, "__dict__", filled)
        yield row
