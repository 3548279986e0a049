"""`galloping audit`: show the audit record, or export all of it."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import json as json_text
from datetime import UTC, datetime, timedelta
from typing import Annotated, Any

import typer

from app.cli.common import with_common_options
from app.cli.console import for_people, print_table, write
from app.cli.inputs import read_settings, using_database
from app.cli.options import AsJson, DataDirectory

commands = typer.Typer(help="Show who changed what, newest first; `export` writes the whole record.")

_COLUMNS = ("at", "owner", "key_id", "action", "subject", "detail")

Owner = Annotated[str | None, typer.Option(help="Only events of this owner's keys.")]
Moment = Annotated[datetime | None, typer.Option(help="In UTC, such as 2026-11-30 or 2026-11-30T06:00:00.")]


@commands.callback(invoke_without_command=True)
@with_common_options
def show(
    context: typer.Context,
    owner: Owner = None,
    days: Annotated[int | None, typer.Option(min=1, help="Only events of this many last days.")] = None,
    limit: Annotated[int, typer.Option(min=1, max=100_000, help="Most events to show.")] = 50,
    json: AsJson = False,
    data_dir: DataDirectory = None,
) -> None:
    """Show who changed what, newest first; `export` writes the whole record."""
    if context.invoked_subcommand is not None:
        return
    from app.security import audit as record

    since = datetime.now(UTC) - timedelta(days=days) if days else None
    with using_database(read_settings(data_dir)) as sessions, sessions() as session:
        events = [_event(event, "seconds") for event in record.latest(session, owner, since, limit)]
    if for_people(json):
        print_table(_COLUMNS, events)
    else:
        write({"events": events}, None)


@commands.command()
@with_common_options
def export(
    since: Moment = None,
    until: Moment = None,
    owner: Owner = None,
    data_dir: DataDirectory = None,
) -> None:
    """Write events as JSON, one a line, oldest first; those of the moment `until` and later are left out.

    The ids of events never change, so that what two exports share can be told.
    """
    from app.security import audit as record

    span = tuple(moment.replace(tzinfo=UTC) if moment else None for moment in (since, until))
    with using_database(read_settings(data_dir)) as sessions, sessions() as session:
        for event in record.between(session, owner, *span):
            typer.echo(json_text.dumps({"id": str(event.id), **_event(event, "microseconds")}))


def _event(event: Any, precision: str) -> dict[str, Any]:
    named = {name: getattr(event, name) for name in ("key_id", "subject")}
    return {
        "at": event.at.isoformat(timespec=precision),
        "owner": event.owner,
        "action": event.action.value,
        "detail": event.detail,
        **{name: str(value) if value else None for name, value in named.items()},
    }
