"""Whose job a worker runs next: a message lets it run one job, and the owners who wait take turns.

So an owner's thousand chunks delay another owner's line by the one or two that are running, however early they came.
With a bound on an owner's running jobs, a message runs nothing where all who wait have as many; when one of their jobs
ends, the worker makes up for it.
"""

import random
from collections.abc import Iterator, Sequence
from typing import Any
from uuid import UUID

from sqlalchemy import ColumnElement, Select, bindparam, func, select
from sqlalchemy.orm import Session

from app.storage.database import serialize
from app.tables import Job, JobStatus

WAITS = Job.status == bindparam("waits", JobStatus.ACCEPTED, unique=True, literal_execute=True)
"""The status stands in the statement itself, or databases would not know that the index of waiting jobs has these."""

_RUNS = Job.status == JobStatus.RUNNING


def in_turn(session: Session, job_id: UUID, most_running: int = 0) -> UUID | None:
    """Return the job that the message of a job lets a worker run, None if no job waits that may run.

    The next owner is the one with the fewest running jobs, by lot among equals. It is the message's job if it waits and
    is that owner's, else the owner's oldest, single jobs before chunks of batches. An owner runs `most_running` at
    once, zero for any number, if the caller claims the job in the same transaction.
    """
    owner = _next(session, _waiting_owners(session), most_running)
    return None if owner is None else next_of(session, owner, job_id)


def next_of(session: Session, owner: str, job_id: UUID | None = None) -> UUID | None:
    """Return the job of an owner that runs next: this one if it waits, else the oldest; None if no job waits."""
    own = Job.id == job_id
    for wanted, order in _preferences(own):
        waiting = select(Job.id).where(WAITS, Job.owner == owner, wanted).order_by(*order).limit(1)
        # The API may hold the message's own job for a moment, while it notes that the message was sent.
        found = session.scalar(waiting.with_for_update(skip_locked=wanted is not own))
        if found is not None:
            return found
    return None


def _preferences(own: ColumnElement[bool]) -> Iterator[tuple[ColumnElement[bool], Sequence[Any]]]:
    """Yield which of an owner's jobs are looked for, and their order, as the index of waiting jobs has it."""
    yield own, ()
    yield Job.batch_id.is_(None), (Job.created_at,)
    yield Job.batch_id.is_not(None), (Job.batch_id, Job.created_at)


def _waiting_owners(session: Session) -> Sequence[str]:
    """Return the owners with waiting jobs; the index is asked once for each owner, however many jobs wait."""
    first = select(func.min(Job.owner).label("owner")).where(WAITS).cte(recursive=True)
    following = select(func.min(Job.owner)).where(WAITS, Job.owner > first.c.owner).scalar_subquery()
    owners = first.union_all(select(following).where(first.c.owner.is_not(None)))
    return session.scalars(select(owners.c.owner).where(owners.c.owner.is_not(None))).all()


def having(most_running: int) -> Select[str]:
    """Select the owners who have so many running jobs, or more."""
    return select(Job.owner).where(_RUNS).group_by(Job.owner).having(func.count() >= most_running)


def _next(session: Session, owners: Sequence[str], most_running: int) -> str | None:
    if len(owners) <= 1 and not most_running:
        return next(iter(owners), None)
    running = select(Job.owner, func.count()).where(_RUNS).group_by(Job.owner)
    counts = {owner: number for owner, number in session.execute(running)}  # noqa: C416 - rows are no pairs for mypy
    ranked = sorted(owners, key=lambda owner: (counts.get(owner, 0), random.random()))
    if not most_running:
        return ranked[0]
    below = (owner for owner in ranked if counts.get(owner, 0) < most_running)
    return next((owner for owner in below if _takes_place(session, owner, most_running)), None)


def _takes_place(session: Session, owner: str, most_running: int) -> bool:
    """Tell whether an owner still has a place to run a job, and keep others from taking it in this transaction."""
    running = select(func.count()).select_from(Job).where(_RUNS, Job.owner == owner)
    attempt = session.begin_nested()
    serialize(session, f"turns of {owner}")
    if (session.scalar(running) or 0) < most_running:
        attempt.commit()
        return True
    attempt.rollback()  # frees the lock: who held one owner's and waited for another's could wait for ever
    return False
