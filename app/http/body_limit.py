"""A limit on request bodies that holds while they come in, and lets clients read why theirs was refused unread."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass

from fastapi import Request, Response
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

# A connection that is closed on a client who still sends is reset, and the answer with it. So what comes after the
# answer is read for a while and thrown away.
_LINGER_SECONDS = 2.0

Refuse = Callable[[Request, Exception], Awaitable[Response]]


@dataclass(frozen=True, slots=True)
class Limit:
    """How large a body may be, and the fault of one that is larger."""

    most_bytes: int
    too_large: HTTPException


class BodyLimit:
    """ASGI middleware: no application sees more of a body than the limit; one announced as larger it does not see."""

    def __init__(self, app: ASGIApp, limits: Mapping[str, Limit], refuse: Refuse) -> None:
        """Wrap an application; `limits` are by path, and the one under "" holds for all others.

        A limit's fault is raised in the application as it reads on, or made an answer by `refuse` before.
        """
        self.app = app
        self.limits = limits
        self.refuse = refuse

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = dict(scope["headers"])
        announced = headers.get(b"content-length", b"0")
        limit = self.limits.get(scope["path"], self.limits[""])
        empty = announced.strip(b"0") == b"" and b"transfer-encoding" not in headers
        exchange = _Exchange(receive, send, limit.most_bytes, limit.too_large, ended=empty)
        if announced.isdigit() and int(announced[:20]) > limit.most_bytes:
            answer = await self.refuse(Request(scope), limit.too_large)
            await answer(scope, receive, exchange.send_lingering)
        else:
            await self.app(scope, exchange.receive_counting, exchange.send_lingering)


@dataclass
class _Exchange:
    receive: Receive
    send: Send
    most_bytes: int
    too_large: HTTPException
    ended: bool
    taken: int = 0

    async def receive_counting(self) -> Message:
        message = await self._next()
        self.taken += len(message.get("body", b""))
        if self.taken > self.most_bytes:
            raise self.too_large
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
