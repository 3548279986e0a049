"""Bring the database's schema to another revision, and tell whether it has that of this version."""

from dataclasses import dataclass

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util import CommandError
from sqlalchemy import Connection, text

from app.runtime.settings import Settings
from app.storage.database import make_engine

_MIGRATION_LOCK = 4_105_912_717  # an arbitrary number, the same in every process


@dataclass(frozen=True)
class Migrated:
    """The revisions of a database before and after; None before the first migration."""

    before: str | None
    after: str


def migrate(settings: Settings, to: str | None = None) -> Migrated:
    """Bring the database to a revision, the newest if None; concurrent calls wait for each other.

    The way back to an older one removes what its schema has no place for.

    Raises
    ------
    alembic.util.CommandError
        If this version does not know the revision, or that of the database.
    sqlalchemy.exc.SQLAlchemyError
        If the database cannot be reached or refuses a statement.
    """
    engine = make_engine(settings)
    try:
        with engine.begin() as connection:
            _take_turns(connection)
            return _move(connection, to)
    finally:
        engine.dispose()


def _move(connection: Connection, to: str | None) -> Migrated:
    known = _known(connection)
    before, after = _present(connection), known[-1] if to is None else to
    if before is not None and before not in known:
        raise CommandError(f"it {_of_a_newer_version(before, known[-1])}")
    if after not in known:
        raise CommandError(f"this version knows no revision {after}, only {known[0]} to {known[-1]}")
    back = before is not None and known.index(after) < known.index(before)
    (command.downgrade if back else command.upgrade)(alembic_config(connection), after)
    return Migrated(before, after)


def alembic_config(connection: Connection) -> Config:
    """Return Alembic's configuration for our migrations on an open connection."""
    config = Config()
    config.set_main_option("script_location", f"{__package__.removesuffix('app.storage')}migrations:")
    config.attributes["connection"] = connection
    return config


def schema_fault(connection: Connection) -> str | None:
    """Return what is wrong with the database's schema as the end of a sentence, or None if it is this version's."""
    present, known = _present(connection), _known(connection)
    if present == known[-1]:
        return None
    if present is None or present in known:
        return "has an older schema: run `galloping migrate`"
    return _of_a_newer_version(present, known[-1])


def is_empty(connection: Connection) -> bool:
    """Tell whether the database was never migrated, as a new one."""
    return _present(connection) is None


def _of_a_newer_version(present: str, newest: str) -> str:
    return f"has the schema {present} of a newer version, whose `galloping migrate --to {newest}` takes it back"


def _present(connection: Connection) -> str | None:
    return MigrationContext.configure(connection).get_current_revision()


def _known(connection: Connection) -> list[str]:
    """Return the revisions of this version, the oldest first."""
    scripts = ScriptDirectory.from_config(alembic_config(connection))
    return [script.revision for script in scripts.walk_revisions()][::-1]


def _take_turns(connection: Connection) -> None:
    # SQLite transactions begin as writers, so only one of them can pass this line.
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": _MIGRATION_LOCK})
