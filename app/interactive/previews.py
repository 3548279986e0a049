"""Compute a line in a process of this API process's own, one line at a time and each for a bounded time.

The queue keeps its workers: the previews of an API process cost it at most one process's share of a processor, and only
while a person waits for them.
"""

import os
from collections import Counter
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, TypeVar

import anyio
from anyio import CapacityLimiter, to_process

from app import convert
from app.convert import PointResult
from app.interactive.busy import Busy
from app.reference.source_lines import example
from app.runtime.processes import end_with_parent

Argument = TypeVar("Argument")
Answer = TypeVar("Answer")

_MOST_OF_OWNER = 2  # one that is computed and one that waits: a slider has moved on by then
_MOST_WAITING = 8


class TakesTooLong(Exception):
    """Raised when a line is not done within the time for a preview."""


class Previews:
    """Computes previews for the requests of one API process."""

    def __init__(self, seconds: float) -> None:
        """Take the longest time for one line [s]; the process starts at the first one."""
        self.seconds = seconds
        self._slot = CapacityLimiter(1)
        self._waiting: Counter[str] = Counter()

    async def compute(self, owner: str, document: Mapping[str, Any]) -> PointResult:
        """Compute a request without a study, for an owner.

        Raises
        ------
        Busy
            If two of the owner's previews, or eight of all owners, are not done yet.
        TakesTooLong
            If the line is not done in time; its computation is ended.
        InvalidSpec, ValueError, ArithmeticError
            If the engine refuses the line.
        """
        if self._waiting[owner] >= _MOST_OF_OWNER or self._waiting.total() >= _MOST_WAITING:
            raise Busy
        self._waiting[owner] += 1
        try:
            async with self._slot:
                await _in_process(_load, os.getpid())  # starting a process is no time of the line
                with anyio.move_on_after(self.seconds):
                    return await _in_process(_computed, document)
            raise TakesTooLong
        finally:
            self._waiting -= Counter([owner])  # drops owners with none


async def _in_process(call: Callable[[Argument], Answer], argument: Argument) -> Answer:
    return await to_process.run_sync(call, argument, cancellable=True)


@cache
def _load(parent: int) -> None:
    """Make the process ready, once; it ends with the API's process, for which alone it computes."""
    end_with_parent(parent)
    _computed({"line": example("c11-twin"), "analysis": {"loops": [1], "wind_speeds_m_per_s": [4.0]}})


def _computed(document: Mapping[str, Any]) -> PointResult:
    (point,) = (item for item in convert.run(document) if isinstance(item, PointResult))
    return point
