"""How a result table is declared: a dataclass of rows, in which each column describes itself."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, get_args, get_type_hints


@dataclass(frozen=True, slots=True)
class Column:
    """Description of a column, a typical value, and the unit of its numbers: "1" for a pure number, else None.

    It stands beside the type, `Annotated[float, Column("Vertical amplitude", 0.1568, unit="m")]`.
    """

    description: str
    example: object
    unit: str | None = None


@dataclass(frozen=True, slots=True)
class Title:
    """What a table holds, in a phrase; it stands beside the type of the table, `Annotated[tuple[Row, ...], Title]`."""

    text: str


@dataclass(frozen=True, slots=True)
class Table:
    """A result table: its name, what it holds, and the dataclass of its rows, whose docstring says what a row is."""

    name: str
    title: str
    row: type[Any]


def columns_of(row: type[Any]) -> Mapping[str, tuple[Any, Column]]:
    """Return type and declaration of every column of a dataclass of rows, by name and in order.

    Raises
    ------
    TypeError
        If a field does not declare its column.
    """
    hints = get_type_hints(row, include_extras=True)
    return {field.name: _declared(hints[field.name], Column) for field in fields(row)}


def tables_of(whole: type[Any]) -> Mapping[str, Table]:
    """Return the tables that the fields of a dataclass declare, by name and in order.

    Raises
    ------
    TypeError
        If a field declares no table.
    """
    hints = get_type_hints(whole, include_extras=True)
    declared = {field.name: _declared(hints[field.name], Title) for field in fields(whole)}
    return {name: Table(name, title.text, get_args(rows)[0]) for name, (rows, title) in declared.items()}


def _declared(hint: Any, kind: type[Any]) -> tuple[Any, Any]:
    """Return an annotated type and the declaration of this kind beside it."""
    own, *beside = get_args(hint) if hasattr(hint, "__metadata__") else (hint,)
    for declaration in beside:
        if isinstance(declaration, kind):
            return own, declaration
    raise TypeError(f"{own} has no {kind.__name__} beside it")
