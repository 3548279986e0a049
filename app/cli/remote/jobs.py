"""`galloping jobs`: list, show, wait for, read and cancel the jobs and batches of a service."""

from collections.abc import Mapping
from itertools import islice
from typing import TYPE_CHECKING, Annotated, Any, Literal
from uuid import UUID

import typer

from app.cli.common import with_common_options
from app.cli.console import FAILED, end, for_people, print_table, try_output, write
from app.cli.options import AsJson, OutputFile, UnitsName
from app.cli.remote.answers import FormOption, TableOption, print_results
from app.cli.remote.calls import DEFAULT_URL, ENDED, KeyFile, ServiceUrl, found, going_on, service_at, waited_for
from app.pages.measures import BY_NAME

if TYPE_CHECKING:
    from app.answers.batches import BatchDocument
    from app.answers.jobs import JobDocument

commands = typer.Typer(
    help="List, show, wait for, read and cancel jobs and batches of a service.", no_args_is_help=True
)

Identity = Annotated[UUID, typer.Argument(metavar="ID", help="Id of a job or of a batch.")]
Status = Literal["accepted", "running", "successful", "failed", "dismissed"]

_COLUMNS = ("id", "status", "progress", "name", "asset_id", "created_at", "duration_seconds")


@commands.command("list")
@with_common_options
def list_jobs(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    status: Annotated[Status | None, typer.Option(help="Only jobs in this state.")] = None,
    asset_id: Annotated[str | None, typer.Option(help="Only jobs of this asset.")] = None,
    tag: Annotated[list[str] | None, typer.Option(metavar="KEY:VALUE", help="Only jobs with this tag.")] = None,
    limit: Annotated[int, typer.Option(min=1, help="Most jobs to print.")] = 20,
    as_json: AsJson = False,
    url: ServiceUrl = DEFAULT_URL,
    key_file: KeyFile = None,
) -> None:
    """List jobs, newest first: a table on a terminal, else JSON."""
    filters = {"status": status, "asset_id": asset_id, "tag": tag}
    given: dict[str, Any] = {name: value for name, value in filters.items() if value}
    with service_at(url, key_file) as service:
        jobs = [job.model_dump(mode="json") for job in islice(service.jobs(**given), limit)]
    if not for_people(as_json):
        write({"jobs": jobs}, None)
    else:
        print_table(_COLUMNS, [_in_short(job) for job in jobs])


@commands.command()
@with_common_options
def show(identity: Identity, as_json: AsJson = False, url: ServiceUrl = DEFAULT_URL, key_file: KeyFile = None) -> None:
    """Show the status of a job or batch."""
    with service_at(url, key_file) as service:
        _print_status(found(service, identity), as_json)


@commands.command()
@with_common_options
def results(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    identity: Identity,
    table: TableOption = None,
    form: FormOption = None,
    output: OutputFile = None,
    as_json: AsJson = False,
    units: UnitsName = "si",
    url: ServiceUrl = DEFAULT_URL,
    key_file: KeyFile = None,
) -> None:
    """Print the results of a job that has ended, or a table of it or of a batch."""
    try_output(output)
    with service_at(url, key_file) as service:
        work = found(service, identity)
        if work.status not in ENDED:
            end(f"it is {work.status}, {work.progress:.0%} done\n{going_on(work, url)}", FAILED)
        print_results(service, work, table, form, output, None if as_json else BY_NAME[units])


@commands.command()
@with_common_options
def wait(identity: Identity, as_json: AsJson = False, url: ServiceUrl = DEFAULT_URL, key_file: KeyFile = None) -> None:
    """Wait until a job or batch ends and print its status; exit with 1 unless it was successful."""
    with service_at(url, key_file) as service:
        ended = waited_for(service, found(service, identity), url)
    _print_status(ended, as_json)
    raise typer.Exit(0 if ended.status == "successful" else FAILED)


@commands.command()
@with_common_options
def cancel(identity: Identity, url: ServiceUrl = DEFAULT_URL, key_file: KeyFile = None) -> None:
    """Cancel a job or batch; one that has ended keeps its results."""
    with service_at(url, key_file) as service:
        work = found(service, identity)
        if work.status not in ENDED:
            service.cancel(work)
            work = found(service, identity)
    if work.status == "dismissed":
        typer.echo(f"{identity} is cancelled")
    elif work.status in ENDED:
        typer.echo(f"{identity} has ended as {work.status}; its results are kept")
    else:
        typer.echo(f"{identity} stops at the end of its present step")


def _print_status(work: "JobDocument | BatchDocument", as_json: bool) -> None:
    document = work.model_dump(mode="json")
    if not for_people(as_json):
        write(document, None)
        return
    for name, value in document.items():
        if name != "links" and value not in (None, "", [], {}):
            typer.echo(f"{name.replace('_', ' '):17} {_shown(value)}")


def _shown(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {inner}" for name, inner in value.items() if inner is not None)
    if isinstance(value, list):
        return "; ".join(_shown(item) for item in value)
    return str(value)


def _in_short(job: Mapping[str, Any]) -> dict[str, Any]:
    seconds = job["duration_seconds"]
    return {
        **job,
        "progress": f"{job['progress']:.0%}",
        "created_at": job["created_at"][:19].replace("T", " "),
        "duration_seconds": None if seconds is None else f"{seconds:.1f}",
    }
