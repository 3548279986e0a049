"""Tables of a result as pages show them: words for their columns, the reader's units, as many digits as are known."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from app.convert import TABLES, TABLES_BY_ADDRESS
from app.export.exported_columns import ExportedColumn, exported_columns
from app.pages.findings import Row
from app.pages.measures import Units
from app.pages.wording import word_for, words

_SENTENCE = "sentence"
_WORDS = ("model", "stability", "crossing", "type", "kind", "outcome", "direction", "method", "together", "found_by")
_ENDINGS = ("_m_per_s", "_hz", "_rad", "_n", "_m")
ADDRESSES = {name: address for address, name in TABLES_BY_ADDRESS.items()}


@dataclass(frozen=True, slots=True)
class ShownColumn:
    """The head of a column: a name in words, its unit, what it means, and whether it holds figures."""

    name: str
    unit: str
    meaning: str
    figures: bool


@dataclass(frozen=True, slots=True)
class ShownTable:
    """A table in words."""

    name: str
    title: str
    columns: Sequence[ShownColumn]
    rows: Sequence[Sequence[str]]


def shown_table(name: str, names: Sequence[str], rows: Sequence[Row], units: Units) -> ShownTable:
    """Return some columns of a table.

    Raises
    ------
    KeyError
        If there is no such table or column.
    """
    columns = exported_columns(name, names)
    heads = [_head(column, units) for column in columns]
    cells = [[_cell(column, row.get(column.name), units) for column in columns] for row in rows]
    return ShownTable(name, TABLES[name].title, heads, cells)


def column_name(name: str) -> str:
    """Return the name of a column in words, without its unit."""
    stem = next((name.removesuffix(end) for end in _ENDINGS if name.endswith(end)), name)
    return word_for(words().columns, stem)


def _head(column: ExportedColumn, units: Units) -> ShownColumn:
    unit = units.unit(column.unit).name if column.kind == "number" else ""
    return ShownColumn(column_name(column.name), unit, column.description, column.kind in {"number", "integer"})


def _cell(column: ExportedColumn, value: Any, units: Units) -> str:
    if isinstance(value, bool):
        return word_for(words().truth, "yes" if value else "no")
    if isinstance(value, str) and column.name in _WORDS:
        return word_for(words().values, value)
    if isinstance(value, str) and column.name == _SENTENCE:
        return units.sentence(value)
    return units.number(value, column.unit if column.kind == "number" else None)
