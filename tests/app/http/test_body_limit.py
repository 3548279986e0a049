import asyncio
from dataclasses import dataclass
from typing import Any

import pytest
from fastapi import Request, Response
from starlette.exceptions import HTTPException
from starlette.types import Message, Receive, Scope, Send

from app.http.body_limit import BodyLimit, Limit, Pace

PIECE = 100
PIECES = 50
PACE = Pace(silent_seconds=15.0, bytes_a_second=4000, too_slow=HTTPException(408))


class Exchange:
    """A request of many pieces, and what had been read of it when the answer began."""

    def __init__(self) -> None:
        self.pieces_read = 0
        self.read_before_answer: int | None = None
        self.answer: list[Message] = []

    async def receive(self) -> Message:
        self.pieces_read += 1
        return {"type": "http.request", "body": b"x" * PIECE, "more_body": self.pieces_read < PIECES}

    async def send(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self.read_before_answer = self.pieces_read
        self.answer.append(message)


async def reader(scope: Scope, receive: Receive, send: Send) -> None:
    """Read a whole body and answer with its length, or with the status of what stops it."""
    try:
        body = await Request(scope, receive).body()
    except HTTPException as error:
        await Response(status_code=error.status_code)(scope, receive, send)
        return
    await Response(str(len(body)))(scope, receive, send)


async def refuse(_: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return Response("refused", error.status_code)


def served(limit: int, headers: list[tuple[bytes, bytes]]) -> Exchange:
    exchange = Exchange()
    scope: Scope = {"type": "http", "method": "POST", "path": "/", "headers": headers, "query_string": b""}
    limited = BodyLimit(reader, {"": Limit(limit, HTTPException(413))}, PACE, refuse)
    asyncio.run(limited(scope, exchange.receive, exchange.send))
    return exchange


def test_a_body_within_the_limit_passes() -> None:
    exchange = served(PIECE * PIECES, [])
    assert exchange.answer[0]["status"] == 200
    assert exchange.answer[1]["body"] == b"5000"


@pytest.mark.parametrize("limit", [PIECE * PIECES - 1, 950])
def test_the_answer_begins_as_soon_as_the_limit_is_passed(limit: int) -> None:
    exchange = served(limit, [])
    assert exchange.answer[0]["status"] == 413
    assert exchange.read_before_answer == limit // PIECE + 1
    assert exchange.pieces_read == PIECES  # the rest is thrown away, so that the client can read the answer
    assert exchange.answer[-1].get("more_body", False) is False


@pytest.mark.parametrize("announced", [b"1001", b"9" * 4000])
def test_what_is_announced_too_large_is_refused_unread(announced: bytes) -> None:
    exchange = served(1000, [(b"content-length", announced)])
    assert exchange.answer[0]["status"] == 413
    assert exchange.read_before_answer == 0


def test_a_client_that_leaves_ends_the_lingering() -> None:
    class Leaving(Exchange):
        async def receive(self) -> Message:
            self.pieces_read += 1
            return {"type": "http.disconnect"}

    exchange = Leaving()
    scope: Scope = {"type": "http", "method": "POST", "path": "/", "headers": [(b"content-length", b"9")]}
    limited = BodyLimit(reader, {"": Limit(1, HTTPException(413))}, PACE, refuse)
    asyncio.run(limited(scope, exchange.receive, exchange.send))
    assert exchange.pieces_read == 1
    assert exchange.answer[0]["status"] == 413


class Skipping(asyncio.SelectorEventLoop):
    """An event loop whose clock jumps to whatever comes next, so that a test waits for nothing."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 0.0
        selector: Any = self._selector  # type: ignore[attr-defined]
        look = selector.select

        def skip(timeout: float | None) -> Any:
            self.now += timeout or 0.0
            return look(0.0)

        selector.select = skip

    def time(self) -> float:
        return self.now


@dataclass
class Drip(Exchange):
    """A body in pieces of a size, each of which comes some seconds after the last was taken."""

    size: int
    every: float
    pieces: int

    def __post_init__(self) -> None:
        super().__init__()

    async def receive(self) -> Message:
        await asyncio.sleep(self.every)
        self.pieces_read += 1
        return {"type": "http.request", "body": b"x" * self.size, "more_body": self.pieces_read < self.pieces}


def dripped(drip: Drip, work_seconds: float = 0.0) -> tuple[int, float]:
    """Return the status that a body gets, and after how many seconds."""
    begun: list[float] = []

    async def worker(scope: Scope, receive: Receive, send: Send) -> None:
        async def slowly() -> Message:
            await asyncio.sleep(work_seconds)
            return await receive()

        async def noting(message: Message) -> None:
            begun.append(asyncio.get_running_loop().time())
            await send(message)

        await reader(scope, slowly, noting)

    scope: Scope = {"type": "http", "method": "POST", "path": "/", "headers": [(b"transfer-encoding", b"chunked")]}
    limited = BodyLimit(worker, {"": Limit(1 << 40, HTTPException(413))}, PACE, refuse)
    with asyncio.Runner(loop_factory=Skipping) as runner:
        runner.run(limited(scope, drip.receive, drip.send))
    return drip.answer[0]["status"], begun[0]


def test_a_silent_body_is_given_up() -> None:
    assert dripped(Drip(size=1, every=1e9, pieces=2)) == (408, 15.0)


def test_a_byte_now_and_then_does_not_keep_a_body_alive() -> None:
    status, seconds = dripped(Drip(size=1, every=1.0, pieces=1000))
    assert status == 408
    assert seconds == pytest.approx(15.0, abs=0.1)
    assert dripped(Drip(size=1, every=20.0, pieces=10)) == (408, 15.0)


def test_what_came_quickly_does_not_pay_for_a_long_silence() -> None:
    class Stopping(Drip):
        async def receive(self) -> Message:
            self.every = 0.001 if self.pieces_read < 100 else 1e9
            return await super().receive()

    status, seconds = dripped(Stopping(size=65_536, every=0.0, pieces=200))
    assert status == 408
    assert seconds == pytest.approx(15.1, abs=0.1)


@pytest.mark.parametrize(
    ("size", "every"), [(65_536, 1.0), (1_400, 0.3), (40_000, 9.9)], ids=["64 kB/s", "4.7 kB/s", "bursts"]
)
def test_a_slow_but_steady_uplink_passes(size: int, every: float) -> None:
    status, seconds = dripped(Drip(size=size, every=every, pieces=2000))
    assert status == 200
    assert seconds == pytest.approx(2000 * every)


def test_the_time_that_the_service_takes_is_not_the_senders() -> None:
    assert dripped(Drip(size=10, every=0.001, pieces=20), work_seconds=60.0)[0] == 200
