"""The command that fits coefficients to a measured table: `galloping fit`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.console import for_people, print_table, refuse, try_output, write
from app.cli.inputs import read_bytes, read_json
from app.cli.options import AsJson, OutputFile

_DIRECTIONS = ("vertical", "horizontal", "torsional")


def fit(
    table: Annotated[
        Path,
        typer.Argument(
            metavar="TABLE.csv",
            help="Columns angle_deg, lift, drag, moment; or .json {table, static_angle_deg, half_range_deg}.",
        ),
    ],
    static_angle_deg: Annotated[
        float | None, typer.Option(help="Angle of the ice at rest, about which to fit [deg].")
    ] = None,
    half_range_deg: Annotated[
        float | None, typer.Option(help="Rows up to this far from the static angle are fitted [deg].")
    ] = None,
    output: OutputFile = None,
    as_json: AsJson = False,
) -> None:
    """Fit cubics to measured coefficients, for the `ice` of a line: a table on a terminal, else JSON."""
    from pydantic import ValidationError

    from app import convert, schemas
    from app.schemas.faults import BadInput, faults_of

    try_output(output)
    angles = {"static_angle_deg": static_angle_deg, "half_range_deg": half_range_deg}
    try:
        document = _document(table) | {name: angle for name, angle in angles.items() if angle is not None}
        found = convert.fit(schemas.MeasuredCoefficients.model_validate(document))
    except ValidationError as error:
        refuse(faults_of(error.errors(include_url=False)))
    except BadInput as error:
        refuse(error.faults)
    if output is not None or not for_people(as_json):
        write(found, output)
    else:
        _show(found)


def _document(path: Path) -> dict[str, Any]:
    """Return the document of a file.

    Raises
    ------
    BadInput
        If a file that ends in .csv is no table, or another one no object.
    """
    from app.schemas.faults import BadInput, Fault

    if path.suffix.lower() == ".csv":
        return {"table": list(_rows(read_bytes(path)))}
    document = read_json(path)
    if not isinstance(document, dict):
        raise BadInput([Fault("", "dict_type", "must be an object {table, static_angle_deg, half_range_deg}")])
    return document


def _rows(raw: bytes) -> Iterator[dict[str, object]]:
    from app.sheets.cells import WrongCell, value_of
    from app.sheets.delimited import read_delimited

    sheet = read_delimited([raw], _lines)
    names = [name.strip() for name in sheet.header]
    for row in sheet.rows:
        values = (value_of(cell, comma=row.comma) for cell in row.cells)
        yield {
            name: value.sentence if isinstance(value, WrongCell) else value
            for name, value in zip(names, values, strict=False)
        }


def _lines(pieces: Iterable[bytes], /) -> Iterator[bytes]:
    yield from b"".join(pieces).splitlines(keepends=True)


def _show(found: Mapping[str, Any]) -> None:
    made, rest = found["aerodynamics"], found["aerodynamics_at_rest"]
    rows = [_row(name, rest[name], made[name], found["residual"][name]) for name in _DIRECTIONS]
    print_table(list(rows[0]), rows)
    den_hartog = found["den_hartog"]
    typer.echo(
        f"{found['rows_used']} rows, up to {made['fitted_range_deg']:g} degrees from the static angle. Den Hartog's "
        f"coefficient is {den_hartog['coefficient']:.4g}: {'unstable' if den_hartog['unstable'] else 'stable'}."
    )
    for sentence in found["doubts"]:
        typer.echo(f"\nWarning: {sentence}")


def _row(name: str, rest: float, cubic: list[float], residual: float) -> dict[str, str]:
    powers = {f"alpha^{power}": f"{value:.4g}" for power, value in enumerate(cubic, start=1)}
    return {"direction": name, "at rest": f"{rest:.4g}", **powers, "residual": f"{residual:.2g}"}
