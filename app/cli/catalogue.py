"""Commands that print what there is: `galloping conductors`, `ice-shapes` and `fields`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from app.cli.console import for_people, print_table, write
from app.cli.options import AsJson

_CONDUCTOR_COLUMNS = (
    "name",
    "designation",
    "type",
    "stranding",
    "area_m2",
    "diameter_m",
    "mass_kg_per_m",
    "rated_strength_n",
)

_FIELD_COLUMNS = ("field", "type", "unit", "default", "bounds", "description")

_SHAPE_COLUMNS = ("name", "title", "static_angle_deg", "reference_diameter_m", "source")


def conductors(
    search: Annotated[str, typer.Option(help="Words to find in name, designation, type or stranding.")] = "",
    as_json: AsJson = False,
) -> None:
    """Print the catalogue of bare conductors: a table on a terminal, else JSON with every figure and its source."""
    from app.reference import conductors as catalogue

    rows = [row.listed() for row in catalogue.search(search)]
    if not for_people(as_json):
        write({"conductors": rows}, None)
    else:
        print_table(_CONDUCTOR_COLUMNS, rows)


def ice_shapes(as_json: AsJson = False) -> None:
    """Print the ice shapes with known coefficients: a table on a terminal, else JSON with coefficients and caveats."""
    from app.reference.ice_shapes import ICE_SHAPES

    rows = [shape.listed() for shape in ICE_SHAPES]
    if not for_people(as_json):
        write({"ice_shapes": rows}, None)
    else:
        print_table(_SHAPE_COLUMNS, rows)


def fields(
    search: Annotated[str, typer.Option(help="Words to find in name, unit, choices or description.")] = "",
    as_json: AsJson = False,
) -> None:
    """Print the fields of a request with unit, default, bounds and description: a table on a terminal, else JSON.

    `[]` in a name marks a list of objects, `[spacer]` the type of the objects that have the field.
    """
    from app.schemas import field_table

    words = search.casefold().split()
    rows = [row for row in field_table.all_fields() if all(word in _searched(row) for word in words)]
    if not for_people(as_json):
        write({"fields": rows}, None)
    else:
        print_table(_FIELD_COLUMNS, [_field(row) for row in rows])


def _searched(row: Mapping[str, Any]) -> str:
    parts = [row["name"], row["description"], row["unit"] or "", *(str(choice) for choice in row["choices"] or ())]
    return " ".join(parts).casefold()


def _field(row: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "field": row["name"],
        "type": " or ".join(map(str, row["choices"])) if row["choices"] else row["type"],
        "unit": row["unit"],
        "default": "needed" if row["required"] else row["default"],
        "bounds": _bounds(row["minimum"], row["maximum"]),
        "description": row["description"],
    }


def _bounds(least: float | None, most: float | None) -> str | None:
    if least is None and most is None:
        return None
    if most is None:
        return f"from {least:g}"
    return f"up to {most:g}" if least is None else f"{least:g} to {most:g}"
