"""Work that a person waits for, done in processes of its own, so that it holds up neither other requests nor owners."""

import asyncio
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import TypeVar, TypeVarTuple

from app.interactive.busy import Busy
from app.runtime.processes import ONE_BLAS_THREAD, end_with_parent

Arguments = TypeVarTuple("Arguments")
Answer = TypeVar("Answer")

_CALLS_A_PROCESS = 2000  # after which it is replaced, in case that a library leaks


class Workshop:
    """Processes of one kind of work, started with the first call; whoever waits for one blocks no thread.

    Each owner has at most as many calls with the processes, or waiting for the next free one, as there are processes.
    So an owner's sixty pictures delay the next one of somebody else by one or two.
    """

    def __init__(self, processes: int, *, most_of_owner: int | None = None, most: int | None = None) -> None:
        """Take the number of processes, and how many calls of an owner and of all may be under way."""
        self._processes = processes
        self._most_of_owner, self._most = most_of_owner, most
        self._free = asyncio.Semaphore(processes)
        self._owners: dict[str | None, tuple[asyncio.Semaphore, int]] = {}
        self._pool: ProcessPoolExecutor | None = None

    async def run(self, owner: str | None, call: Callable[[*Arguments], Answer], *arguments: *Arguments) -> Answer:
        """Return what a function of a module returns, when a process is free for this owner.

        Raises
        ------
        Busy
            If too many calls are under way already.
        concurrent.futures.process.BrokenProcessPool
            If the process ended twice meanwhile, as for want of memory.
        """
        with self._entered(owner) as turn:
            async with turn, self._free:
                try:
                    return await self._done(call, *arguments)
                except BrokenProcessPool:
                    self.close()
                    return await self._done(call, *arguments)

    def close(self) -> None:
        """End the processes when they have done what they do now."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None

    async def _done(self, call: Callable[[*Arguments], Answer], *arguments: *Arguments) -> Answer:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(
                self._processes,
                mp_context=multiprocessing.get_context("spawn"),  # a fork would copy locks of other threads
                initializer=_begin,
                initargs=(os.getpid(),),
                max_tasks_per_child=_CALLS_A_PROCESS,
            )
        return await asyncio.get_running_loop().run_in_executor(self._pool, call, *arguments)

    @contextmanager
    def _entered(self, owner: str | None) -> Iterator[asyncio.Semaphore]:
        turn, waiting = self._owners.get(owner, (asyncio.Semaphore(self._processes), 0))
        in_all = sum(number for _, number in self._owners.values())
        if _reached(waiting, self._most_of_owner) or _reached(in_all, self._most):
            raise Busy
        self._owners[owner] = turn, waiting + 1
        try:
            yield turn
        finally:
            turn, waiting = self._owners[owner]
            if waiting > 1:
                self._owners[owner] = turn, waiting - 1
            else:
                del self._owners[owner]


def _reached(number: int, most: int | None) -> bool:
    return most is not None and number >= most


def _begin(parent: int) -> None:
    """Set up a process: it ends with its parent, not with the interrupt that a terminal sends to both."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ.update(ONE_BLAS_THREAD)
    end_with_parent(parent)
