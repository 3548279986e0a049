"""Work on large documents in threads beside the event loop, a few at a time: each takes the loop's share of time."""

from collections.abc import Callable
from typing import TypeVar

from anyio import CapacityLimiter, to_thread
from fastapi import FastAPI, Request

Answer = TypeVar("Answer")

QUICK_BYTES = 32_768
"""A body of this size is read and checked sooner than a thread is switched to; a line has some 1,000 bytes."""

_AT_ONCE = 4  # a thread that computes has the interpreter for 5 ms at a time, so four delay the loop by 20 ms


def install(app: FastAPI) -> None:
    """Give an application its threads for large documents."""
    app.state.beside_loop = CapacityLimiter(_AT_ONCE)


async def beside_loop(request: Request, call: Callable[[], Answer]) -> Answer:
    """Return what a function returns, called in one of a few threads."""
    limiter: CapacityLimiter = request.app.state.beside_loop
    return await to_thread.run_sync(call, limiter=limiter)


async def beside_loop_if_large(request: Request, call: Callable[[], Answer]) -> Answer:
    """Return what a function returns, called beside the loop if the request is large, else at once."""
    return await beside_loop(request, call) if is_large(request) else call()


def mark_large(request: Request) -> None:
    """Note that the document of a request is large, whatever the size of its body."""
    request.state.is_large = True


def is_large(request: Request) -> bool:
    """Tell whether the document of a request was noted to be large."""
    return getattr(request.state, "is_large", False)
