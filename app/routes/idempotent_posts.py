"""A POST under an `Idempotency-Key` is done once; the same request under it gets the first answer again."""

import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import copy_context
from dataclasses import dataclass
from datetime import timedelta
from typing import Annotated
from uuid import UUID

from fastapi import Depends, Header, Request
from fastapi.responses import JSONResponse, Response
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.http.problems import ProblemError, ProblemKind
from app.jobs import idempotency
from app.jobs.idempotency import Answer, Kept, Key, KeyTaken
from app.routes.dependencies import RETRY_SECONDS

_RENEWALS_A_LEASE = 5
_REPLAYED = "Idempotency-Replayed"
_OF_THE_BODY = frozenset({"content-length", "content-type"})
KEY_PROBLEMS = (ProblemKind.INVALID_PARAMETER, ProblemKind.REQUEST_IN_FLIGHT, ProblemKind.KEY_REUSED)

_logger = logging.getLogger(__name__)


async def _key(
    request: Request,
    idempotency_key: Annotated[
        str | None,
        Header(
            min_length=1,
            max_length=255,
            pattern=r"^[\x20-\x7e]+$",
            description="The same request under the same key is done once within 24 hours and gets the first answer "
            "again. The same key with another request is 422, and 409 while the first is still at work.",
            examples=["5e2f1c6e-6f0f-4d3a-9a53-0f4b8d2a7c11"],
        ),
    ] = None,
) -> Key | None:
    return idempotency.new_key(request.state.caller.owner, idempotency_key) if idempotency_key is not None else None


KeyOf = Annotated[Key | None, Depends(_key)]


@dataclass(frozen=True, slots=True)
class PostOutcome:
    """The answer to a POST, and the jobs that it made, to be sent to the workers after the commit."""

    answer: Response
    job_ids: Sequence[UUID] = ()


def run_once(
    writers: sessionmaker[Session],
    key: Key | None,
    fingerprint: Callable[[], str],
    make: Callable[[Session], PostOutcome],
) -> PostOutcome:
    """Make something and keep the answer in one transaction; under a key that is in use, give its answer again.

    Raises
    ------
    ProblemError
        As `make` raises it, then with nothing kept; 409 if a request at work holds the key, 422 if it is another's.
    """
    try:
        with writers.begin() as session:
            made = make(session)
            if key is not None and not idempotency.keep(
                session, [Kept(key, fingerprint(), stored_answer(made.answer))]
            ):
                raise KeyTaken
            return made
    except KeyTaken:
        assert key is not None
        return PostOutcome(replayed_answer(writers, key, fingerprint))


def run_holding_key(
    writers: sessionmaker[Session],
    key: Key | None,
    fingerprint: Callable[[], str],
    work: Callable[[], PostOutcome],
    lease_seconds: float,
) -> PostOutcome:
    """Do what takes several transactions while the key is held under a lease; the last of them finishes it.

    Raises
    ------
    ProblemError
        As `work` raises it, then with the key given up; else as from `run_once`.
    """
    if key is None:
        return work()
    try:
        with writers.begin() as session:
            idempotency.hold(session, key, timedelta(seconds=lease_seconds))
    except KeyTaken:
        return PostOutcome(replayed_answer(writers, key, fingerprint))
    try:
        with _key_renewed(writers, key, lease_seconds):
            return work()
    except BaseException as error:
        with suppress(SQLAlchemyError), writers.begin() as session:
            idempotency.release(session, key)
        if isinstance(error, KeyTaken):
            raise _in_flight() from error
        raise


@contextmanager
def _key_renewed(writers: sessionmaker[Session], key: Key, lease_seconds: float) -> Iterator[None]:
    """Renew the lease of a key in a thread, so that it lasts however slow the work is, and ends with the process.

    Who has lost it to another learns so when the work finishes the key.
    """
    ended = threading.Event()

    def run() -> None:
        while not ended.wait(lease_seconds / _RENEWALS_A_LEASE):
            try:
                with writers.begin() as session:
                    idempotency.renew(session, key, timedelta(seconds=lease_seconds))
            except KeyTaken:
                return
            except SQLAlchemyError as error:
                _logger.warning("the lease of a key is not renewed: %s", error)

    thread = threading.Thread(target=copy_context().run, args=(run,), name="key-lease", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def replayed_answer(sessions: sessionmaker[Session], key: Key, fingerprint: Callable[[], str]) -> Response:
    """Return the first answer under a key; the fingerprint of the request is only asked for if there is one.

    Raises
    ------
    ProblemError
        409 if there is none yet, 422 if it is another request's.
    """
    with sessions() as session:
        found = idempotency.find(session, key)
    if found is None:
        raise _in_flight()
    first, answer = found
    if first != fingerprint():
        raise ProblemError(ProblemKind.KEY_REUSED, "This Idempotency-Key was used for another request.")
    headers = {**answer.headers, _REPLAYED: "true"}
    return Response(answer.body, answer.status, headers=headers, media_type=JSONResponse.media_type)


def stored_answer(answer: Response) -> Answer:
    """Return what is kept of an answer."""
    headers = {name: value for name, value in answer.headers.items() if name not in _OF_THE_BODY}
    return Answer(answer.status_code, headers, bytes(answer.body).decode())


def _in_flight() -> ProblemError:
    detail = "A request with this Idempotency-Key is still at work."
    return ProblemError(ProblemKind.REQUEST_IN_FLIGHT, detail, headers={"Retry-After": RETRY_SECONDS})
