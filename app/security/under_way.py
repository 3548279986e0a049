"""End a request under way when its caller is no longer admitted: a stream, a long wait, or an upload."""

import asyncio
from collections.abc import Awaitable, Callable

import anyio
import anyio.lowlevel
from sqlalchemy.exc import SQLAlchemyError
from starlette.types import Message, Receive

from app.http.problems import ProblemError, ProblemKind
from app.runtime.signing import SecretUnavailable

Serve = Callable[[Receive], Awaitable[None]]
Check = Callable[[], Awaitable[object]]


class _Ended(Exception):
    """Raised to whoever asks for more of the body of a request that is being ended; nobody answers it."""


async def while_admitted(serve: Serve, receive: Receive, check: Check, seconds: float) -> ProblemError | None:
    """Serve a request, and look every so many seconds whether its caller is still admitted.

    check: raises `ProblemError` for a caller who is not. If it cannot tell, since the database or the issuer of tokens
    does not answer, the request goes on.

    Return the problem for which the request was ended, None if it was served.
    """
    refusals: list[ProblemError] = []
    looking: list[asyncio.Task[None]] = []

    async def look() -> None:
        while not refusals:
            try:
                await check()
            except ProblemError as problem:
                if problem.kind is ProblemKind.UNAUTHENTICATED:
                    refusals.append(problem)
                    serving.cancel()
            except (SQLAlchemyError, SecretUnavailable):
                pass
            await asyncio.sleep(seconds)

    async def receive_admitted() -> Message:
        if refusals:  # a thread may ask from where cancelling does not reach
            raise _Ended
        return await receive()

    # Most requests end before the first look, and a timer costs them less than a task would.
    timer = asyncio.get_running_loop().call_later(seconds, lambda: looking.append(asyncio.create_task(look())))
    try:
        with anyio.CancelScope() as serving:
            await _served(serve(receive_admitted), serving)
    finally:
        timer.cancel()
        for task in looking:
            task.cancel()
    return refusals[0] if refusals and serving.cancelled_caught else None


async def _served(serving: Awaitable[None], scope: anyio.CancelScope) -> None:
    try:
        await serving
    except Exception:
        # A thread that waits for more of a body ends with an exception of its own.
        if not scope.cancel_called:
            raise
        await anyio.lowlevel.checkpoint()
