"""Jobs and batches watched on behalf of all requests that wait for a change: one query for all of them."""

import asyncio
import contextlib
import logging
from collections.abc import AsyncGenerator, Callable, Hashable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from sqlalchemy.exc import SQLAlchemyError

Subject = TypeVar("Subject", bound=Hashable)
State = TypeVar("State")

_logger = logging.getLogger(__name__)

_SHORTEST_SECONDS = 0.01
_SHARE_OF_WAIT = 0.1  # an end is noticed a tenth of the wait after it came
_SHARE_OF_THREAD = 0.2  # however many wait, queries take no more of their thread's time


@dataclass
class _Watched(Generic[State]):
    """The last state, None if the subject does not exist; `changed` is set, and replaced, at every change."""

    state: State | None = None
    queried: bool = False
    followers: int = 0
    changed: asyncio.Event = field(default_factory=asyncio.Event)


class SharedWatch(Generic[Subject, State]):
    """Queries all watched subjects repeatedly, so that a waiting request holds no thread and no connection.

    The pause between two queries grows with the time since the last request came, because most work that a person waits
    for ends in a fraction of a second.
    """

    def __init__(
        self, name: str, query: Callable[[Mapping[Subject, State | None]], Mapping[Subject, State]], seconds: float
    ) -> None:
        """Take the query, which is called in a thread of this object's own, and the longest pause between two queries.

        The query gets the last state of each subject and returns the states of those that exist.
        """
        self._query = query
        self._seconds = seconds
        self._thread = ThreadPoolExecutor(1, thread_name_prefix=name)
        self._watched: dict[Subject, _Watched[State]] = {}
        self._work: asyncio.Task[None] | None = None
        self._came = asyncio.Event()
        self._released = False

    async def follow(self, subject: Subject, seconds: float) -> AsyncGenerator[State]:
        """Yield the current state, then every change, until the subject disappears or `release` is called.

        It ends after so many seconds in any case.
        """
        clock = asyncio.get_running_loop().time
        until = clock() + seconds
        watched = self._watched.setdefault(subject, _Watched())
        watched.followers += 1
        self._came.set()
        if self._work is None:
            self._work = asyncio.create_task(self._query_repeatedly())
        last: State | None = None
        try:
            while not self._released and not (watched.queried and watched.state is None) and clock() < until:
                changed = watched.changed
                if watched.state is not None and watched.state != last:
                    last = watched.state
                    yield last
                else:
                    with contextlib.suppress(TimeoutError):
                        async with asyncio.timeout_at(until):
                            await changed.wait()
        finally:
            watched.followers -= 1
            if not watched.followers:
                del self._watched[subject]

    def release(self) -> None:
        """End all iterations of `follow`, present and future."""
        self._released = True
        for watched in self._watched.values():
            watched.changed.set()

    async def close(self) -> None:
        """End the thread; `follow` must not be called any more."""
        if self._work is not None:
            self._work.cancel()
        self._thread.shutdown()

    async def _query_repeatedly(self) -> None:
        loop = asyncio.get_running_loop()
        last_came = loop.time()
        try:
            while self._watched:
                begin = loop.time()
                if self._came.is_set():
                    self._came.clear()
                    last_came = begin
                before = {subject: watched.state for subject, watched in self._watched.items()}
                try:
                    self._update(before, await loop.run_in_executor(self._thread, self._query, before))
                except SQLAlchemyError as error:
                    _logger.warning("the database failed and is queried again: %s", error)
                await self._pause(loop.time() - begin, loop.time() - last_came)
        finally:
            self._work = None

    async def _pause(self, taken: float, waited: float) -> None:
        """Pause after a query that took so many seconds; a request that comes cuts the pause to its least."""
        least = min(self._seconds, max(_SHORTEST_SECONDS, taken / _SHARE_OF_THREAD))
        await asyncio.sleep(least)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(min(self._seconds, _SHARE_OF_WAIT * waited) - least):
                await self._came.wait()

    def _update(self, before: Mapping[Subject, State | None], found: Mapping[Subject, State]) -> None:
        for subject in before:
            watched = self._watched.get(subject)
            if watched is None or (watched.queried and watched.state == found.get(subject)):
                continue
            watched.state, watched.queried = found.get(subject), True
            watched.changed.set()
            watched.changed = asyncio.Event()
