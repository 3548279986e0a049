from collections.abc import Iterator
from typing import Any
from uuid import UUID

import pytest
from sqlalchemy import Engine, Row, delete, select
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.storage.database import insert_rows, make_engine, session_factory
from app.storage.pages import Removed, in_pages
from app.tables import Job, JobEvent, JobEventKind
from tests.documents import add_job

EVENTS = 25


@pytest.fixture
def engine(settings: Settings, sessions: sessionmaker[Session]) -> Iterator[Engine]:
    """Give an engine with its own pool of connections."""
    del sessions  # has migrated the database
    engine = make_engine(settings)
    yield engine
    engine.dispose()


@pytest.fixture
def job_id(sessions: sessionmaker[Session]) -> UUID:
    """Give a job whose events are the rows to read."""
    job_id = add_job(sessions)
    with sessions.begin() as session:
        session.execute(delete(JobEvent))
        at = session.scalars(select(Job.created_at)).one()
        event = {"job_id": job_id, "at": at, "kind": JobEventKind.RUNNING, "detail": None}
        insert_rows(session, JobEvent, [{**event, "attempt": number} for number in range(EVENTS)])
    return job_id


def events(session: Session, job_id: UUID, size: int) -> Iterator[Row[Any]]:
    of_job = select(JobEvent.id, JobEvent.attempt).where(JobEvent.job_id == job_id)
    return in_pages(session, of_job, JobEvent.id, size, select(Job.id).where(Job.id == job_id))


@pytest.mark.parametrize("size", [1, 10, EVENTS, EVENTS + 1])
def test_every_row_comes_once_in_order(engine: Engine, job_id: UUID, size: int) -> None:
    with session_factory(engine, read_only=True)() as session:
        assert [row.attempt for row in events(session, job_id, size)] == list(range(EVENTS))


def test_a_session_that_only_reads_holds_no_connection_while_rows_are_used(engine: Engine, job_id: UUID) -> None:
    pool: Any = engine.pool
    with session_factory(engine, read_only=True)() as session:
        assert {pool.checkedout() for _ in events(session, job_id, 10)} == {0}


def test_a_session_that_writes_keeps_its_transaction(engine: Engine, job_id: UUID) -> None:
    sessions = session_factory(engine)
    with sessions() as session:
        session.execute(delete(JobEvent).where(JobEvent.attempt >= EVENTS - 1))
        assert len(list(events(session, job_id, 10))) == EVENTS - 1
    with sessions() as session:
        assert len(list(events(session, job_id, 10))) == EVENTS


@pytest.mark.parametrize("size", [EVENTS, 10])
def test_what_is_removed_meanwhile_does_not_end_as_if_it_were_whole(engine: Engine, job_id: UUID, size: int) -> None:
    with session_factory(engine, read_only=True)() as session:
        rows = events(session, job_id, size)
        next(rows)
        with session_factory(engine).begin() as other:
            other.execute(delete(JobEvent))
            other.execute(delete(Job))
        with pytest.raises(Removed):
            list(rows)
        with pytest.raises(Removed):
            list(events(session, job_id, size))
