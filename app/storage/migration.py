"""The database's schema: brought to the newest revision, and whether it has it."""

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, text

from app.runtime.settings import Settings
from app.storage.database import make_engine

_MIGRATION_LOCK = 4_105_912_717  # any number of our own, the same in every process


def migrate(settings: Settings) -> int:
    """Bring the database to the newest revision; several at once wait for each other. Returns 0.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database cannot be reached or refuses.
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
    """Make Alembic's configuration for our migrations on an open connection."""
    config = Config()
    config.set_main_option("script_location", "migrations:")
    config.attributes["connection"] = connection
    return config


def is_newest(connection: Connection) -> bool:
    """Tell whether a database has the newest schema."""
    present = MigrationContext.configure(connection).get_current_heads()
    return set(present) == set(ScriptDirectory.from_config(alembic_config(connection)).get_heads())


def _take_turns(connection: Connection) -> None:
    # SQLite's transactions begin as writers already, so that only one of them is past this line.
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": _MIGRATION_LOCK})
