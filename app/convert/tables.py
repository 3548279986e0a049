"""The result tables by name, as the engine declares them: all that the service knows of their columns."""

from collections.abc import Mapping
from typing import Any

from engine.result import TABLES, columns_of

TABLES_BY_ADDRESS: Mapping[str, str] = {name.replace("_", "-"): name for name in TABLES}
"""The names of the tables by what addresses call them."""


def columns(table: str) -> list[str]:
    """Return the names of a table's columns in the order of the contract, without the study's axes."""
    return list(columns_of(TABLES[table].row))


def example_row(row: type[Any]) -> dict[str, object]:
    """Return a row that is made of the examples of its columns."""
    return {name: column.example for name, (_, column) in columns_of(row).items()}


def example_tables() -> dict[str, list[dict[str, object]]]:
    """Return every table by name, with an example of its rows."""
    return {name: [example_row(table.row)] for name, table in TABLES.items()}
