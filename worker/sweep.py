"""The sweeper: gives back jobs whose worker is gone, and sends jobs whose message never left or was lost.

Any number may sweep at once: jobs are released and taken under row locks, and a message too many is harmless.
"""

import logging
from uuid import UUID

from sqlalchemy.orm import Session, sessionmaker

from app import leases
from app.queue import BrokerUnavailable, open_queue
from app.settings import Settings

_logger = logging.getLogger(__name__)


def sweep(sessions: sessionmaker[Session], settings: Settings) -> int:
    """Release expired leases, then send what waits for a message; return how many messages were sent.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database fails; the next sweep does what this one did not.
    """
    release(sessions, settings)
    taken: list[UUID] = []
    sent = 0
    try:
        with open_queue(settings) as queue:
            empty = queue.is_empty()
            with sessions.begin() as session:
                taken = leases.take_undispatched(session, settings, queue_is_empty=empty)
            for job_id in taken:
                queue.send(job_id)
                sent += 1
    except BrokerUnavailable as error:
        _logger.warning("the broker is not to be reached: %s", error)
        with sessions.begin() as session:
            leases.mark_undispatched(session, taken[sent:])
    return sent


def release(sessions: sessionmaker[Session], settings: Settings, owner: str | None = None) -> int:
    """Give back jobs whose lease ran out, or all jobs of an owner that is known to be dead; return their number.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database fails.
    """
    with sessions.begin() as session:
        released = leases.release_expired(session, settings, owner)
    if released:
        _logger.warning("%d jobs were given back by lost workers", released)
    return released
