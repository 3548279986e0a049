"""Jobs and batches watched for all who wait for a change, with one look at the database for everybody."""

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
    """What was seen last, None if there is nothing; `changed` is set, and replaced, at every change."""

    state: State | None = None
    seen: bool = False
    followers: int = 0
    changed: asyncio.Event = field(default_factory=asyncio.Event)


class Watch(Generic[Subject, State]):
    """Looks at all watched subjects every so often, so that who waits holds neither a thread nor a connection."""

    def __init__(
        self, name: str, look: Callable[[Mapping[Subject, State | None]], Mapping[Subject, State]], seconds: float
    ) -> None:
        """Take the function that looks, called in a thread of this object's own, and the seconds between two looks.

        It is given what was seen of each subject before, and returns the states of those that there are.
        """
        self._look = look
        self._seconds = seconds
        self._thread = ThreadPoolExecutor(1, thread_name_prefix=name)
        self._watched: dict[Subject, _Watched[State]] = {}
        self._work: asyncio.Task[None] | None = None
        self._released = False

    async def follow(self, subject: Subject) -> AsyncGenerator[State]:
        """Yield the state of a subject and then every other one that is seen, until it is gone or all are released."""
        watched = self._watched.setdefault(subject, _Watched())
        watched.followers += 1
        if self._work is None:
            self._work = asyncio.create_task(self._look_on())
        last: State | None = None
        try:
            while not self._released and not (watched.seen and watched.state is None):
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
        """Let all go who follow, and those who come later."""
        self._released = True
        for watched in self._watched.values():
            watched.changed.set()

    async def close(self) -> None:
        """End the thread; nobody may follow any more."""
        if self._work is not None:
            self._work.cancel()
        self._thread.shutdown()

    async def _look_on(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            while self._watched:
                before = {subject: watched.state for subject, watched in self._watched.items()}
                try:
                    self._note(before, await loop.run_in_executor(self._thread, self._look, before))
                except SQLAlchemyError as error:
                    _logger.warning("the database failed, to be looked at again: %s", error)
                await asyncio.sleep(self._seconds)
        finally:
            self._work = None

    def _note(self, before: Mapping[Subject, State | None], found: Mapping[Subject, State]) -> None:
        for subject in before:
            watched = self._watched.get(subject)
            if watched is None or (watched.seen and watched.state == found.get(subject)):
                continue
            watched.state, watched.seen = found.get(subject), True
            watched.changed.set()
            watched.changed = asyncio.Event()
