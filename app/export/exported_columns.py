"""The columns of result tables with type, unit and meaning, as the tables declare them."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from types import NoneType
from typing import Any, Literal, get_args

from app import convert
from app.answers.batches import LineSummary
from app.schemas.field_table import input_fields

Kind = Literal["number", "integer", "truth", "text"]

_KINDS: Mapping[type, Kind] = {float: "number", int: "integer", bool: "truth"}
_UNIT = re.compile(r" \[(.+)\]$")


@dataclass(frozen=True, slots=True)
class ExportedColumn:
    """One column: name, kind of values (each may be null), unit if it has one, and description."""

    name: str
    kind: Kind
    unit: str | None
    description: str


def exported_columns(table: str, names: Iterable[str]) -> list[ExportedColumn]:
    """Return the columns of a table by name; what the table itself does not know is a label of a batch's line.

    Raises
    ------
    KeyError
        If there is no such table or column.
    """
    own = {} if table == "summary" else _declared(convert.TABLES[table].row)
    known = {**_SUMMARY, **own}
    return [known[name] for name in names]


def all_tables() -> list[dict[str, Any]]:
    """Describe every table of a result: name, address, title, and its columns, each with a usual value."""
    return [
        {
            "name": name,
            "address": address,
            "title": convert.TABLES[name].title,
            "columns": [
                {**asdict(column), "example": example}
                for column, example in zip(
                    exported_columns(name, convert.columns(name)),
                    convert.example_row(convert.TABLES[name].row).values(),
                    strict=True,
                )
            ],
        }
        for address, name in convert.TABLES_BY_ADDRESS.items()
    ]


def axis_columns(axes: Sequence[Mapping[str, Any]]) -> list[ExportedColumn]:
    """Return the columns of a study's axes, which stand before all others, with the units of the fields they vary."""
    units = {row["name"]: row["unit"] for row in input_fields()}
    return [
        ExportedColumn(
            axis["parameter"],
            "text" if any(isinstance(value, str) for value in axis["values"]) else "number",
            units.get(f"line.{axis['parameter']}"),
            "Value of the study's axis",
        )
        for axis in axes
    ]


def _declared(row: type[Any], prefix: str = "") -> dict[str, ExportedColumn]:
    """Return the columns that a dataclass of rows declares."""
    return {
        prefix + name: ExportedColumn(prefix + name, _kind(kind), column.unit, column.description)
        for name, (kind, column) in convert.columns_of(row).items()
    }


def _labels() -> dict[str, ExportedColumn]:
    """Return the columns that only the summary of a batch has, whose units stand in their descriptions."""
    found = {}
    for name, field in LineSummary.model_fields.items():
        description = str(field.description)
        unit = _UNIT.search(description)
        found[name] = ExportedColumn(
            name, _kind(field.annotation), unit.group(1) if unit else None, _UNIT.sub("", description)
        )
    return found


def _kind(annotation: Any) -> Kind:
    kinds = {_KINDS.get(kind, "text") for kind in get_args(annotation) or (annotation,) if kind is not NoneType}
    return kinds.pop()


_SUMMARY: Mapping[str, ExportedColumn] = {
    **_labels(),
    **_declared(convert.TABLES["verdict"].row),
    **_declared(convert.StaticState),
    **_declared(convert.DenHartog, "den_hartog_"),
}
