"""The listening socket that processes share; here two listeners in one process stand for them."""

import asyncio
import errno
import socket
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import pytest

from app.http.listening import Listener, SharingLoop

CLIENTS = 48


class Counting(asyncio.Protocol):
    """Counts its connection and keeps it."""

    def __init__(self, taken: list[asyncio.BaseTransport]) -> None:
        self.taken = taken

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.taken.append(transport)


def run(work: Callable[[asyncio.AbstractEventLoop], Any]) -> Any:
    with asyncio.Runner(loop_factory=SharingLoop) as runner:
        return runner.run(work(runner.get_loop()))


async def until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(30.0):
        while not condition():
            await asyncio.sleep(0.01)


def test_a_burst_of_connections_is_spread_evenly() -> None:
    async def shares(loop: asyncio.AbstractEventLoop) -> list[int]:
        taken: list[list[asyncio.BaseTransport]] = [[], []]
        with socket.create_server(("127.0.0.1", 0)) as listening, listening.dup() as again:
            sockets = zip((listening, again), taken, strict=True)
            listeners = [
                await loop.create_server(lambda mine=mine: Counting(mine), sock=own, backlog=100)  # type: ignore[misc]
                for own, mine in sockets
            ]
            clients = [socket.create_connection(listening.getsockname()) for _ in range(CLIENTS)]
            await until(lambda: sum(map(len, taken)) == CLIENTS)
            for listener in listeners:
                listener.close()
                await listener.wait_closed()
        ends: list[Any] = [*clients, *taken[0], *taken[1]]
        for end in ends:
            end.close()
        return [len(mine) for mine in taken]

    assert min(run(shares)) >= CLIENTS // 3


def test_nothing_is_taken_after_the_end() -> None:
    async def late(loop: asyncio.AbstractEventLoop) -> int:
        taken: list[asyncio.BaseTransport] = []
        with socket.create_server(("127.0.0.1", 0)) as listening:
            listener = await loop.create_server(lambda: Counting(taken), sock=listening, backlog=100)
            first = socket.create_connection(listening.getsockname())
            await until(lambda: len(taken) == 1)  # it pauses now
            listener.close()
            await listener.wait_closed()
            second = socket.create_connection(listening.getsockname())
            await asyncio.sleep(0.1)
        ends: list[Any] = [first, second, *taken]
        for end in ends:
            end.close()
        return len(taken)

    assert run(late) == 1


def test_a_socket_of_its_own_is_served_as_ever() -> None:
    async def own(loop: asyncio.AbstractEventLoop) -> int:
        taken: list[asyncio.BaseTransport] = []
        async with await loop.create_server(lambda: Counting(taken), "127.0.0.1", 0) as server:
            client = socket.create_connection(server.sockets[0].getsockname())
            await until(lambda: len(taken) == 1)
        ends: list[Any] = [client, *taken]
        for end in ends:
            end.close()
        return len(taken)

    assert run(own) == 1


@pytest.mark.parametrize(
    ("error", "pause"), [(BlockingIOError(), None), (OSError(errno.EMFILE, "too many open files"), 1.0)]
)
def test_what_cannot_be_taken_ends_nothing(error: OSError, pause: float | None) -> None:
    loop, listening = Mock(), Mock(**{"accept.side_effect": error})
    Listener(loop, listening, asyncio.Protocol)
    _, take = loop.add_reader.call_args.args
    take()
    if pause is None:
        loop.remove_reader.assert_not_called()
    else:
        assert loop.call_later.call_args.args[0] == pause
        loop.remove_reader.assert_called_once_with(listening)
