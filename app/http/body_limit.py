"""Limit the size of request bodies and the time that they take, and let the client read why its body was refused."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass

from fastapi import Request, Response
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.prefix import path_of

# Closing a connection while the client still sends resets it, and the client loses the answer. So read and discard
# the rest of the body for a while after answering.
_LINGER_SECONDS = 2.0

Refuse = Callable[[Request, Exception], Awaitable[Response]]


@dataclass(frozen=True, slots=True)
class Limit:
    """The largest size of a body in bytes, and the error raised for a larger one."""

    most_bytes: int
    too_large: HTTPException


@dataclass(frozen=True, slots=True)
class Pace:
    """How slowly a body may arrive: the longest silence in seconds, bytes a second, and the error for a slower one.

    The service waits for a body as long as the silence allows; each byte gives back its share of a second, up to that.
    Only waiting counts, so a body that the service itself reads slowly is not slow.
    """

    silent_seconds: float
    bytes_a_second: float
    too_slow: HTTPException


class BodyLimit:
    """ASGI middleware that refuses bodies above a limit or below a pace.

    If the announced length exceeds the limit, the application does not see the request.
    """

    def __init__(self, app: ASGIApp, limits: Mapping[str, Limit], pace: Pace, refuse: Refuse) -> None:
        """Wrap an application; `limits` maps paths to limits, and the limit under "" applies to all other paths.

        If the body exceeds its limit or is too slow while the application reads it, raise the error of that there. If
        the announced length exceeds the limit, answer with `refuse`.
        """
        self.app = app
        self.limits = limits
        self.pace = pace
        self.refuse = refuse

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = dict(scope["headers"])
        announced = headers.get(b"content-length", b"0")
        limit = self.limits.get(path_of(scope), self.limits[""])
        empty = announced.strip(b"0") == b"" and b"transfer-encoding" not in headers
        exchange = _Exchange(receive, send, limit, self.pace, self.pace.silent_seconds, ended=empty)
        if announced.isdigit() and int(announced[:20]) > limit.most_bytes:
            answer = await self.refuse(Request(scope), limit.too_large)
            await answer(scope, receive, exchange.send_lingering)
        else:
            await self.app(scope, exchange.receive_counting, exchange.send_lingering)


@dataclass
class _Exchange:
    receive: Receive
    send: Send
    limit: Limit
    pace: Pace
    patience: float
    ended: bool
    taken: int = 0

    async def receive_counting(self) -> Message:
        message = await self._next() if self.ended else await self._next_in_time()
        self.taken += len(message.get("body", b""))
        if self.taken > self.limit.most_bytes:
            raise self.limit.too_large
        return message

    async def _next_in_time(self) -> Message:
        clock = asyncio.get_running_loop().time
        began = clock()
        try:
            async with asyncio.timeout(self.patience):
                message = await self._next()
        except TimeoutError:
            raise self.pace.too_slow from None
        gained = len(message.get("body", b"")) / self.pace.bytes_a_second
        self.patience = min(self.pace.silent_seconds, self.patience - (clock() - began) + gained)
        return message

    async def send_lingering(self, message: Message) -> None:
        last = message["type"] == "http.response.body" and not message.get("more_body", False)
        if self.ended or not last:
            await self.send(message)
            return
        await self.send({**message, "more_body": True})
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(_LINGER_SECONDS):
                await self._discard()
        await self.send({"type": "http.response.body", "body": b""})

    async def _discard(self) -> None:
        while not self.ended:
            await self._next()

    async def _next(self) -> Message:
        message = await self.receive()
        self.ended = not message.get("more_body", False)
        return message
