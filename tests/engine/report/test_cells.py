"""Cells and rows from columns."""

from dataclasses import asdict, dataclass, fields

import numpy as np
import pytest

from engine.report.cells import filled_rows, numbers


@dataclass(frozen=True)
class Row:
    name: str
    number: float | None
    place: int | None = None


def test_numbers_that_are_not_finite_are_none() -> None:
    assert numbers(np.array([0.25, np.nan, np.inf, -np.inf, 0.0])) == [0.25, None, None, None, 0.0]


def test_filled_rows_are_those_of_the_constructor() -> None:
    rows = list(filled_rows(Row, {"place": [1, 2]}, {"name": "here"}))
    assert rows == [Row("here", None, 1), Row("here", None, 2)]
    assert [hash(row) for row in rows] == [hash(Row("here", None, 1)), hash(Row("here", None, 2))]
    assert [list(asdict(row)) for row in rows] == [[field.name for field in fields(Row)]] * 2
    assert list(vars(rows[0])) == ["name", "number", "place"]


def test_a_column_that_is_no_field_is_refused() -> None:
    with pytest.raises(AttributeError, match="places"):
        list(filled_rows(Row, {"places": [1]}, {}))
