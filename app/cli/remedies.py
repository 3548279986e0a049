"""The command that compares a line with remedies: `galloping remedies`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.console import FAILED, end, print_table, progress_bar, refuse, try_output, write
from app.cli.inputs import read_request
from app.cli.lines import result_document
from app.cli.options import AnalysisFile, AsJson, LineFile, OutputFile

Row = Mapping[str, Any]
RemediesFile = Annotated[
    Path | None, typer.Option("--remedies", metavar="REMEDIES.json", help="What to try; the usual remedies if absent.")
]


def remedies(
    line: LineFile,
    analysis: AnalysisFile = None,
    tried: RemediesFile = None,
    output: OutputFile = None,
    as_json: AsJson = False,
) -> None:
    """Compare a line as it is with remedies, in this process, without service or database.

    A table for people is printed, with --json or --output the whole result as JSON.
    """
    from app.runtime.processes import ONE_BLAS_THREAD

    os.environ.update(ONE_BLAS_THREAD)  # before convert loads numpy, because BLAS reads it once
    from app import convert
    from app.schemas.faults import BadInput

    try_output(output)
    document = read_request(line, analysis, None, remedies=tried)
    if isinstance(document, dict) and document.get("remedies") is None:
        document = {**document, "remedies": {}}
    try:
        complete = convert.read(convert.explicit_request(document)).kept()
    except BadInput as error:
        refuse(error.faults)
    points: list[convert.PointResult] = []
    try:
        with progress_bar() as show:
            for item in convert.run(complete):
                if isinstance(item, convert.Advance):
                    show(item.fraction, item.step)
                else:
                    points.append(item)
    except (ArithmeticError, ValueError) as error:
        end(f"the computation failed: {error}", FAILED)
    result = result_document(complete, points)
    if output is not None or as_json:
        write(result, output)
    if not as_json:
        print_remedies(result)


def print_remedies(result: Mapping[str, Any]) -> None:
    """Print the table of remedies of a result document, then a sentence for each, and the warnings."""
    rows: Sequence[Row] = result["remedies"]
    print_table(list(_shown(rows[0])), [_shown(row) for row in rows])
    for row in rows:
        typer.echo(f"{_number(row)}  {row['what']}.\n   {row['sentence']}")
    for text in result["warnings"]:
        typer.echo(f"\nWarning: {text}")


def _number(row: Row) -> str:
    return "-" if row["remedy"] is None else str(row["remedy"])


def _shown(row: Row) -> dict[str, str]:
    return {
        "no": _number(row),
        "remedy": "as it is" if row["kind"] == "none" else row["kind"].replace("_", " "),
        "places m": row["places"] or "",
        "compared": "" if row["change"] is None else row["change"].replace("_", " "),
        "rank": "" if row["rank"] is None else str(row["rank"]),
        "onset m/s": _figure(row["onset_m_per_s"], 2),
        "vertical m": _figure(row["vertical_peak_to_peak_m"], 2),
        "horizontal m": _figure(row["horizontal_peak_to_peak_m"], 2),
        "margin m": _figure(row["clearance_margin_m"], 2),
        "tension N": _figure(row["static_tension_n"], 0),
        "gallops": row["gallops"] if row["probability_gallops"] is None else f"{row['probability_gallops']:.2f}",
        "better in": _share(row["improves"]),
        "worse in": _share(row["worsens"]),
    }


def _figure(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:,.{digits}f}"


def _share(value: float | None) -> str:
    return "" if value is None else f"{100.0 * value:.0f} %"
