"""What a service found, as files or on the terminal: whole results, or one table in a format."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal
from urllib.parse import urlencode

import typer

from app.cli.console import BAD_INPUT, end, for_people, print_table, write, write_bytes
from app.cli.report import print_report
from app.pages.measures import SI, Units

if TYPE_CHECKING:
    from app.answers.batches import BatchDocument
    from app.answers.jobs import JobDocument
    from app.client import Client

Form = Literal["json", "ndjson", "csv", "parquet", "xlsx", "geojson"]
TableOption = Annotated[
    str | None,
    typer.Option("--table", metavar="NAME", help="One table, such as limit-cycles; of a batch, summary if absent."),
]
FormOption = Annotated[
    Form | None, typer.Option("--format", help="Format of a table; from the name of --output, or JSON if absent.")
]

_FORMS: Sequence[Form] = ("json", "ndjson", "csv", "parquet", "xlsx", "geojson")
_OF_A_LINE = (  # a terminal has no room for the other columns of the summary
    "number",
    "reference",
    "name",
    "status",
    "gallops",
    "onset_m_per_s",
    "vertical_peak_to_peak_m",
    "galloping_hours_a_year",
    "failure",
)
_BINARY = frozenset({"parquet", "xlsx"})


def print_results(
    service: "Client",
    work: "JobDocument | BatchDocument",
    table: str | None,
    form: Form | None,
    output: Path | None,
    units: Units | None = SI,
) -> None:
    """Print the results of a job, or a table of a job or batch, or write them to a file.

    On a terminal they are tables for people in these units, elsewhere and without units JSON, with a format bytes of
    that format.
    """
    from app.answers.batches import BatchDocument

    wanted = form or _form_of(output)
    shown = units if output is None and wanted is None and for_people(as_json=units is None) else None
    if table is None and isinstance(work, BatchDocument):
        table = "summary"
    if table is None and wanted in {None, "json"}:
        result = json.loads(service.download(work, "results"))
        print_report(result, shown) if shown else write(result, output)
    elif table is None:
        end(f"--format {wanted} is of one table: name it with --table, such as limit-cycles", BAD_INPUT)
    elif shown:
        _print_rows(_rows(service, work, table), _OF_A_LINE if table == "summary" else None)
    else:
        _write_table(_table(service, work, table, wanted or "json"), wanted or "json", output)


def _form_of(output: Path | None) -> Form | None:
    suffix = "" if output is None else output.suffix.removeprefix(".").lower()
    return next((form for form in _FORMS if form == suffix), None)


def _table(service: "Client", work: "JobDocument | BatchDocument", table: str, form: Form) -> bytes:
    from app.answers.batches import BatchDocument

    if isinstance(work, BatchDocument):
        return service.download(work, f"results?{urlencode({'table': table, 'format': form})}")
    return service.download(work, f"results/{table}?{urlencode({'format': form})}")


def _rows(service: "Client", work: "JobDocument | BatchDocument", table: str) -> list[Mapping[str, Any]]:
    document = json.loads(_table(service, work, table, "json"))
    (only,) = document.values()
    rows: list[Mapping[str, Any]] = only
    return rows


def _print_rows(rows: Sequence[Mapping[str, Any]], columns: Sequence[str] | None) -> None:
    """Print these columns of rows, all if None, unless they are empty; with four digits."""
    wanted = columns or list(rows[0] if rows else ())
    filled = [name for name in wanted if any(row[name] is not None for row in rows)]
    print_table(filled, [{name: _rounded(row[name]) for name in filled} for row in rows])


def _rounded(value: Any) -> Any:
    return f"{value:.4g}" if isinstance(value, float) else value


def _write_table(content: bytes, form: Form, output: Path | None) -> None:
    if form in _BINARY and output is None and sys.stdout.isatty():
        end(f"{form} is not for a terminal: give --output", BAD_INPUT)
    write_bytes(content, output)
