"""Commands that print the catalogues: `galloping conductors`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import sys
from typing import Annotated

import typer

from app.cli.console import print_table, write
from app.cli.options import AsJson

_COLUMNS = ("name", "designation", "type", "stranding", "area_m2", "diameter_m", "mass_kg_per_m", "rated_strength_n")


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
        print_table(_COLUMNS, rows)
