import asyncio
import threading
from collections.abc import Sequence
from uuid import UUID, uuid4

import pytest
from sqlalchemy import insert
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session, sessionmaker

from app.coalescing.grouped_calls import Groups, committed_together
from app.jobs import job_records
from app.jobs.job_records import JobFilters
from app.security.caller import LOCAL
from app.tables import JobTag
from tests.documents import add_job, create_job, history


def test_what_is_asked_meanwhile_is_answered_as_one_group() -> None:
    sizes: list[int] = []
    first_may_end = threading.Event()

    def answer(questions: Sequence[int]) -> list[int]:
        sizes.append(len(questions))
        assert first_may_end.wait(30.0)
        return [2 * question for question in questions]

    async def ask() -> list[int]:
        groups = Groups("test", answer)
        asked = [asyncio.ensure_future(groups.ask(number)) for number in range(150)]
        await asyncio.sleep(0)
        first_may_end.set()
        found = await asyncio.gather(*asked)
        await groups.close()
        return found

    assert asyncio.run(ask()) == [2 * number for number in range(150)]
    assert sum(sizes) == 150
    assert len(sizes) <= 3
    assert max(sizes) == 100


def test_an_exception_reaches_whoever_asked() -> None:
    def answer(questions: Sequence[int]) -> list[int | Exception]:
        if 13 in questions:
            raise OSError("the whole group")
        return [ValueError(f"{question}") if question < 0 else question for question in questions]

    async def ask() -> None:
        groups = Groups("test", answer)
        assert await groups.ask(1) == 1
        with pytest.raises(ValueError, match="-1"):
            await groups.ask(-1)
        with pytest.raises(OSError, match="whole group"):
            await groups.ask(13)
        assert await groups.ask(2) == 2
        await groups.close()

    asyncio.run(ask())


def test_who_has_gone_holds_up_nobody_and_closing_waits_for_the_rest() -> None:
    answered: list[int] = []

    def answer(questions: Sequence[int]) -> Sequence[int]:
        answered.extend(questions)
        return questions

    async def ask() -> None:
        groups = Groups("test", answer)
        gone, stays = asyncio.ensure_future(groups.ask(1)), groups.put(2)
        await asyncio.sleep(0)
        gone.cancel()
        assert await stays == 2
        groups.put(3)
        await groups.close()

    asyncio.run(ask())
    assert sorted(answered) == [1, 2, 3]


def test_a_rest_after_a_group_lets_the_next_one_gather() -> None:
    groups_answered: list[list[int]] = []

    def answer(questions: Sequence[int]) -> Sequence[int]:
        groups_answered.append(list(questions))
        return questions

    async def ask() -> None:
        patient = Groups[int, int]("test", answer, rest_seconds=3600.0)
        assert [await patient.ask(1), await patient.ask(2)] == [1, 2]  # one by itself waits for nobody
        assert [*await asyncio.gather(patient.ask(3), patient.ask(4))] == [3, 4]
        later = [patient.put(number) for number in (5, 6)]
        await asyncio.sleep(0.05)
        assert groups_answered == [[1], [2], [3, 4]]
        await patient.close()
        assert [future.result() for future in later] == [5, 6]

    asyncio.run(ask())
    assert groups_answered == [[1], [2], [3, 4], [5, 6]]


def test_a_full_group_waits_for_no_rest() -> None:
    async def ask() -> None:
        patient = Groups[int, int]("test", lambda questions: questions, rest_seconds=3600.0)
        async with asyncio.timeout(30.0):
            assert await asyncio.gather(*map(patient.ask, range(200))) == list(range(200))
        await patient.close()

    asyncio.run(ask())


def made(session: Session, questions: Sequence[str]) -> list[UUID]:
    """Make a job for every question; one question is refused, another cannot be stored."""
    if "refuse" in questions:
        raise ValueError("refused")
    ids = [create_job(session, LOCAL, {"line": {}}).id for _ in questions]
    if "impossible" in questions:
        session.execute(insert(JobTag).values(job_id=uuid4(), key="of", value="nothing"))
    return ids


def test_work_of_many_is_committed_together(sessions: sessionmaker[Session]) -> None:
    answers = committed_together(sessions, made, ["make"] * 20)
    with sessions() as session:
        found = job_records.page(session, LOCAL.owner, JobFilters(), None, 100)
    assert {job.id for job in found} == set(answers)
    assert history(sessions, found[0].id) == [("accepted", 0)]


def test_work_that_fails_leaves_the_others_alone(sessions: sessionmaker[Session]) -> None:
    there = add_job(sessions)
    first, refused, impossible, last = committed_together(sessions, made, ["make", "refuse", "impossible", "make"])
    assert isinstance(refused, ValueError) and isinstance(impossible, IntegrityError)
    with sessions() as session:
        found = {job.id for job in job_records.page(session, LOCAL.owner, JobFilters(), None, 100)}
    assert found == {there, first, last}
