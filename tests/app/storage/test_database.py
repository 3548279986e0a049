from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from uuid import uuid4

import pytest
from sqlalchemy import select, text, update
from sqlalchemy.exc import DBAPIError, OperationalError
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.storage.database import database_time, insert_rows, make_engine, session_factory, takes_no_changes
from app.storage.migration import migrate
from app.tables import BatchItem, Job, PointRow
from tests.documents import add_job, look


def test_writers_at_once_wait_instead_of_failing(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)

    def add_tenths(_: int) -> None:
        for _ in range(20):
            with sessions.begin() as session:
                job = session.execute(select(Job).where(Job.id == job_id).with_for_update()).scalar_one()
                job.attempt += 1

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(add_tenths, range(4)))
    assert look(sessions, job_id).attempt == 80


def test_readers_neither_wait_for_a_writer_nor_see_half_of_it(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    job_id = add_job(sessions)
    engine = make_engine(settings)
    with sessions.begin() as writer, session_factory(engine, read_only=True)() as reader:
        writer.execute(update(Job).values(progress=0.5))
        assert reader.scalars(select(Job.progress)).all() == [0.0]
    engine.dispose()
    assert look(sessions, job_id).progress == 0.5


def test_postgres_refuses_writes_of_readers(postgres_address: str, tmp_path: Path) -> None:
    engine = make_engine(Settings(data_dir=tmp_path, database_url=postgres_address))
    with session_factory(engine, read_only=True)() as reader, pytest.raises(DBAPIError, match="read-only transaction"):
        reader.execute(text("CREATE TABLE forbidden (id integer)"))
    engine.dispose()


def test_database_time_is_now_and_in_utc(sessions: sessionmaker[Session]) -> None:
    moments = []
    for _ in range(2):
        with sessions() as session:
            moments += [database_time(session), database_time(session)]
    first, _, second, _ = moments
    assert first.utcoffset() == timedelta(0)
    assert abs(first - datetime.now(UTC)) < timedelta(seconds=60)
    assert second > first


def test_sqlite_keeps_a_log_and_enforces_foreign_keys(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "made" / "as needed")
    migrate(settings)
    engine = make_engine(settings)
    with engine.connect() as connection:
        assert connection.scalar(text("PRAGMA journal_mode")) == "wal"
        assert connection.scalar(text("PRAGMA foreign_keys")) == 1
    engine.dispose()


def test_rows_inserted_together_are_read_as_they_were(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    common = {"job_id": job_id, "engine_version": "9.9.9", "warnings": ["\u00fcber", 'a "b"\\\n']}
    full = {"sag_m": 0.1 + 0.2, "den_hartog_unstable": True, "tables": bytes(range(256)), "failure": "tab\tand\n \\N"}
    empty = dict.fromkeys(full)
    rows = [
        {**common, "point": 2**31 - 1, "axes": {"a.b": [1, None, 5e-324]}, **full},
        {**common, "point": 0, "axes": {}, **empty},
    ]
    with sessions.begin() as session:
        insert_rows(session, PointRow, rows)
    with sessions() as session:
        found = session.scalars(select(PointRow).order_by(PointRow.point.desc())).all()
    assert [{name: getattr(row, name) for name in rows[0]} for row in found] == rows


def test_rows_that_the_database_cannot_hold_are_refused_as_it_refuses_others(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    row = {"batch_id": uuid4(), "number": 1, "document": {}, "chunk_id": uuid4(), "reference": None, "faults": None}
    wrong = [{**row, "document": None}]  # an item has a document or faults
    if not settings.database_url.startswith("sqlite"):
        wrong += [{**row, "reference": "a\0b"}, {**row, "number": 2**40}]
    for record in wrong:
        with pytest.raises(DBAPIError), sessions.begin() as session:
            insert_rows(session, BatchItem, [record])
    with sessions() as session:
        assert session.scalars(select(BatchItem)).all() == []


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
def test_insert_on_a_lost_connection_is_an_operational_error(sessions: sessionmaker[Session]) -> None:
    row = {"batch_id": uuid4(), "number": 1, "document": {}, "chunk_id": uuid4()}
    with pytest.raises(OperationalError), sessions.begin() as session:
        own = session.scalar(text("SELECT pg_backend_pid()"))
        with sessions.begin() as other:
            other.execute(text("SELECT pg_terminate_backend(:own, 5000)"), {"own": own})
        insert_rows(session, BatchItem, [row])
    with sessions() as session:
        assert session.scalars(select(BatchItem)).all() == []


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
def test_a_process_that_is_stopped_in_a_transaction_keeps_no_row(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    job_id = add_job(sessions)
    engine = make_engine(settings, idle_seconds=0.3)
    with pytest.raises(DBAPIError), session_factory(engine).begin() as stopped:
        stopped.execute(update(Job).values(progress=0.7))
        with sessions.begin() as other:  # waits for the row, and gets it
            other.execute(update(Job).values(progress=0.5))
        stopped.execute(update(Job).values(progress=0.7))
    with session_factory(engine).begin() as next_one:  # the pool has a connection that works
        assert next_one.scalars(select(Job.progress)).all() == [0.5]
    engine.dispose()
    assert look(sessions, job_id).progress == 0.5


def test_other_users_cannot_read_the_embedded_database(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "data")
    migrate(settings)
    file = settings.data_dir / "galloping.sqlite3"
    assert file.stat().st_mode & 0o777 == 0o600
    assert settings.data_dir.stat().st_mode & 0o777 == 0o700
    for path in (file, settings.data_dir):
        path.chmod(0o755)
    engine = make_engine(settings)  # as of a directory that an earlier version made
    with engine.connect():
        held = {path.name: path.stat().st_mode & 0o777 for path in settings.data_dir.iterdir()}
    engine.dispose()
    assert set(held.values()) == {0o600}, held
    assert settings.data_dir.stat().st_mode & 0o777 == 0o700


def test_refusals_to_write_are_told_from_other_faults(sessions: sessionmaker[Session]) -> None:
    def fault(statement: str, prepare: str) -> DBAPIError:
        with sessions() as session:
            session.execute(text(prepare))
            with pytest.raises(DBAPIError) as found:
                session.execute(text(statement))
            session.invalidate()  # SQLite keeps the pragma for as long as the connection
        return found.value

    is_server = sessions.kw["bind"].dialect.name == "postgresql"
    held = "SET TRANSACTION READ ONLY" if is_server else "PRAGMA query_only=1"
    assert takes_no_changes(fault("DELETE FROM jobs", held))
    assert not takes_no_changes(fault("DELETE FROM nothing", "SELECT 1"))
    assert not takes_no_changes(ValueError())
