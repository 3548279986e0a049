import asyncio
import socket
import time
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from typing import TypeVar

import pytest

from app.runtime.settings import Settings
from app.security.quotas import Meter, Quota, Standing
from tests.servers import free_port

T = TypeVar("T")
NOON = 1_800_000_000.0  # the beginning of a minute


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """Give a clock that stands, as a list of one."""
    now = [NOON]
    monkeypatch.setattr("app.security.quotas.time.time", lambda: now[0])
    yield now


def with_meters(settings: Settings, count: int, use: Callable[[list[Meter]], Awaitable[T]]) -> T:
    async def run() -> T:
        meters = [Meter(settings) for _ in range(count)]
        try:
            return await use(meters)
        finally:
            for meter in meters:
                await meter.close()

    return asyncio.run(run())


def embedded(tmp_path: Path) -> Settings:
    return Settings(data_dir=tmp_path)


@pytest.mark.parametrize("most", [1, 7, 250])
def test_a_quota_lasts_as_long_as_it_says_and_is_whole_in_the_next_minute(
    tmp_path: Path, clock: list[float], most: int
) -> None:
    quota = Quota("reads", most)

    async def use(meters: list[Meter]) -> tuple[list[Standing], Standing]:
        first = [await meters[0].take(quota, "acme") for _ in range(most + 2)]
        clock[0] += 60.0
        return first, await meters[0].take(quota, "acme")

    first, next_minute = with_meters(embedded(tmp_path), 1, use)
    assert [standing.left for standing in first] == [*range(most - 1, -1, -1), None, None]
    assert next_minute.left == most - 1


def test_owners_and_kinds_have_quotas_of_their_own(tmp_path: Path, clock: list[float]) -> None:
    async def use(meters: list[Meter]) -> list[int | None]:
        asked = [(Quota("reads", 1), "acme"), (Quota("changes", 1), "acme"), (Quota("reads", 1), "other")]
        return [(await meters[0].take(*one)).left for one in asked]

    assert with_meters(embedded(tmp_path), 1, use) == [0, 0, 0]


def test_the_fields_are_those_of_the_draft(tmp_path: Path, clock: list[float]) -> None:
    clock[0] += 17.5

    async def use(meters: list[Meter]) -> Standing:
        return await meters[0].take(Quota("reads", 250), "acme")

    assert with_meters(embedded(tmp_path), 1, use).fields == {
        "RateLimit-Policy": '"reads";q=250;w=60',
        "RateLimit": '"reads";r=249;t=43',
    }
    assert Standing(Quota("reads", 250), None, 3).fields["RateLimit"] == '"reads";r=0;t=3'


def test_processes_share_a_quota_and_count_exactly(tmp_path: Path, redis_address: str, clock: list[float]) -> None:
    async def use(meters: list[Meter]) -> list[int | None]:
        return [(await meters[n % 3].take(Quota("changes", 100), "acme")).left for n in range(130)]

    left = with_meters(Settings(data_dir=tmp_path, broker_url=redis_address), 3, use)
    assert left == [*range(99, -1, -1), *[None] * 30]


def test_many_at_once_get_no_more_than_the_quota(tmp_path: Path, redis_address: str, clock: list[float]) -> None:
    async def use(meters: list[Meter]) -> list[Standing]:
        return await asyncio.gather(*(meters[n % 2].take(Quota("reads", 40), "acme") for n in range(100)))

    patient = Settings(data_dir=tmp_path, broker_url=redis_address, broker_timeout_seconds=30.0)
    standings = with_meters(patient, 2, use)
    assert sum(1 for standing in standings if standing.left is not None) == 40


def test_without_redis_each_process_counts_by_itself(tmp_path: Path, clock: list[float]) -> None:
    away = Settings(data_dir=tmp_path, broker_url=f"redis://127.0.0.1:{free_port()}", broker_timeout_seconds=0.3)

    async def use(meters: list[Meter]) -> list[int | None]:
        return [(await meters[0].take(Quota("reads", 2), "acme")).left for _ in range(3)]

    assert with_meters(away, 1, use) == [1, 0, None]


def test_a_redis_that_is_silent_is_waited_for_once_in_a_while(tmp_path: Path, clock: list[float]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        port = silent.getsockname()[1]
        settings = Settings(data_dir=tmp_path, broker_url=f"redis://127.0.0.1:{port}", broker_timeout_seconds=0.2)

        async def use(meters: list[Meter]) -> tuple[list[int | None], float]:
            begin = time.monotonic()
            left = [(await meters[0].take(Quota("reads", 20), f"owner {n}")).left for n in range(20)]
            return left, time.monotonic() - begin

        left, seconds = with_meters(settings, 1, use)
    assert left == [19] * 20
    assert seconds < 20 * 0.2  # not for every owner anew
