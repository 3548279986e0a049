"""Commands that print the catalogues: `galloping conductors` and `ice-shapes`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import sys
from typing import Annotated

import typer

from app.cli.console import print_table, write
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

_SHAPE_COLUMNS = ("name", "title", "static_angle_deg", "reference_diameter_m", "source")


def conductors(
    search: Annotated[str, typer.Option(help="Words to find in name, designation, type or stranding.")] = "",
    as_json: AsJson = False,
) -> None:
    """Print the catalogue of bare conductors: a table on a terminal, else JSON with every figure and its source."""
    from app.reference import conductors as catalogue

    rows = [row.listed() for row in catalogue.search(search)]
    if as_json or not sys.stdout.isatty():
        write({"conductors": rows}, None)
    else:
        print_table(_CONDUCTOR_COLUMNS, rows)


def ice_shapes(as_json: AsJson = False) -> None:
    """Print the ice shapes with known coefficients: a table on a terminal, else JSON with coefficients and caveats."""
    from app.reference.ice_shapes import ICE_SHAPES

    rows = [shape.listed() for shape in ICE_SHAPES]
    if as_json or not sys.stdout.isatty():
        write({"ice_shapes": rows}, None)
    else:
        print_table(_SHAPE_COLUMNS, rows)
