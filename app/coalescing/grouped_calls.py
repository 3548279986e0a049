"""Answer simultaneous calls in groups: one thread, one connection and one commit for a whole group."""

import asyncio
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Generic, TypeVar

from sqlalchemy.orm import Session, sessionmaker

Question = TypeVar("Question")
Answer = TypeVar("Answer")

_MOST_AT_ONCE = 100


class Groups(Generic[Question, Answer]):
    """Gathers questions while a group is being answered, then answers what has gathered as the next group.

    Alone a question waits for nobody. Under load the cost of a transaction is shared, and only one thread competes with
    the event loop, where a thread for every request would make all of them wait for each other.
    """

    def __init__(
        self,
        name: str,
        answer: Callable[[Sequence[Question]], Sequence[Answer | Exception]],
        rest_seconds: float = 0.0,
    ) -> None:
        """Take the function that answers a group, called in a thread of this object's own.

        It returns an answer for every question, or the exception that shall be raised where the question was asked.
        After a group of several a rest lets the next one gather, unless that is full: under load larger groups cost
        less than they wait.
        """
        self._answer = answer
        self._thread = ThreadPoolExecutor(1, thread_name_prefix=name)
        self._waiting: list[tuple[Question, asyncio.Future[Answer]]] = []
        self._work: asyncio.Task[None] | None = None
        self._rest_seconds = rest_seconds
        self._closing = asyncio.Event()

    async def ask(self, question: Question) -> Answer:
        """Return the answer to a question.

        Raises
        ------
        Exception
            What the answering function gave for this question, or raised for its whole group.
        """
        return await self.put(question)

    def put(self, question: Question) -> "asyncio.Future[Answer]":
        """Add a question to the next group without waiting for its answer."""
        future: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._waiting.append((question, future))
        if self._work is None:
            self._work = asyncio.create_task(self._answer_all())
        return future

    async def close(self) -> None:
        """Answer what is still waiting, then end the thread."""
        self._closing.set()
        if self._work is not None:
            await self._work
        self._thread.shutdown()

    async def _answer_all(self) -> None:
        try:
            while self._waiting:
                group = self._waiting[:_MOST_AT_ONCE]
                del self._waiting[:_MOST_AT_ONCE]
                for (_, future), answer in zip(group, await self._answers([q for q, _ in group]), strict=True):
                    _settle(future, answer)
                await self._rest(len(group))
        finally:
            self._work = None

    async def _rest(self, answered: int) -> None:
        if self._rest_seconds and answered > 1 and len(self._waiting) < _MOST_AT_ONCE:
            with suppress(TimeoutError):
                await asyncio.wait_for(self._closing.wait(), self._rest_seconds)

    async def _answers(self, questions: Sequence[Question]) -> Sequence[Answer | Exception]:
        try:
            return await asyncio.get_running_loop().run_in_executor(self._thread, self._answer, questions)
        except Exception as error:
            return [error] * len(questions)


def committed_together(
    sessions: sessionmaker[Session],
    work: Callable[[Session, Sequence[Question]], Sequence[Answer | Exception]],
    questions: Sequence[Question],
) -> Sequence[Answer | Exception]:
    """Answer several questions in one transaction; if that fails, each anew in a transaction of its own.

    So the others know nothing of one that fails. The work may be done twice and must change nothing but the database.
    """
    if len(questions) > 1:
        try:
            with sessions.begin() as session:
                return work(session, questions)
        except Exception:  # whoever's fault it is is found below
            pass
    return [_alone(sessions, work, question) for question in questions]


def _alone(
    sessions: sessionmaker[Session],
    work: Callable[[Session, Sequence[Question]], Sequence[Answer | Exception]],
    question: Question,
) -> Answer | Exception:
    try:
        with sessions.begin() as session:
            (answer,) = work(session, [question])
    except Exception as error:
        return error
    return answer


def _settle(future: "asyncio.Future[Answer]", answer: Answer | Exception) -> None:
    if future.done():  # whoever asked has gone
        return
    if isinstance(answer, Exception):
        future.set_exception(answer)
    else:
        future.set_result(answer)
