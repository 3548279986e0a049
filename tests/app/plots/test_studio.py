import asyncio
import os
from unittest import mock

import pytest

from app.plots import Facts, Options, draw, studio
from app.plots.studio import Studio
from tests.app.plots.drawn_motions import Tables

RISK: Tables = {"risk": []}


def test_a_picture_of_another_process_is_the_same() -> None:
    async def both() -> tuple[bytes, bytes]:
        here = Studio(1)
        try:
            first = await here.draw("north", "risk", RISK, Facts("x"), Options())
            assert here._pool is not None
            for process in list(here._pool._processes.values()):  # as if the kernel had ended it for want of memory
                os.kill(process.pid or 0, 9)
                process.join()
            return first, await here.draw("north", "risk", RISK, Facts("x"), Options())
        finally:
            here.close()

    assert asyncio.run(both()) == (draw("risk", RISK, Facts("x"), Options()),) * 2


def test_an_owner_with_many_pictures_delays_another_by_few(monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []

    async def note(_: Studio, name: str, *_rest: object) -> bytes:
        await asyncio.sleep(0)
        order.append(name)
        return b""

    monkeypatch.setattr(studio.Studio, "_drawn", note)

    async def all_at_once() -> None:
        here = Studio(2)
        greedy = [here.draw("greedy", "greedy", {}, Facts(""), Options()) for _ in range(20)]
        await asyncio.gather(*greedy, here.draw("modest", "modest", {}, Facts(""), Options()))
        assert here._owners == {}

    asyncio.run(all_at_once())
    assert order.index("modest") <= 4


def test_without_a_picture_there_is_no_process() -> None:
    with mock.patch.object(studio, "ProcessPoolExecutor") as pool:
        Studio(1).close()
    assert not pool.called
