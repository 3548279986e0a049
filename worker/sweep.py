"""The sweeper: release jobs whose worker is gone, and send jobs whose message was never sent or was lost.

Any number of processes may sweep at once: row locks protect the jobs, and an extra message is harmless.
"""

import logging
from datetime import timedelta
from uuid import UUID

from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.jobs import idempotency, leases, turns
from app.jobs.dispatch import BrokerUnavailable, open_queue
from app.runtime.settings import Settings
from app.security import sessions as sessions_of_browsers
from app.storage import counters, steady_clock
from app.tables import Job

_logger = logging.getLogger(__name__)


class ClockKeeper:
    """Moves the steady clock on before every sweep of a process, and says when the database's clock was set."""

    def __init__(self, sessions: sessionmaker[Session], settings: Settings) -> None:
        """Take what a look needs."""
        self._sessions, self._settings = sessions, settings
        self._since: float | None = None

    def look(self) -> None:
        """Move the clock on.

        Raises
        ------
        sqlalchemy.exc.SQLAlchemyError
            If the database fails.
        """
        with self._sessions.begin() as session:
            step = steady_clock.move_on(session, self._since)
            if step is None:
                return
            if step.is_known:
                _logger.warning("the database's clock was set by %.0f s; leases go on", -step.by.total_seconds())
                leases.shorten(session, self._settings.lease_seconds)
            if step.unwatched > timedelta(seconds=self._settings.lease_seconds / 2.0):
                leases.postpone(session, step.unwatched)
        self._since = step.noted_at


def sweep(sessions: sessionmaker[Session], settings: Settings) -> int:
    """Release expired leases, then send a message for each job that needs one; return the number of messages.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database fails; the next sweep completes the work.
    """
    release(sessions, settings)
    with sessions.begin() as session:
        batch_records.discard_abandoned(session)
        counters.fold(session)
        idempotency.forget_expired(session)
        sessions_of_browsers.forget_expired(session)
    return sum(_send_waiting(sessions, settings, chunks) for chunks in (False, True))


def _send_waiting(sessions: sessionmaker[Session], settings: Settings, chunks: bool) -> int:
    taken: list[UUID] = []
    sent = 0
    try:
        with open_queue(settings) as queue:
            empty = queue.is_empty(chunk=chunks)
            with sessions.begin() as session:
                taken = leases.take_undispatched(session, settings, queue_is_empty=empty, chunks=chunks)
            for job_id in taken:
                queue.send(job_id, chunk=chunks)
                sent += 1
    except BrokerUnavailable as error:
        _logger.warning("the broker cannot be reached: %s", error)
        with sessions.begin() as session:
            leases.mark_undispatched(session, taken[sent:])
    return sent


def call_next(sessions: sessionmaker[Session], settings: Settings, owner: str) -> None:
    """Send a message for an owner's next job, if none waits that could run it: those that came may have run nothing.

    For the end of a job where an owner's running jobs are bounded. If it fails, a later sweep sends one.
    """
    try:
        with open_queue(settings) as queue:
            if not (queue.is_empty() and queue.is_empty(chunk=True)):
                return
            with sessions() as session:
                following = turns.next_of(session, owner)
                job = None if following is None else session.get(Job, following)
            if job is not None:
                queue.send(job.id, chunk=job.batch_id is not None)
    except (BrokerUnavailable, SQLAlchemyError) as error:
        _logger.warning("the next job of %s is left to the sweeper: %s", owner, error)


def release(sessions: sessionmaker[Session], settings: Settings, owner: str | None = None) -> int:
    """Release jobs whose lease expired, or all jobs of a worker that is known to be dead; return their number.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database fails.
    """
    with sessions.begin() as session:
        released = leases.release_expired(session, settings, owner)
    if released:
        _logger.warning("released %d jobs of lost workers", released)
    return released
