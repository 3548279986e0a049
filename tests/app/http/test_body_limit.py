import asyncio

import pytest
from fastapi import Request, Response
from starlette.exceptions import HTTPException
from starlette.types import Message, Receive, Scope, Send

from app.http.body_limit import BodyLimit, Limit

PIECE = 100
PIECES = 50


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
    limited = BodyLimit(reader, {"": Limit(limit, HTTPException(413))}, refuse)
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
    asyncio.run(BodyLimit(reader, {"": Limit(1, HTTPException(413))}, refuse)(scope, exchange.receive, exchange.send))
    assert exchange.pieces_read == 1
    assert exchange.answer[0]["status"] == 413
