"""Draw pictures in processes of their own, so that drawing holds up neither other requests nor other owners."""

import asyncio
import multiprocessing
import os
import signal
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from app.plots.facts import Facts, Found
from app.plots.options import Options
from app.plots.registry import draw
from app.runtime.processes import ONE_BLAS_THREAD, end_with_parent

_PICTURES_A_PROCESS = 2000  # after which it is replaced, in case that matplotlib leaks


class Studio:
    """Processes that draw, started with the first picture; whoever waits for one blocks no thread.

    Each owner has at most as many pictures with the processes, or waiting for the next free one, as there are
    processes. So an owner's sixty pictures delay the next one of somebody else by one or two.
    """

    def __init__(self, processes: int) -> None:
        """Take the number of processes that may draw at once."""
        self._processes = processes
        self._free = asyncio.Semaphore(processes)
        self._owners: dict[str | None, tuple[asyncio.Semaphore, int]] = {}
        self._pool: ProcessPoolExecutor | None = None

    async def draw(self, owner: str | None, name: str, found: Found, facts: Facts, options: Options) -> bytes:
        """Draw a picture as `app.plots.draw` does, when a process is free for this owner.

        Raises
        ------
        concurrent.futures.process.BrokenProcessPool
            If the process ended twice while it drew, as for want of memory.
        """
        turn = self._enter(owner)
        try:
            async with turn, self._free:
                try:
                    return await self._drawn(name, found, facts, options)
                except BrokenProcessPool:
                    self.close()
                    return await self._drawn(name, found, facts, options)
        finally:
            self._leave(owner)

    def close(self) -> None:
        """End the processes when they have drawn what they draw now."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None

    async def _drawn(self, name: str, found: Found, facts: Facts, options: Options) -> bytes:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(
                self._processes,
                mp_context=multiprocessing.get_context("spawn"),  # a fork would copy locks of other threads
                initializer=_begin,
                initargs=(os.getpid(),),
                max_tasks_per_child=_PICTURES_A_PROCESS,
            )
        return await asyncio.get_running_loop().run_in_executor(self._pool, draw, name, found, facts, options)

    def _enter(self, owner: str | None) -> asyncio.Semaphore:
        turn, waiting = self._owners.get(owner, (asyncio.Semaphore(self._processes), 0))
        self._owners[owner] = turn, waiting + 1
        return turn

    def _leave(self, owner: str | None) -> None:
        turn, waiting = self._owners[owner]
        if waiting > 1:
            self._owners[owner] = turn, waiting - 1
        else:
            del self._owners[owner]


def _begin(parent: int) -> None:
    """Set up a process that draws: it ends with its parent, not with the interrupt that a terminal sends to both."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ.update(ONE_BLAS_THREAD)
    end_with_parent(parent)
