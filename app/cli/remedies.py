"""The command that compares a line with remedies: `galloping remedies`."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.console import for_people, print_table, try_output, write
from app.cli.inputs import read_request
from app.cli.lines import computed
from app.cli.options import AnalysisFile, AsJson, DefaultsFile, LineFile, OutputFile, UnitsName
from app.cli.report import told
from app.pages.measures import BY_NAME, SI, Units

Row = Mapping[str, Any]
RemediesFile = Annotated[
    Path | None, typer.Option("--remedies", metavar="REMEDIES.json", help="What to try; the usual remedies if absent.")
]


def remedies(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    line: LineFile,
    analysis: AnalysisFile = None,
    tried: RemediesFile = None,
    defaults: DefaultsFile = None,
    output: OutputFile = None,
    as_json: AsJson = False,
    units: UnitsName = "si",
) -> None:
    """Compare a line as it is with remedies, in this process, without service or database.

    On a terminal a table for people is printed, else the whole result as JSON.
    """
    try_output(output)
    document = read_request(line, analysis, None, defaults=defaults, remedies=tried)
    result = computed(document if document.get("remedies") is not None else {**document, "remedies": {}})
    if output is not None or not for_people(as_json):
        write(result, output)
    if for_people(as_json):
        print_remedies(result, BY_NAME[units])


def print_remedies(result: Mapping[str, Any], units: Units = SI) -> None:
    """Print the table of remedies of a result document, then a sentence for each, and the warnings."""
    rows: Sequence[Row] = result["remedies"]
    cells = [_shown(units, row) for row in rows]
    print_table([name for name in cells[0] if any(row[name] for row in cells)], cells)
    for row in rows:
        typer.echo(f"{_number(row)}  {told(row['what'], units)}.\n   {told(row['sentence'], units)}")
    for text in result["warnings"]:
        typer.echo(f"\nWarning: {told(text, units)}")


def _number(row: Row) -> str:
    return "-" if row["remedy"] is None else str(row["remedy"])


def _shown(units: Units, row: Row) -> dict[str, str]:
    """Return the figures of a row in so few columns that they fit a terminal; the sentences below say the rest."""
    length = units.unit("m").name
    return {
        "no": _number(row),
        "remedy": "as it is" if row["kind"] == "none" else row["kind"].replace("_", " "),
        "rank": "" if row["rank"] is None else str(row["rank"]),
        f"onset\n{units.unit('m/s').name}": _figure(units, row["onset_m_per_s"], "m/s"),
        f"vertical\n{length}": _figure(units, row["vertical_peak_to_peak_m"], "m"),
        f"horizontal\n{length}": _figure(units, row["horizontal_peak_to_peak_m"], "m"),
        f"margin\n{length}": _figure(units, row["clearance_margin_m"], "m"),
        "gallops": row["gallops"] if row["probability_gallops"] is None else f"{row['probability_gallops']:.2f}",
    }


def _figure(units: Units, value: float | None, si: str) -> str:
    return "" if value is None else f"{units.value(value, si):,.2f}"
