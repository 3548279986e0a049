import asyncio
import threading
import time

import pytest

from app.coalescing.expiring_cache import ExpiringCache


def test_requests_at_once_wait_for_one_load() -> None:
    loads: list[str] = []

    def load(key: str) -> str:
        time.sleep(0.05)
        loads.append(key)
        return key.upper()

    async def get() -> list[str]:
        cache = ExpiringCache(load, 60.0)
        found = await asyncio.gather(*(cache.get(key) for key in "ababab"))
        return [*found, await cache.get("a")]

    assert asyncio.run(get()) == [*"ABABAB", "A"]
    assert sorted(loads) == ["a", "b"]


def test_a_value_expires() -> None:
    values = iter(range(1, 10))

    async def get() -> list[int]:
        cache: ExpiringCache[str, int] = ExpiringCache(lambda _: next(values), 0.1)
        first = [await cache.get("a"), await cache.get("a")]
        assert cache.holds("a")
        await asyncio.sleep(0.15)
        assert not cache.holds("a")
        return [*first, await cache.get("a")]

    assert asyncio.run(get()) == [1, 1, 2]


def test_falsy_values_and_exceptions_are_not_kept() -> None:
    values = iter([None, 0, ZeroDivisionError(), 3])

    def load(_: str) -> int | None:
        value = next(values)
        if isinstance(value, Exception):
            raise value
        return value

    async def get() -> None:
        cache = ExpiringCache(load, 60.0)
        assert await cache.get("a") is None
        assert not cache.holds("a")
        assert await cache.get("a") == 0
        with pytest.raises(ZeroDivisionError):
            await cache.get("a")
        assert await cache.get("a") == 3

    asyncio.run(get())


def test_a_cancelled_request_does_not_cancel_a_load_that_others_await() -> None:
    going, loads = threading.Event(), 0

    def load(_: str) -> str:
        nonlocal loads
        loads += 1
        going.wait(5.0)
        return "found"

    async def get() -> str:
        cache = ExpiringCache(load, 60.0)
        impatient = asyncio.create_task(cache.get("a"))
        patient = asyncio.create_task(cache.get("a"))
        await asyncio.sleep(0.05)
        impatient.cancel()
        going.set()
        return await patient

    assert asyncio.run(get()) == "found"
    assert loads == 1


def test_cachery_stays_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.coalescing.expiring_cache._MOST_KEPT", 3)

    async def get() -> int:
        cache: ExpiringCache[int, int] = ExpiringCache(lambda key: key, 60.0)
        for key in range(1, 20):
            await cache.get(key)
        return len(cache._entries)

    assert asyncio.run(get()) <= 3
