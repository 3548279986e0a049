"""The command that compares a line with remedies: `galloping remedies`."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.console import print_table, try_output, write
from app.cli.inputs import read_request
from app.cli.lines import computed
from app.cli.options import AnalysisFile, AsJson, DefaultsFile, LineFile, OutputFile

Row = Mapping[str, Any]
RemediesFile = Annotated[
    Path | None, typer.Option("--remedies", metavar="REMEDIES.json", help="What to try; the usual remedies if absent.")
]


def remedies(
    line: LineFile,
    analysis: AnalysisFile = None,
    tried: RemediesFile = None,
    defaults: DefaultsFile = None,
    output: OutputFile = None,
    as_json: AsJson = False,
) -> None:
    """Compare a line as it is with remedies, in this process, without service or database.

    A table for people is printed, with --json or --output the whole result as JSON.
    """
    try_output(output)
    document = read_request(line, analysis, None, defaults=defaults, remedies=tried)
    result = computed(document if document.get("remedies") is not None else {**document, "remedies": {}})
    if output is not None or as_json:
        write(result, output)
    if not as_json:
        print_remedies(result)


def print_remedies(result: Mapping[str, Any]) -> None:
    """Print the table of remedies of a result document, then a sentence for each, and the warnings."""
    rows: Sequence[Row] = result["remedies"]
    cells = [_shown(row) for row in rows]
    print_table([name for name in cells[0] if any(row[name] for row in cells)], cells)
    for row in rows:
        typer.echo(f"{_number(row)}  {row['what']}.\n   {row['sentence']}")
    for text in result["warnings"]:
        typer.echo(f"\nWarning: {text}")


def _number(row: Row) -> str:
    return "-" if row["remedy"] is None else str(row["remedy"])


def _shown(row: Row) -> dict[str, str]:
    """Return the figures of a row in so few columns that they fit a terminal; the sentences below say the rest."""
    return {
        "no": _number(row),
        "remedy": "as it is" if row["kind"] == "none" else row["kind"].replace("_", " "),
        "rank": "" if row["rank"] is None else str(row["rank"]),
        "onset\nm/s": _figure(row["onset_m_per_s"]),
        "vertical\nm": _figure(row["vertical_peak_to_peak_m"]),
        "horizontal\nm": _figure(row["horizontal_peak_to_peak_m"]),
        "margin\nm": _figure(row["clearance_margin_m"]),
        "gallops": row["gallops"] if row["probability_gallops"] is None else f"{row['probability_gallops']:.2f}",
    }


def _figure(value: float | None) -> str:
    return "" if value is None else f"{value:,.2f}"
