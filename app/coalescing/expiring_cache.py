"""A cache whose entries expire after some seconds, so that most requests need no query of the database."""

import asyncio
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Generic, TypeVar

from anyio import to_thread

_MOST_KEPT = 10_000

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class _Entry(Generic[Value]):
    until: float
    value: asyncio.Task[Value]


class ExpiringCache(Generic[Key, Value]):
    """Loads each value once, in a thread, and keeps it for some seconds unless it is falsy.

    Requests that need a value while it is being loaded wait for that load instead of starting another.
    """

    def __init__(self, load: Callable[[Key], Value], seconds: float) -> None:
        """Take the function that loads a value, and how long a value is kept, counted from the start of its load."""
        self._load = load
        self._seconds = seconds
        self._entries: dict[Key, _Entry[Value]] = {}

    def holds(self, key: Key) -> bool:
        """Tell whether a value is stored or being loaded."""
        entry = self._entries.get(key)
        return entry is not None and entry.until > time.monotonic()

    async def get(self, key: Key) -> Value:
        """Return the value of a key; an exception of the load is raised and not kept."""
        if not self.holds(key):
            if len(self._entries) >= _MOST_KEPT:
                self._entries.clear()
            task = asyncio.ensure_future(to_thread.run_sync(self._load, key))
            self._entries[key] = _Entry(time.monotonic() + self._seconds, task)
        entry = self._entries[key]
        try:
            value = await asyncio.shield(entry.value)  # a cancelled request must not cancel a load that others await
        except Exception:
            self._forget(key, entry)
            raise
        if not value:
            self._forget(key, entry)
        return value

    def forget(self, key: Key) -> None:
        """Let the next request load the value of a key anew."""
        self._entries.pop(key, None)

    def _forget(self, key: Key, entry: _Entry[Value]) -> None:
        if self._entries.get(key) is entry:
            del self._entries[key]
