"""Whose job a worker runs next: a message lets it run one job, and the owners who wait take turns.

So an owner's thousand chunks delay another owner's line by the one or two that are running, however early they came.
"""

import random
from collections.abc import Iterator, Sequence
from typing import Any
from uuid import UUID

from sqlalchemy import ColumnElement, bindparam, func, select
from sqlalchemy.orm import Session

from app.tables import Job, JobStatus

# The status stands in the statement itself, or databases would not know that the index of waiting jobs has these rows.
_WAITS = Job.status == bindparam("waits", JobStatus.ACCEPTED, unique=True, literal_execute=True)


def in_turn(session: Session, job_id: UUID) -> UUID | None:
    """Return the job that the message of a job lets a worker run, None if no job waits.

    The next owner is the one with the fewest running jobs, by lot among equals. It is the message's job if it waits and
    is that owner's, else the owner's oldest, single jobs before chunks of batches.
    """
    owners = _waiting_owners(session)
    if not owners:
        return None
    owner = _next(session, owners)
    own = Job.id == job_id
    for wanted, order in _preferences(own):
        waiting = select(Job.id).where(_WAITS, Job.owner == owner, wanted).order_by(*order).limit(1)
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
    first = select(func.min(Job.owner).label("owner")).where(_WAITS).cte(recursive=True)
    following = select(func.min(Job.owner)).where(_WAITS, Job.owner > first.c.owner).scalar_subquery()
    owners = first.union_all(select(following).where(first.c.owner.is_not(None)))
    return session.scalars(select(owners.c.owner).where(owners.c.owner.is_not(None))).all()


def _next(session: Session, owners: Sequence[str]) -> str:
    if len(owners) == 1:
        return owners[0]
    running = select(Job.owner, func.count()).where(Job.status == JobStatus.RUNNING).group_by(Job.owner)
    counts = {owner: number for owner, number in session.execute(running)}  # noqa: C416 - rows are no pairs for mypy
    return min(owners, key=lambda owner: (counts.get(owner, 0), random.random()))
