"""The lists of a request that have rows in the form, with the fields of each kind of row as the schemas have them."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

from app.pages.lines.line_fields import FormField, fields_at, has_fixed_length, is_value, list_names, schema_rows
from app.pages.wording import words
from app.schemas.field_table import fields_of
from app.schemas.known import KnownLine

KIND = "type"
"""The field of a row that says its kind, where a list has several."""

REST = "rest"
"""The field of the form, and of a row, that holds as JSON what has no field of its own."""

_LEFT_OUT = frozenset({"line"})  # a whole line within a row stays JSON
_MOST_SHOWN = 1000  # a longer list is not for a form, and stays JSON


@dataclass(frozen=True, slots=True)
class RowKind:
    """A kind of row: its fields by names from the row on, its objects that are required, and whether it has more."""

    fields: Sequence[FormField]
    required: frozenset[str]
    has_more: bool


@dataclass(frozen=True, slots=True)
class RowList:
    """A list of a request: its dotted name, how many items it may have, and its kinds of rows by their names."""

    name: str
    most: int
    kinds: Mapping[str, RowKind]

    @property
    def most_rows(self) -> int:
        """Return how many rows the form may have."""
        return min(self.most, _MOST_SHOWN)

    @property
    def columns(self) -> Sequence[FormField]:
        """Return the fields that the columns of a sheet fill; none where a row says its kind."""
        return [] if self.has_kinds else [field for field in self.kinds[""].fields if not field.part]

    @property
    def has_kinds(self) -> bool:
        """Tell whether a row says its kind."""
        return "" not in self.kinds

    @property
    def is_plain(self) -> bool:
        """Tell whether the items are values and not objects."""
        return not self.has_kinds and self.kinds[""].fields[0].name == ""

    def fields(self, number: int, kind: str) -> list[FormField]:
        """Return the fields of a row; none of an unknown kind."""
        found = self.kinds[kind].fields if kind in self.kinds else ()
        return [replace(field, name=self.field_name(number, field.name)) for field in found]

    def field_name(self, number: int, within: str) -> str:
        """Return the dotted name of a field of a row."""
        return f"{self.row_name(number)}.{within}" if within else self.row_name(number)

    def row_name(self, number: int) -> str:
        """Return the dotted name of a row."""
        return f"{self.name}.{number}"

    def label(self, number: int) -> str:
        """Return the name of a row in words, which count from 1."""
        return str(getattr(words().rows, self.name).one.format(number=number + 1))


@cache
def row_lists() -> dict[str, RowList]:
    """Return the lists by their dotted names."""
    first = {f"line.{row['name']}": row for row in fields_of(KnownLine, first_form=True)}
    every = {f"line.{row['name']}": row for row in fields_of(KnownLine)}  # for a list that only a later form has
    return {
        name: RowList(name, schema_rows()[name]["most_items"], _kinds(name, first if name in first else every))
        for name in list_names()
    }


def _kinds(name: str, rows: Mapping[str, Mapping[str, Any]]) -> dict[str, RowKind]:
    within: dict[str, dict[str, Mapping[str, Any]]] = {}
    for path, row in rows.items():
        match = re.fullmatch(rf"{re.escape(name)}\[(\w*)\]\.(.+)", path)
        if match and match[2] != KIND:
            within.setdefault(match[1], {})[match[2]] = row
    if not within:
        return {"": RowKind((FormField("", {**schema_rows()[name], "type": "number"}, name),), frozenset(), False)}
    return {kind: _row_kind(name, found) for kind, found in within.items()}


def _row_kind(name: str, rows: Mapping[str, Mapping[str, Any]]) -> RowKind:
    fields = [
        field
        for path, row in rows.items()
        if not _stays_json(path)
        for field in fields_at(path, row, partial(_words_of, name), path.partition(".")[0] if "." in path else "")
    ]
    objects = {path: row for path, row in rows.items() if not is_value(row) and not set(".[") & set(path)}
    more = any(not has_fixed_length(row) for row in objects.values())
    return RowKind(fields, frozenset(path for path, row in objects.items() if row["required"]), more)


def _words_of(name: str, path: str) -> str:
    """Return the name of the words of a field: its own in this list, else those that all lists share."""
    own = f"{name}.{path}"
    return own if hasattr(words().fields, own) else path


def _stays_json(path: str) -> bool:
    return "[" in path or path.partition(".")[0] in _LEFT_OUT
