"""Bring the database's schema to the newest revision, and tell whether it has it."""

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, text

from app.runtime.settings import Settings
from app.storage.database import make_engine

_MIGRATION_LOCK = 4_105_912_717  # an arbitrary number, the same in every process


def migrate(settings: Settings) -> int:
    """Bring the database to the newest revision and return 0; concurrent calls wait for each other.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database cannot be reached or refuses a statement.
    """
    engine = make_engine(settings)
    try:
        with engine.begin() as connection:
            _take_turns(connection)
            command.upgrade(alembic_config(connection), "head")
    finally:
        engine.dispose()
    return 0


def alembic_config(connection: Connection) -> Config:
    """Return Alembic's configuration for our migrations on an open connection."""
    config = Config()
    config.set_main_option("script_location", f"{__package__.removesuffix('app.storage')}migrations:")
    config.attributes["connection"] = connection
    return config


def is_newest(connection: Connection) -> bool:
    """Tell whether the database has the newest schema."""
    present = MigrationContext.configure(connection).get_current_heads()
    return set(present) == set(ScriptDirectory.from_config(alembic_config(connection)).get_heads())


def is_empty(connection: Connection) -> bool:
    """Tell whether the database was never migrated, as a new one."""
    return not MigrationContext.configure(connection).get_current_heads()


def _take_turns(connection: Connection) -> None:
    # SQLite transactions begin as writers, so only one of them can pass this line.
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": _MIGRATION_LOCK})
