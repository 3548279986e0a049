"""The command that sends a file of lines to a service: `galloping batch`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.console import BAD_INPUT, FAILED, end, notice, try_output, write
from app.cli.inputs import read_json
from app.cli.options import AnalysisFile, AsJson, DefaultsFile, OutputFile
from app.cli.remote.answers import FormOption, TableOption, print_results
from app.cli.remote.calls import DEFAULT_URL, KeyFile, ServiceUrl, service_at, waited_for
from app.pages.measures import SI

if TYPE_CHECKING:
    from app.answers.batches import BatchDocument

LinesFile = Annotated[
    Path,
    typer.Argument(
        metavar="LINES.csv",
        help="Lines as .csv, .xlsx, .ndjson, .json, .geojson or CIM (.xml, .rdf); .gz may follow.",
    ),
]
Wait = Annotated[bool, typer.Option("--wait/--no-wait", help="Wait for the end, or print the batch's status at once.")]
Atomic = Annotated[bool, typer.Option("--atomic", help="Reject the whole batch if one line has a fault.")]


def batch(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    lines: LinesFile,
    analysis: AnalysisFile = None,
    defaults: DefaultsFile = None,
    table: TableOption = None,
    form: FormOption = None,
    output: OutputFile = None,
    atomic: Atomic = False,
    wait: Wait = True,
    as_json: AsJson = False,
    url: ServiceUrl = DEFAULT_URL,
    key_file: KeyFile = None,
) -> None:
    """Send a file of lines to a service, wait, and print a row for each line.

    Exit with 1 if any line has no results; what is wrong with it is printed on standard error.
    """
    try_output(output)
    settings = [None if path is None else read_json(path) for path in (analysis, defaults)]
    with service_at(url, key_file) as service:
        try:
            sent = service.submit_batch(lines, settings[0], defaults=settings[1], atomic=atomic)
        except (OSError, ValueError) as error:
            end(f"{lines}: {getattr(error, 'strerror', None) or error}", BAD_INPUT)
        _tell_faults(sent)
        if not wait:
            write(sent.model_dump(mode="json"), output)
            return
        ended = waited_for(service, sent, url)
        print_results(service, ended, table, form, output, None if as_json else SI)
    _conclude(ended)


def _tell_faults(sent: "BatchDocument") -> None:
    for note in sent.notes:
        notice(note)
    for fault in sent.errors:
        typer.echo(f"{fault.place or f'line {fault.number}'}: {fault.pointer}: {fault.detail}", err=True)


def _conclude(ended: "BatchDocument") -> None:
    counts = ended.lines
    if counts.successful < counts.total:
        missing = f"{counts.failed} failed, {counts.rejected} rejected, {counts.dismissed} cancelled"
        end(f"{counts.successful} of {counts.total} lines have results: {missing}", FAILED)
