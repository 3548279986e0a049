"""Engines and sessions for SQLite and PostgreSQL, and the clock by which all processes judge leases."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from sqlite3 import Connection as SQLiteConnection
from typing import Any, cast

import orjson
from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    NullPool,
    Table,
    create_engine,
    event,
    insert,
    make_url,
    select,
)
from sqlalchemy.orm import Session, sessionmaker
from sqlalchemy.sql.functions import func

from app.runtime.private_files import keep_private, make_private_file, make_private_folder
from app.runtime.settings import Settings
from app.storage.replaced_files import stay_with_file
from app.tables import Base, UtcDateTime

_BUSY_SECONDS = 30.0
# One connection for each thread of the API: a connection above the pool size would be reopened for every use.
_POOL: dict[str, Any] = {"pool_size": 40, "max_overflow": 0}
_IMPATIENT: dict[str, Any] = {"connect_timeout": 2, "options": "-c statement_timeout=2000"}
_READ_ONLY = "25006"  # PostgreSQL's code for a change where none may be made, as on a standby
_CLOCK = "database time of this transaction"


def make_engine(settings: Settings, *, impatient: bool = False, idle_seconds: float = 0.0) -> Engine:
    """Create the engine for the configured database; create the directory of an SQLite file if it is missing.

    Other users of the machine cannot read a database in `data_dir`; one made earlier is taken from them.

    SQLite: write-ahead log, foreign keys, a busy timeout, and every transaction begins as a writer (`BEGIN IMMEDIATE`)
    unless its session comes from `session_factory(..., read_only=True)`. A reader that became a writer midway would
    fail at once with "locked", whatever the timeout. A connection whose file was replaced is not used again.
    PostgreSQL: connections are tested before use. An impatient engine serves health checks: it opens a new connection
    for each and gives up soon. With `idle_seconds` above zero the server ends a transaction that does nothing for so
    long: a stopped process would keep its rows locked.

    Raises
    ------
    OSError
        If the directory cannot be created or written to, or the file cannot be created.
    """
    url = make_url(settings.database_url)
    create = partial(create_engine, url, json_serializer=_json_text)
    if url.get_backend_name() != "sqlite":
        if impatient:
            return create(poolclass=NullPool, connect_args=_IMPATIENT)
        options = f"-c idle_in_transaction_session_timeout={round(1000.0 * idle_seconds)}"  # zero is no limit
        return create(pool_pre_ping=True, connect_args={"connect_timeout": 10, "options": options}, **_POOL)
    patience = {"timeout": _IMPATIENT["connect_timeout"] if impatient else _BUSY_SECONDS}
    engine = create(poolclass=NullPool, connect_args=patience) if impatient else create(connect_args=patience, **_POOL)
    if url.database:
        _make_file(Path(url.database), settings.data_dir)
        stay_with_file(engine, Path(url.database))
    event.listen(engine, "connect", _prepare_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _make_file(file: Path, data_dir: Path) -> None:
    if file.parent != data_dir:  # the operator chose this place, and who may read it
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()
        return
    make_private_folder(data_dir)
    make_private_file(file)
    for beside in data_dir.glob(f"{file.name}-*"):  # new ones get the mode of the database
        keep_private(beside)


def takes_no_changes(error: Exception) -> bool:
    """Tell whether the database refuses a statement because it may not write, or has no room to."""
    cause = getattr(error, "orig", None)
    of_sqlite = str(getattr(cause, "sqlite_errorname", "")).startswith(("SQLITE_READONLY", "SQLITE_FULL"))
    return of_sqlite or getattr(cause, "sqlstate", None) == _READ_ONLY


def session_factory(engine: Engine, *, read_only: bool = False) -> sessionmaker[Session]:
    """Return a factory of sessions whose objects stay readable after the commit.

    A session that only reads should come from a `read_only` factory. On SQLite it then neither waits for a writer nor
    blocks one; on PostgreSQL the server refuses writes in it. `app.storage.pages` frees its
    connection between pages.
    """
    bind = engine.execution_options(read_only=True, **_read_only_options(engine)) if read_only else engine
    return sessionmaker(bind, expire_on_commit=False)


def database_time(session: Session) -> datetime:
    """Return the database server's time in UTC, so that workers with differing clocks agree.

    The server is queried once for each transaction; transactions are short.
    """
    if session.get_bind().dialect.name != "postgresql":
        return datetime.now(UTC)
    read_in, moment = session.info.get(_CLOCK, (None, None))
    if read_in is None or read_in is not session.get_transaction():
        moment = session.execute(select(func.clock_timestamp(type_=UtcDateTime))).scalar_one()
        keep_database_time(session, moment)
    found: datetime = moment
    return found


def keep_database_time(session: Session, moment: datetime) -> None:
    """Let `database_time` return a moment that another query of this transaction has read."""
    session.info[_CLOCK] = session.get_transaction(), moment


def database_moment(session: Session) -> datetime | ColumnElement[datetime]:
    """Return `database_time` for a statement that writes it; a server evaluates its clock there without a query."""
    if session.get_bind().dialect.name != "postgresql":
        return database_time(session)
    return func.clock_timestamp(type_=UtcDateTime)


def serialize(session: Session, subject: str) -> None:
    """Let no other transaction pass here with the same subject until this one ends; SQLite has one writer at once."""
    if session.get_bind().dialect.name == "postgresql":
        session.execute(select(func.pg_advisory_xact_lock(func.hashtextextended(subject, 0))))


def insert_rows(session: Session, kind: type[Base], records: Sequence[Mapping[str, Any]]) -> None:
    """Insert any number of rows in one call of the driver.

    All rows name the same columns; any other column gets its default or null.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database refuses a row, or fails.
    """
    if records:
        session.execute(insert(cast(Table, kind.__table__)), records)


def _json_text(value: object) -> str:
    return orjson.dumps(value).decode()  # half of the processor time of a row of a batch, compared with the json module


def _read_only_options(engine: Engine) -> dict[str, Any]:
    return {"postgresql_readonly": True} if engine.dialect.name == "postgresql" else {}


def _prepare_sqlite(connection: SQLiteConnection, _: object) -> None:
    connection.isolation_level = None  # the driver must not begin transactions: _begin_sqlite does
    for pragma in ("journal_mode=WAL", "synchronous=NORMAL", "foreign_keys=ON"):
        connection.execute(f"PRAGMA {pragma}").close()


def _begin_sqlite(connection: Connection) -> None:
    reads = connection.get_execution_options().get("read_only", False)
    connection.exec_driver_sql("BEGIN" if reads else "BEGIN IMMEDIATE")
