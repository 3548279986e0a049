"""Answer simultaneous calls in groups: one thread, one connection and one commit for a whole group."""

import asyncio
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Generic, TypeVar

from sqlalchemy.orm import Session, sessionmaker

Argument = TypeVar("Argument")
Result = TypeVar("Result")

_MOST_AT_ONCE = 100


class GroupedCalls(Generic[Argument, Result]):
    """Gathers calls while a group is at work, then works on all that have gathered as the next group.

    A single call does not wait for others. Under load the calls share the cost of a transaction, and only one thread
    competes with the event loop for the interpreter; a thread for every request would slow all of them down.
    """

    def __init__(
        self,
        name: str,
        work: Callable[[Sequence[Argument]], Sequence[Result | Exception]],
        pause_seconds: float = 0.0,
    ) -> None:
        """Take the function that works on a group, which is called in a thread of this object's own.

        It returns for every argument its result, or the exception that is raised in the call of that argument. After a
        group of several the next one gathers for the pause, unless it is full: under load, fewer and larger groups save
        more than the pause delays.
        """
        self._work = work
        self._thread = ThreadPoolExecutor(1, thread_name_prefix=name)
        self._waiting: list[tuple[Argument, asyncio.Future[Result]]] = []
        self._worker: asyncio.Task[None] | None = None
        self._pause_seconds = pause_seconds
        self._closing = asyncio.Event()

    async def call(self, argument: Argument) -> Result:
        """Return the result for an argument.

        Raises
        ------
        Exception
            What the function returned for this argument, or raised for its whole group.
        """
        return await self.submit(argument)

    def submit(self, argument: Argument) -> "asyncio.Future[Result]":
        """Add an argument to the next group without waiting for its result."""
        future: asyncio.Future[Result] = asyncio.get_running_loop().create_future()
        self._waiting.append((argument, future))
        if self._worker is None:
            self._worker = asyncio.create_task(self._work_on_all())
        return future

    async def close(self) -> None:
        """Work on what is still waiting, then end the thread."""
        self._closing.set()
        if self._worker is not None:
            await self._worker
        self._thread.shutdown()

    async def _work_on_all(self) -> None:
        try:
            while self._waiting:
                group = self._waiting[:_MOST_AT_ONCE]
                del self._waiting[:_MOST_AT_ONCE]
                results = await self._results([argument for argument, _ in group])
                for (_, future), result in zip(group, results, strict=True):
                    _settle(future, result)
                await self._pause(len(group))
        finally:
            self._worker = None

    async def _pause(self, calls: int) -> None:
        if self._pause_seconds and calls > 1 and len(self._waiting) < _MOST_AT_ONCE:
            with suppress(TimeoutError):
                await asyncio.wait_for(self._closing.wait(), self._pause_seconds)

    async def _results(self, arguments: Sequence[Argument]) -> Sequence[Result | Exception]:
        try:
            return await asyncio.get_running_loop().run_in_executor(self._thread, self._work, arguments)
        except Exception as error:
            return [error] * len(arguments)


def committed_together(
    sessions: sessionmaker[Session],
    work: Callable[[Session, Sequence[Argument]], Sequence[Result | Exception]],
    arguments: Sequence[Argument],
) -> Sequence[Result | Exception]:
    """Work on a group in one transaction; if that fails, on each argument again in a transaction of its own.

    So an argument that fails does not affect the others. The work may be done twice, so it must change nothing but the
    database.
    """
    if len(arguments) > 1:
        try:
            with sessions.begin() as session:
                return work(session, arguments)
        except Exception:  # which argument caused it is found below
            pass
    return [_alone(sessions, work, argument) for argument in arguments]


def _alone(
    sessions: sessionmaker[Session],
    work: Callable[[Session, Sequence[Argument]], Sequence[Result | Exception]],
    argument: Argument,
) -> Result | Exception:
    try:
        with sessions.begin() as session:
            (result,) = work(session, [argument])
    except Exception as error:
        return error
    return result


def _settle(future: "asyncio.Future[Result]", result: Result | Exception) -> None:
    if future.done():  # the request was cancelled
        return
    if isinstance(result, Exception):
        future.set_exception(result)
    else:
        future.set_result(result)
