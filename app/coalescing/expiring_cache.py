"""Answers that hold for some seconds, so that most requests cost no look at the database."""

import asyncio
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Generic, TypeVar

from anyio import to_thread

_MOST_KEPT = 10_000

Question = TypeVar("Question", bound=Hashable)
Answer = TypeVar("Answer")


@dataclass(frozen=True, slots=True)
class _Kept(Generic[Answer]):
    until: float
    answer: asyncio.Task[Answer]


class Memo(Generic[Question, Answer]):
    """Asks once, in a thread, what many want to know, and keeps the answer for some seconds unless it is falsy.

    Who asks while a look is under way waits for that look.
    """

    def __init__(self, look: Callable[[Question], Answer], seconds: float) -> None:
        """Take what finds an answer, and how long one holds from the moment at which it was asked for."""
        self._look = look
        self._seconds = seconds
        self._kept: dict[Question, _Kept[Answer]] = {}

    def knows(self, question: Question) -> bool:
        """Tell whether the answer is at hand, or on its way."""
        kept = self._kept.get(question)
        return kept is not None and kept.until > time.monotonic()

    async def ask(self, question: Question) -> Answer:
        """Return the answer; whatever the look raises is raised, and not kept."""
        if not self.knows(question):
            if len(self._kept) >= _MOST_KEPT:
                self._kept.clear()
            task = asyncio.ensure_future(to_thread.run_sync(self._look, question))
            self._kept[question] = _Kept(time.monotonic() + self._seconds, task)
        kept = self._kept[question]
        try:
            answer = await asyncio.shield(kept.answer)  # one who leaves must not end a look for which others wait
        except Exception:
            self._forget(question, kept)
            raise
        if not answer:
            self._forget(question, kept)
        return answer

    def _forget(self, question: Question, kept: _Kept[Answer]) -> None:
        if self._kept.get(question) is kept:
            del self._kept[question]
