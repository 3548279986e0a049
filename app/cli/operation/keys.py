"""`galloping keys`: create, list and revoke API keys."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.common import with_common_options
from app.cli.console import BAD_INPUT, end, for_people, notice, print_table, write
from app.cli.inputs import make_missing_database, read_settings, using_database
from app.cli.options import AsJson, DataDirectory
from app.security.caller import LOCAL, OWNER_PATTERN, Scope

if TYPE_CHECKING:
    from app.tables import ApiKey

commands = typer.Typer(help="Create, list and revoke API keys.", no_args_is_help=True)

_COLUMNS = ("prefix", "owner", "name", "scopes", "state", "created_at", "expires_at", "used_at")


@commands.command()
@with_common_options
def create(
    owner: Annotated[
        str, typer.Option(help="Owner of the jobs and batches that the key opens; letters, digits and . _ @ -")
    ],
    scope: Annotated[
        list[Scope] | None, typer.Option(help="Scope of the key; may be repeated; all scopes if absent.")
    ] = None,
    name: Annotated[str | None, typer.Option(help="Purpose of the key.")] = None,
    days: Annotated[
        int | None, typer.Option(min=1, max=36_500, help="Days until the key expires; it never does if absent.")
    ] = None,
    json: AsJson = False,
    data_dir: DataDirectory = None,
) -> None:
    """Create a key and print it; it cannot be shown again. Once a key exists, the service requires one.

    The first key may come before the service: where there is no database yet, it is made.
    """
    from app.security import keys

    if not OWNER_PATTERN.fullmatch(owner):
        end(f"--owner: must be 1 to 64 letters, digits and . _ @ -, got {owner!r}", BAD_INPUT)
    expires_at = datetime.now(UTC) + timedelta(days=days) if days else None
    settings = read_settings(data_dir)
    make_missing_database(settings)
    with using_database(settings) as sessions, sessions.begin() as session:
        key, text = keys.create(session, owner, scope or list(Scope), name, expires_at)
        before = keys.made_before(session) if owner != LOCAL.owner else 0
    if before:
        notice(
            f"{before} job(s) and batch(es) made before keys existed belong to the owner {LOCAL.owner}. "
            f"`galloping keys create --owner {LOCAL.owner}` makes a key that opens them."
        )
    if json:
        write({"key": text, **_document(key)}, None)
        return
    typer.echo(text)
    notice(f"Store this key: it is not shown again. It belongs to {owner} and allows {', '.join(key.scopes)}.")


@commands.command("list")
@with_common_options
def list_keys(
    owner: Annotated[str | None, typer.Option(help="Only this owner's keys.")] = None,
    json: AsJson = False,
    data_dir: DataDirectory = None,
) -> None:
    """List the keys, oldest first, by their visible prefixes."""
    from app.security import keys

    with using_database(read_settings(data_dir)) as sessions, sessions() as session:
        documents = [_document(key) for key in keys.listed(session, owner)]
    if for_people(json):
        print_table(_COLUMNS, documents)
    else:
        write({"keys": documents}, None)


@commands.command()
@with_common_options
def revoke(
    key: Annotated[str, typer.Argument(help="The key, its prefix from the list, or its id.")],
    data_dir: DataDirectory = None,
) -> None:
    """Revoke a key; running services refuse it after at most GALLOPING_KEY_CACHE_SECONDS."""
    from app.security import keys

    settings = read_settings(data_dir)
    try:
        with using_database(settings) as sessions, sessions.begin() as session:
            revoked = keys.revoke(session, key)
    except keys.NotOneKey as error:
        end(str(error), BAD_INPUT)
    typer.echo(
        f"{revoked.prefix} of {revoked.owner} is revoked; services refuse it within {settings.key_cache_seconds:g} s."
    )


def _document(key: "ApiKey") -> dict[str, Any]:
    moments = {name: getattr(key, name) for name in ("created_at", "expires_at", "revoked_at", "used_at")}
    return {
        "id": str(key.id),
        "prefix": key.prefix,
        "owner": key.owner,
        "name": key.name,
        "scopes": key.scopes,
        "state": _state(key),
        **{name: moment and moment.isoformat(timespec="seconds") for name, moment in moments.items()},
    }


def _state(key: "ApiKey") -> str:
    if key.revoked_at is not None:
        return "revoked"
    return "expired" if key.expires_at is not None and key.expires_at <= datetime.now(UTC) else "good"
