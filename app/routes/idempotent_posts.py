"""Perform a POST under an `Idempotency-Key` once; answer a repetition with the first answer."""

import json
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
from fastapi.responses import Response
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.http.prefix import LinkedJSON
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
            description="Within 24 hours the service performs a request with this key once, and answers a repetition "
            "with the first answer. Another request with this key gets 422; while the first is in progress, 409.",
            examples=["5e2f1c6e-6f0f-4d3a-9a53-0f4b8d2a7c11"],
        ),
    ] = None,
) -> Key | None:
    return idempotency.new_key(request.state.caller.owner, idempotency_key) if idempotency_key is not None else None


KeyOf = Annotated[Key | None, Depends(_key)]


@dataclass(frozen=True, slots=True)
class PostOutcome:
    """The answer to a POST, and the jobs that it created, to send to the workers after the commit."""

    answer: Response
    job_ids: Sequence[UUID] = ()


def run_once(
    writers: sessionmaker[Session],
    key: Key | None,
    fingerprint: Callable[[], str],
    make: Callable[[Session], PostOutcome],
) -> PostOutcome:
    """Create something and store the answer in one transaction; under a key in use, replay its answer.

    Raises
    ------
    ProblemError
        If `make` raises it, with nothing stored; 409 if a request in
        progress holds the key, 422 if another one used it.
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
    """Do work that takes several transactions while holding the key under a lease; the last one stores the answer.

    Raises
    ------
    ProblemError
        If `work` raises it, with the key freed; otherwise as in `run_once`.
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
    """Renew the lease of a key in a thread, so that it outlasts slow work and ends with the process.

    If another request takes over the key, the work learns so when it stores its answer.
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
                _logger.warning("could not renew the lease of an idempotency key: %s", error)

    thread = threading.Thread(target=copy_context().run, args=(run,), name="key-lease", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def replayed_answer(sessions: sessionmaker[Session], key: Key, fingerprint: Callable[[], str]) -> Response:
    """Return the first answer under a key; compute the request's fingerprint only if there is one.

    Raises
    ------
    ProblemError
        409 if there is no answer yet, 422 if another request used the key.
    """
    with sessions() as session:
        found = idempotency.find(session, key)
    if found is None:
        raise _in_flight()
    first, answer = found
    if first != fingerprint():
        raise ProblemError(ProblemKind.KEY_REUSED, "This Idempotency-Key was used for another request.")
    headers = {**answer.headers, _REPLAYED: "true"}
    return LinkedJSON(json.loads(answer.body), answer.status, headers=headers)


def stored_answer(answer: Response) -> Answer:
    """Return the parts of an answer to store under a key."""
    headers = {name: value for name, value in answer.headers.items() if name not in _OF_THE_BODY}
    return Answer(answer.status_code, headers, bytes(answer.body).decode())


def _in_flight() -> ProblemError:
    detail = "A request with this Idempotency-Key is still in progress."
    return ProblemError(ProblemKind.REQUEST_IN_FLIGHT, detail, headers={"Retry-After": RETRY_SECONDS})
