"""The steady clock: the database's clock without its steps, by which leases and other waits of the service end.

A machine's clock may be set by an hour, ahead or back. Moments that people read come from it all the same
(`database_time`); what expires is judged by the steady clock. Its row holds the last reading, and no time before it is
read again, not even after a restart on a clock that was set back. The sweepers move the reading on,
and compare it with their own monotonic clocks, which no one sets. The caller commits the transaction.
"""

import time
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from app.storage.database import database_moment, database_time, keep_database_time
from app.tables import SteadyClock

_LOOK = "row of the steady clock in this transaction"

TOLERANCE = timedelta(seconds=1)
"""Smaller differences between clocks are no steps: a query takes its time, and clocks are slewed."""


@dataclass(frozen=True, slots=True)
class Step:
    """What the steady clock has taken out of the database's clock: positive if that was set back.

    `noted_at` is the monotonic time of the look, in seconds. `unwatched` is the time before a process's first look in
    which no sweeper has looked, as far as the database's clock tells.
    """

    by: timedelta
    unwatched: timedelta
    noted_at: float

    @property
    def is_known(self) -> bool:
        """Tell whether the clock was set, rather than only read at another moment."""
        return abs(self.by) > TOLERANCE


def steady_time(session: Session) -> datetime:
    """Return the steady clock's time in UTC, never one before the last reading."""
    reading, ahead = _row(session)
    return max(database_time(session) + ahead, reading)


def last_reading(session: Session) -> datetime:
    """Return the steady clock's last reading; unlike `steady_time` it knows of every step."""
    return _row(session)[0]


def unnoted_step(session: Session) -> timedelta:
    """Return how far the database's clock has gone back since a sweeper last looked; zero in a running service."""
    reading, ahead = _row(session)
    return max(timedelta(0), reading - database_time(session) - ahead)


def move_on(session: Session, since: float | None) -> Step | None:
    """Move the reading on, and take a step of the database's clock out of it; None if another process is at it.

    Parameters
    ----------
    since : float, optional
        `noted_at` of this process's last look: no more time has passed since the last reading, whoever made it. At the
        first look of a process the database's clock is believed when it is ahead, because the service may have been
        off.
    """
    row = session.scalars(select(SteadyClock).with_for_update(skip_locked=True)).one_or_none()
    if row is None:
        return None
    noted_at = time.monotonic()
    clock = database_time(session)
    former, ahead = row.reading, timedelta(seconds=row.ahead_seconds)
    reading = max(clock + ahead, former)
    if since is not None:
        latest = former + timedelta(seconds=time.monotonic() - since)
        reading = latest if reading > latest + TOLERANCE else reading
    row.reading, row.ahead_seconds = reading, (reading - clock).total_seconds()
    session.info.pop(_LOOK, None)
    session.flush()
    unwatched = timedelta(0) if since is not None else reading - former
    return Step(reading - clock - ahead, unwatched, noted_at)


def _row(session: Session) -> tuple[datetime, timedelta]:
    """Return the last reading, and how far the steady clock is ahead; they are queried once for each transaction."""
    read_in, row = session.info.get(_LOOK, (None, None))
    if read_in is None or read_in is not session.get_transaction():
        moment = database_moment(session)
        clock = [moment] if isinstance(moment, ColumnElement) else []
        found = session.execute(select(SteadyClock.reading, SteadyClock.ahead_seconds, *clock)).one()
        if clock:
            keep_database_time(session, found[2])
        row = found.reading, timedelta(seconds=found.ahead_seconds)
        session.info[_LOOK] = session.get_transaction(), row
    reading, ahead = row
    return reading, ahead
