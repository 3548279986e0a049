import asyncio
import threading
import time

import pytest

from app.coalescing.expiring_cache import Memo


def test_many_who_ask_at_once_wait_for_one_look() -> None:
    looks: list[str] = []

    def look(question: str) -> str:
        time.sleep(0.05)
        looks.append(question)
        return question.upper()

    async def ask() -> list[str]:
        memo = Memo(look, 60.0)
        found = await asyncio.gather(*(memo.ask(question) for question in "ababab"))
        return [*found, await memo.ask("a")]

    assert asyncio.run(ask()) == [*"ABABAB", "A"]
    assert sorted(looks) == ["a", "b"]


def test_an_answer_holds_for_its_time_only() -> None:
    answers = iter(range(1, 10))

    async def ask() -> list[int]:
        memo: Memo[str, int] = Memo(lambda _: next(answers), 0.1)
        first = [await memo.ask("a"), await memo.ask("a")]
        assert memo.knows("a")
        await asyncio.sleep(0.15)
        assert not memo.knows("a")
        return [*first, await memo.ask("a")]

    assert asyncio.run(ask()) == [1, 1, 2]


def test_what_is_falsy_or_fails_is_not_kept() -> None:
    answers = iter([None, 0, ZeroDivisionError(), 3])

    def look(_: str) -> int | None:
        answer = next(answers)
        if isinstance(answer, Exception):
            raise answer
        return answer

    async def ask() -> None:
        memo = Memo(look, 60.0)
        assert await memo.ask("a") is None
        assert not memo.knows("a")
        assert await memo.ask("a") == 0
        with pytest.raises(ZeroDivisionError):
            await memo.ask("a")
        assert await memo.ask("a") == 3

    asyncio.run(ask())


def test_one_who_leaves_ends_no_look_for_which_others_wait() -> None:
    going, looks = threading.Event(), 0

    def look(_: str) -> str:
        nonlocal looks
        looks += 1
        going.wait(5.0)
        return "found"

    async def ask() -> str:
        memo = Memo(look, 60.0)
        impatient = asyncio.create_task(memo.ask("a"))
        patient = asyncio.create_task(memo.ask("a"))
        await asyncio.sleep(0.05)
        impatient.cancel()
        going.set()
        return await patient

    assert asyncio.run(ask()) == "found"
    assert looks == 1


def test_memory_stays_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.coalescing.expiring_cache._MOST_KEPT", 3)

    async def ask() -> int:
        memo: Memo[int, int] = Memo(lambda question: question, 60.0)
        for question in range(1, 20):
            await memo.ask(question)
        return len(memo._kept)

    assert asyncio.run(ask()) <= 3
