import asyncio
import threading
from collections.abc import Sequence
from uuid import UUID, uuid4

import pytest
from sqlalchemy import insert
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session, sessionmaker

from app.coalescing.grouped_calls import GroupedCalls, committed_together
from app.jobs import job_records
from app.jobs.job_records import JobFilters
from app.security.caller import LOCAL
from app.tables import JobTag
from tests.documents import add_job, create_job, history


def test_calls_made_while_a_group_is_at_work_are_the_next_group() -> None:
    sizes: list[int] = []
    first_may_end = threading.Event()

    def work(arguments: Sequence[int]) -> list[int]:
        sizes.append(len(arguments))
        assert first_may_end.wait(30.0)
        return [2 * argument for argument in arguments]

    async def call() -> list[int]:
        calls = GroupedCalls("test", work)
        started = [asyncio.ensure_future(calls.call(number)) for number in range(150)]
        await asyncio.sleep(0)
        first_may_end.set()
        found = await asyncio.gather(*started)
        await calls.close()
        return found

    assert asyncio.run(call()) == [2 * number for number in range(150)]
    assert sum(sizes) == 150
    assert len(sizes) <= 3
    assert max(sizes) == 100


def test_after_a_group_of_several_the_next_gathers_for_the_pause() -> None:
    sizes: list[int] = []

    def work(arguments: Sequence[int]) -> Sequence[int]:
        sizes.append(len(arguments))
        return arguments

    async def call() -> None:
        calls = GroupedCalls("test", work, pause_seconds=30.0)
        await asyncio.gather(calls.call(1), calls.call(2))
        late = [calls.submit(number) for number in (3, 4, 5)]
        await asyncio.sleep(0.05)
        assert not any(future.done() for future in late)
        await calls.close()  # ends the pause
        assert [future.result() for future in late] == [3, 4, 5]

    asyncio.run(call())
    assert sizes == [2, 3]


def test_an_exception_is_raised_in_its_call() -> None:
    def work(arguments: Sequence[int]) -> list[int | Exception]:
        if 13 in arguments:
            raise OSError("the whole group")
        return [ValueError(f"{argument}") if argument < 0 else argument for argument in arguments]

    async def call() -> None:
        calls = GroupedCalls("test", work)
        assert await calls.call(1) == 1
        with pytest.raises(ValueError, match="-1"):
            await calls.call(-1)
        with pytest.raises(OSError, match="whole group"):
            await calls.call(13)
        assert await calls.call(2) == 2
        await calls.close()

    asyncio.run(call())


def test_a_cancelled_call_does_not_stop_others_and_close_waits_for_the_rest() -> None:
    worked_on: list[int] = []

    def work(arguments: Sequence[int]) -> Sequence[int]:
        worked_on.extend(arguments)
        return arguments

    async def call() -> None:
        calls = GroupedCalls("test", work)
        gone, stays = asyncio.ensure_future(calls.call(1)), calls.submit(2)
        await asyncio.sleep(0)
        gone.cancel()
        assert await stays == 2
        calls.submit(3)
        await calls.close()

    asyncio.run(call())
    assert sorted(worked_on) == [1, 2, 3]


def made(session: Session, arguments: Sequence[str]) -> list[UUID]:
    """Make a job for every argument; one is refused, another cannot be stored."""
    if "refuse" in arguments:
        raise ValueError("refused")
    ids = [create_job(session, LOCAL, {"line": {}}).id for _ in arguments]
    if "impossible" in arguments:
        session.execute(insert(JobTag).values(job_id=uuid4(), key="of", value="nothing"))
    return ids


def test_work_of_many_is_committed_together(sessions: sessionmaker[Session]) -> None:
    results = committed_together(sessions, made, ["make"] * 20)
    with sessions() as session:
        found = job_records.page(session, LOCAL.owner, JobFilters(), None, 100)
    assert {job.id for job in found} == set(results)
    assert history(sessions, found[0].id) == [("accepted", 0)]


def test_work_that_fails_leaves_the_others_alone(sessions: sessionmaker[Session]) -> None:
    there = add_job(sessions)
    first, refused, impossible, last = committed_together(sessions, made, ["make", "refuse", "impossible", "make"])
    assert isinstance(refused, ValueError) and isinstance(impossible, IntegrityError)
    with sessions() as session:
        found = {job.id for job in job_records.page(session, LOCAL.owner, JobFilters(), None, 100)}
    assert found == {there, first, last}
