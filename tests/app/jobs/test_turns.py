from typing import Any
from uuid import UUID, uuid4

import pytest
from sqlalchemy import event, update
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases, turns
from app.security.caller import LOCAL
from app.tables import Job
from tests.documents import STRANGER, add_job, create_job
from tests.threads import at_once

MANY = 30
ENOUGH = 40  # draws after which one of two owners has not come up once in a million million times


def of_stranger(sessions: sessionmaker[Session]) -> UUID:
    with sessions.begin() as session:
        return create_job(session, STRANGER, {"line": {}}).id


def as_chunks(sessions: sessionmaker[Session], job_ids: list[UUID], batch_id: UUID) -> None:
    with sessions.begin() as session:
        session.execute(update(Job).where(Job.id.in_(job_ids)).values(batch_id=batch_id, lines=1))


def draw(sessions: sessionmaker[Session], job_id: UUID) -> UUID | None:
    with sessions() as session:
        return turns.in_turn(session, job_id)


def claim(sessions: sessionmaker[Session], job_id: UUID) -> None:
    with sessions.begin() as session:
        assert leases.claim(session, job_id, "here", 30.0) is not None


def test_an_owner_alone_has_jobs_run_as_their_messages_come(sessions: sessionmaker[Session]) -> None:
    jobs = [add_job(sessions) for _ in range(3)]
    assert [draw(sessions, job_id) for job_id in reversed(jobs)] == jobs[::-1]


def test_nothing_is_run_where_nothing_waits(sessions: sessionmaker[Session]) -> None:
    assert draw(sessions, uuid4()) is None
    job_id = add_job(sessions)
    claim(sessions, job_id)
    assert draw(sessions, job_id) is None


def test_a_message_whose_job_was_run_by_another_one_lets_the_oldest_run(sessions: sessionmaker[Session]) -> None:
    ran, *others = [add_job(sessions) for _ in range(3)]
    claim(sessions, ran)
    assert draw(sessions, ran) == others[0]


def test_owners_take_turns_however_many_jobs_one_of_them_has(sessions: sessionmaker[Session]) -> None:
    crowd = [add_job(sessions) for _ in range(MANY)]
    alone = of_stranger(sessions)
    drawn = {draw(sessions, crowd[0]) for _ in range(ENOUGH)}
    assert drawn == {crowd[0], alone}
    claim(sessions, crowd[0])
    assert {draw(sessions, crowd[1]) for _ in range(ENOUGH)} == {alone}, "nothing of its owner runs"
    claim(sessions, alone)
    assert {draw(sessions, alone) for _ in range(ENOUGH)} == {crowd[1]}, (
        "the message of a job that runs moves another on"
    )


@pytest.mark.parametrize("single", [True, False])
def test_an_owners_single_jobs_come_before_chunks_and_these_by_batch(
    sessions: sessionmaker[Session], single: bool
) -> None:
    chunks = [add_job(sessions) for _ in range(4)]
    first, second = sorted((uuid4(), uuid4()))
    as_chunks(sessions, chunks[:2], second)
    as_chunks(sessions, chunks[2:], first)
    expected = add_job(sessions) if single else chunks[2]
    assert draw(sessions, uuid4()) == expected


def test_turns_are_found_along_the_index_of_waiting_jobs(sessions: sessionmaker[Session]) -> None:
    of_stranger(sessions)
    job_id, asked = add_job(sessions), []

    def note(_: Any, __: Any, statement: str, parameters: Any, *___: Any) -> None:
        asked.append((statement, parameters))

    with sessions() as session:
        connection = session.connection()
        event.listen(connection, "before_cursor_execute", note)
        turns.in_turn(session, uuid4())
        turns.in_turn(session, job_id)
        event.remove(connection, "before_cursor_execute", note)
        explain = "EXPLAIN QUERY PLAN"
        if connection.dialect.name == "postgresql":
            connection.exec_driver_sql("SET LOCAL enable_seqscan = off")  # of a table almost without rows
            explain = "EXPLAIN"
        plans = [str(connection.exec_driver_sql(f"{explain} {text}", values).all()) for text, values in asked]
    waiting = [plan for plan in plans if "ix_jobs_waiting" in plan]
    assert len(waiting) >= 3, plans
    assert all("_jobs" in plan and "Seq Scan" not in plan for plan in plans), plans


def test_an_owner_runs_as_many_jobs_as_he_may_and_others_go_on(sessions: sessionmaker[Session]) -> None:
    crowd = [add_job(sessions) for _ in range(4)]
    taken = [take(sessions, job_id, most=2) for job_id in crowd]
    assert taken == [*crowd[:2], None, None]
    alone = of_stranger(sessions)
    assert take(sessions, crowd[3], most=2) == alone
    assert take(sessions, crowd[3], most=3) == crowd[3]
    with sessions.begin() as session:
        assert list(session.scalars(turns.having(3))) == [LOCAL.owner]
        assert turns.next_of(session, LOCAL.owner) == crowd[2]
        assert turns.next_of(session, STRANGER.owner) is None


@pytest.mark.parametrize("most", [1, 3])
def test_workers_that_claim_at_once_do_not_pass_the_last_place(sessions: sessionmaker[Session], most: int) -> None:
    crowd, others = [add_job(sessions) for _ in range(8)], [of_stranger(sessions) for _ in range(8)]
    taken: list[UUID] = []

    def one(number: int) -> None:
        for job_id in (crowd[number], others[number]):
            found = take(sessions, job_id, most)
            if found is not None:
                taken.append(found)

    at_once(one, 8)
    assert len(set(taken)) == len(taken) == 2 * most
    assert len(set(taken) & set(crowd)) == len(set(taken) & set(others)) == most


def take(sessions: sessionmaker[Session], job_id: UUID, most: int) -> UUID | None:
    """Choose and claim a job as a worker does."""
    with sessions.begin() as session:
        chosen = turns.in_turn(session, job_id, most)
        if chosen is not None:
            assert leases.claim(session, chosen, "here", 30.0) is not None
    return chosen
