"""The columns of result tables with type, unit and meaning, read out of the schemas of the answers."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import NoneType
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel

from app.schemas import answers, batch
from app.schemas.field_table import input_fields
from app.schemas.fields import Answer

Kind = Literal["number", "integer", "truth", "text"]

_KINDS: Mapping[type, Kind] = {float: "number", int: "integer", bool: "truth"}
_UNIT = re.compile(r" \[(.+)\]$")


def _models() -> Iterator[tuple[str, type[BaseModel]]]:
    """Yield the schema of each table's rows: a result document holds its tables as lists of them."""
    yield "summary", batch.LineSummary
    for name, field in answers.ResultDocument.model_fields.items():
        for item in get_args(field.annotation):
            if get_origin(field.annotation) is list and issubclass(item, Answer):
                yield name, item


_MODELS: Mapping[str, type[BaseModel]] = dict(_models())


@dataclass(frozen=True, slots=True)
class Column:
    """One column: its name, the kind of its values (each may be null), its unit if it has one, and what it is."""

    name: str
    kind: Kind
    unit: str | None
    description: str


def columns_of(table: str, names: Iterable[str]) -> list[Column]:
    """Return the columns of a table by name; what the table itself does not know is a label of a batch's line.

    Raises
    ------
    KeyError
        If there is no such table or column.
    """
    known = {**batch.LineSummary.model_fields, **_MODELS[table].model_fields}
    return [_column(name, known[name].annotation, str(known[name].description)) for name in names]


def axis_columns(axes: Sequence[Mapping[str, Any]]) -> list[Column]:
    """Return the columns of a study's axes, which stand before all others, with the units of the fields they vary."""
    units = {row["name"]: row["unit"] for row in input_fields()}
    return [
        Column(
            axis["parameter"],
            "text" if any(isinstance(value, str) for value in axis["values"]) else "number",
            units.get(f"line.{axis['parameter']}"),
            "Value of the study's axis",
        )
        for axis in axes
    ]


def _column(name: str, annotation: Any, description: str) -> Column:
    kinds = {_KINDS.get(kind, "text") for kind in get_args(annotation) or (annotation,) if kind is not NoneType}
    unit = _UNIT.search(description)
    return Column(name, kinds.pop(), unit.group(1) if unit else None, _UNIT.sub("", description))
