"""Commands for the operator of a service: `status`, `prune`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from datetime import timedelta
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.console import FAILED, for_people, print_table, write
from app.cli.inputs import ending_on_faults, read_settings, require_database, using_database
from app.cli.options import AsJson, DataDirectory

if TYPE_CHECKING:
    from app.operation.service_status import Contents, Status

_WORKERS = ("name", "version", "processes", "running", "seen")


def status(json: AsJson = False, data_dir: DataDirectory = None) -> None:
    """Show database, broker, workers, owners, queues, jobs and leases; exit with 1 if anything needs the operator."""
    from app.operation import service_status as service

    settings = read_settings(data_dir)
    require_database(settings)
    with ending_on_faults():
        found = service.read_status(settings)
    if for_people(json):
        _show(found)
    else:
        from dataclasses import asdict

        write({**asdict(found), "faults": found.faults()}, None)
    raise typer.Exit(FAILED if found.faults() else 0)


def prune(
    days: Annotated[
        int,
        typer.Option(
            min=1, envvar="GALLOPING_RETENTION_DAYS", help="Keep jobs and batches that ended within this many days."
        ),
    ],
    audit_days: Annotated[
        int,
        typer.Option(min=1, envvar="GALLOPING_AUDIT_RETENTION_DAYS", help="Keep this many days of the audit record."),
    ] = 730,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only count what would be removed.")] = False,
    json: AsJson = False,
    data_dir: DataDirectory = None,
) -> None:
    """Remove jobs and batches that ended long ago, with results and events; keep those that wait or run."""
    from dataclasses import asdict

    from app.operation import prune as retention

    kept = retention.Retention(timedelta(days=days), timedelta(days=audit_days))
    with using_database(read_settings(data_dir)) as sessions:
        counts = asdict((retention.due if dry_run else retention.prune)(sessions, kept))
    if not for_people(json):
        write({"dry_run": dry_run, **counts}, None)
        return
    summary = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in counts.items())
    typer.echo(f"{'would remove' if dry_run else 'removed'} {summary}")


def _show(found: "Status") -> None:
    typer.echo(f"database  {found.database}\nbroker    {found.broker}")
    if found.queues is not None:
        typer.echo(f"queues    {found.queues.jobs} messages for jobs, {found.queues.chunks} for chunks")
    if found.contents is not None:
        _show_contents(found.contents)
    for sentence in found.faults():
        typer.secho(sentence, fg=typer.colors.RED)


def _show_contents(contents: "Contents") -> None:
    leases = contents.leases
    typer.echo(f"leases    {leases.held} held, {leases.expired} expired; {leases.undispatched} jobs without a message")
    kinds = {"jobs": contents.jobs, "chunks of batches": contents.chunks}
    rows = [
        {"kind": kind, **work.by_status, "oldest waiting": _seconds(work.oldest_waiting_seconds)}
        for kind, work in kinds.items()
    ]
    print_table(tuple(rows[0]), rows)
    if contents.owners:
        names = ("owner", "running", "waiting", "stored MB")
        owners = [
            dict(zip(names, (owner, had.running, had.waiting, f"{1e-6 * had.stored:.1f}"), strict=True))
            for owner, had in contents.owners.items()
        ]
        print_table(names, owners)
    if contents.workers:
        seen = ({"seen": f"{_seconds(worker.seen_seconds_ago)} ago"} for worker in contents.workers)
        states = [
            {name: getattr(worker, name) for name in _WORKERS[:-1]} | ago
            for worker, ago in zip(contents.workers, seen, strict=True)
        ]
        print_table(_WORKERS, states)


def _seconds(seconds: float | None) -> str | None:
    return None if seconds is None else f"{seconds:.0f} s"
