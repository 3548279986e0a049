import threading
from functools import partial

import anyio
import pytest
from anyio import create_task_group, fail_after

from app.batches.intake import Places
from app.interactive import Busy


def test_who_waits_leaves_the_turn_to_others() -> None:
    places, order = Places(1, 8), []

    async def both() -> None:
        came = anyio.Event()

        async def slow() -> None:
            await places.run("a", waiting)

        def waiting() -> None:
            order.append("begun")
            places.awaited(came.wait)
            order.append("went on")

        async with create_task_group() as group:
            group.start_soon(slow)
            while not order:
                await anyio.sleep(0.01)
            await places.run("a", lambda: order.append("another"))
            came.set()

    with_time(both)
    assert order == ["begun", "another", "went on"]


def test_no_more_are_read_at_once_than_there_are_turns() -> None:
    places, lock, seen = Places(2, 16), threading.Lock(), [0, 0]

    async def nothing() -> None:
        await anyio.sleep(0.001)

    def work() -> None:
        for _ in range(5):
            with lock:
                seen[0] += 1
                seen[1] = max(seen)
            anyio.from_thread.run(anyio.sleep, 0.001)
            with lock:
                seen[0] -= 1
            places.awaited(nothing)

    async def many() -> None:
        async with create_task_group() as group:
            for number in range(12):
                group.start_soon(places.run, str(number), work)

    with_time(many)
    assert seen == [0, 2]


def test_one_owner_has_half_of_the_places_and_all_are_given_back() -> None:
    places = Places(1, 4)

    async def refused() -> None:
        end = anyio.Event()
        waiting = partial(places.awaited, end.wait)
        async with create_task_group() as group:
            for owner in ("a", "a", "b"):
                group.start_soon(places.run, owner, waiting)
            await anyio.sleep(0.0)
            with pytest.raises(Busy):
                await places.run("a", int)
            assert await places.run("b", int) == 0
            group.start_soon(places.run, "c", waiting)
            await anyio.sleep(0.0)
            with pytest.raises(Busy):
                await places.run("d", int)
            end.set()
        assert await places.run("a", int) == 0

    with_time(refused)


def with_time(call: object) -> None:
    async def bounded() -> None:
        with fail_after(20.0):
            await call()  # type: ignore[operator]

    anyio.run(bounded)
