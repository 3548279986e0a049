"""Jobs and batches watched on behalf of all requests that wait for a change: one query for all of them."""

import asyncio
import logging
from collections.abc import AsyncGenerator, Callable, Hashable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from sqlalchemy.exc import SQLAlchemyError

Subject = TypeVar("Subject", bound=Hashable)
State = TypeVar("State")

_logger = logging.getLogger(__name__)


@dataclass
class _Watched(Generic[State]):
    """The last state, None if the subject does not exist; `changed` is set, and replaced, at every change."""

    state: State | None = None
    queried: bool = False
    followers: int = 0
    changed: asyncio.Event = field(default_factory=asyncio.Event)


class SharedWatch(Generic[Subject, State]):
    """Queries all watched subjects at an interval, so that a waiting request holds no thread and no connection."""

    def __init__(
        self, name: str, query: Callable[[Mapping[Subject, State | None]], Mapping[Subject, State]], seconds: float
    ) -> None:
        """Take the query, which is called in a thread of this object's own, and the seconds between two queries.

        The query gets the last state of each subject and returns the states of those that exist.
        """
        self._query = query
        self._seconds = seconds
        self._thread = ThreadPoolExecutor(1, thread_name_prefix=name)
        self._watched: dict[Subject, _Watched[State]] = {}
        self._work: asyncio.Task[None] | None = None
        self._released = False

    async def follow(self, subject: Subject) -> AsyncGenerator[State]:
        """Yield the current state, then every change, until the subject disappears or `release` is called."""
        watched = self._watched.setdefault(subject, _Watched())
        watched.followers += 1
        if self._work is None:
            self._work = asyncio.create_task(self._query_repeatedly())
        last: State | None = None
        try:
            while not self._released and not (watched.queried and watched.state is None):
                changed = watched.changed
                if watched.state is not None and watched.state != last:
                    last = watched.state
                    yield last
                else:
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
        try:
            while self._watched:
                before = {subject: watched.state for subject, watched in self._watched.items()}
                try:
                    self._update(before, await loop.run_in_executor(self._thread, self._query, before))
                except SQLAlchemyError as error:
                    _logger.warning("the database failed and is queried again: %s", error)
                await asyncio.sleep(self._seconds)
        finally:
            self._work = None

    def _update(self, before: Mapping[Subject, State | None], found: Mapping[Subject, State]) -> None:
        for subject in before:
            watched = self._watched.get(subject)
            if watched is None or (watched.queried and watched.state == found.get(subject)):
                continue
            watched.state, watched.queried = found.get(subject), True
            watched.changed.set()
            watched.changed = asyncio.Event()
