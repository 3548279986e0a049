"""Places for batches that come in: many may be under way, a few are read at once, those whose bytes are there."""

from collections import Counter
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from threading import Semaphore
from typing import Any, TypeVar, TypeVarTuple

from anyio import CapacityLimiter, from_thread, to_thread

from app.interactive.busy import Busy

Arguments = TypeVarTuple("Arguments")
Answer = TypeVar("Answer")

_OWNERS = 2  # so many together fill the places, one alone does not


class Places:
    """Bounds on the batches that one process receives.

    Each is received by a thread, which holds one of a few turns except while it waits for the event loop. So however
    many senders are slow, the batches of others are read.
    """

    def __init__(self, at_once: int, under_way: int) -> None:
        """Take how many batches are read at once, and how many may be under way."""
        self._turns = Semaphore(at_once)
        self._threads = CapacityLimiter(under_way)
        self._most, self._most_of_owner = under_way, max(1, under_way // _OWNERS)
        self._owners: Counter[str] = Counter()

    async def run(self, owner: str, work: Callable[[], Answer]) -> Answer:
        """Return what a function returns, called in a thread in its turn; what it waits for it takes by `awaited`.

        Raises
        ------
        Busy
            If too many batches are under way already, of all owners or of this one.
        """

        def turn() -> Answer:
            with self._turns:
                return work()

        with self._entered(owner):
            return await to_thread.run_sync(turn, limiter=self._threads)

    def awaited(self, call: Callable[[*Arguments], Coroutine[Any, Any, Answer]], *arguments: *Arguments) -> Answer:
        """Return what the event loop finds for a thread of `run`, and leave the thread's turn to others meanwhile."""
        self._turns.release()
        try:
            return from_thread.run(call, *arguments)
        finally:
            self._turns.acquire()

    @contextmanager
    def _entered(self, owner: str) -> Iterator[None]:
        if self._owners.total() >= self._most or self._owners[owner] >= self._most_of_owner:
            raise Busy
        self._owners[owner] += 1
        try:
            yield
        finally:
            self._owners[owner] -= 1
            if not self._owners[owner]:
                del self._owners[owner]
