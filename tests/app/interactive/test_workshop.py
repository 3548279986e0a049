import asyncio
import os
from collections.abc import Coroutine
from typing import Any
from unittest import mock

import pytest

from app.interactive import Busy, Workshop, workshop


def run(steps: Coroutine[Any, Any, Any]) -> Any:
    return asyncio.run(steps)


def test_a_process_that_was_killed_is_replaced() -> None:
    async def both() -> tuple[float, float]:
        here = Workshop(1)
        try:
            first = await here.run("north", abs, -2.0)
            assert here._pool is not None
            for process in list(here._pool._processes.values()):  # as if the kernel had ended it for want of memory
                os.kill(process.pid or 0, 9)
                process.join()
            return first, await here.run("north", abs, -3.0)
        finally:
            here.close()

    assert run(both()) == (2.0, 3.0)


@pytest.fixture
def order(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Give the calls in the order in which they were done, without processes."""
    done: list[str] = []

    async def note(_: Workshop, _call: object, name: str) -> str:
        await asyncio.sleep(0)
        done.append(name)
        return name

    monkeypatch.setattr(Workshop, "_done", note)
    return done


def test_an_owner_with_many_calls_delays_another_by_few(order: list[str]) -> None:
    async def all_at_once() -> None:
        here = Workshop(2)
        greedy = [here.run("greedy", str, "greedy") for _ in range(20)]
        await asyncio.gather(*greedy, here.run("modest", str, "modest"))
        assert here._owners == {}

    run(all_at_once())
    assert order.index("modest") <= 4


def test_more_calls_than_may_wait_are_refused_at_once(order: list[str]) -> None:
    async def all_at_once() -> list[Any]:
        here = Workshop(1, most_of_owner=2, most=4)
        owners = ("a", "a", "a", "b", "b", "c")
        answers = await asyncio.gather(*(here.run(name, str, name) for name in owners), return_exceptions=True)
        return [*answers, await here.run("c", str, "c")]

    answers = run(all_at_once())
    assert [answer if isinstance(answer, str) else type(answer) for answer in answers] == [
        *["a", "a", Busy, "b", "b", Busy],
        "c",
    ]
    assert sorted(order) == ["a", "a", "b", "b", "c"]


def test_without_a_call_there_is_no_process() -> None:
    with mock.patch.object(workshop, "ProcessPoolExecutor") as pool:
        Workshop(1).close()
    assert not pool.called
