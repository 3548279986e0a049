"""Retention: remove what ended long ago with its results and events, in transactions of bounded size.

A batch is removed completely or not at all: only when its last chunk ended long enough ago. It is hidden from its owner
before its first row is removed. After an interruption the next run finds the remaining rows and continues.
"""

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from typing import Any
from uuid import UUID

from sqlalchemy import ColumnElement, and_, delete, exists, func, or_, select, update
from sqlalchemy.orm import Session, sessionmaker

from app.security import audit
from app.security.audit import OPERATOR
from app.storage.database import database_time
from app.tables import AuditAction, AuditEvent, Batch, BatchItem, Job, JobStatus

_JOBS_AT_ONCE = 50
_LINES_AT_ONCE = 1000
_EVENTS_AT_ONCE = 5000
_OPEN = (JobStatus.ACCEPTED, JobStatus.RUNNING)
_NOWHERE = UUID(int=0)


@dataclass(frozen=True, slots=True)
class Retention:
    """How long to keep finished jobs and batches, and how long the audit record."""

    results: timedelta
    audit: timedelta


@dataclass(frozen=True, slots=True)
class Pruned:
    """How much was removed, or would be."""

    jobs: int
    batches: int
    lines: int
    audit_events: int


def due(sessions: sessionmaker[Session], retention: Retention) -> Pruned:
    """Count what a run would remove now, without changing anything."""
    with sessions() as session:
        before, audit_before = _moments(session, retention)
        gone = _over(before)
        lines = exists().where(Batch.id == BatchItem.batch_id, gone)
        return Pruned(
            jobs=_count(session, Job.id, and_(_single(), *_ended(before))),
            batches=_count(session, Batch.id, gone),
            lines=_count(session, BatchItem.number, lines),
            audit_events=_count(session, AuditEvent.id, AuditEvent.at < audit_before),
        )


def prune(sessions: sessionmaker[Session], retention: Retention) -> Pruned:
    """Remove what is due, and record that in the audit record.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database fails; the next run continues where this one stopped.
    """
    with sessions() as session:
        before, audit_before = _moments(session, retention)
    batches = _hide_batches(sessions, before)
    jobs = _delete_jobs(sessions, and_(_single(), *_ended(before)))
    _delete_jobs(sessions, and_(~_single(), ~_in_visible_batch(), *_ended(before)))
    lines = _delete_lines(sessions, before)
    pruned = Pruned(jobs, batches, lines, _delete_events(sessions, audit_before))
    with sessions.begin() as session:
        summary = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in asdict(pruned).items())
        audit.record(session, OPERATOR, AuditAction.PRUNED, detail=f"before {before:%Y-%m-%d %H:%M}: {summary}")
    return pruned


def _moments(session: Session, retention: Retention) -> tuple[datetime, datetime]:
    now = database_time(session)
    return now - retention.results, now - retention.audit


def _single() -> ColumnElement[bool]:
    return Job.batch_id.is_(None)


def _ended(before: datetime) -> tuple[ColumnElement[bool], ...]:
    return Job.status.not_in(_OPEN), Job.finished_at < before


def _in_visible_batch() -> ColumnElement[bool]:
    return exists().where(Batch.id == Job.batch_id, Batch.received_at.is_not(None))


def _over(before: datetime) -> ColumnElement[bool]:
    """Select batches that were received completely and whose chunks all ended before a time."""
    holds = exists().where(Job.batch_id == Batch.id, or_(Job.status.in_(_OPEN), Job.finished_at >= before))
    return and_(Batch.received_at.is_not(None), Batch.created_at < before, ~holds)


def _count(session: Session, column: Any, condition: ColumnElement[bool]) -> int:
    return session.scalar(select(func.count(column)).where(condition)) or 0


def _hide_batches(sessions: sessionmaker[Session], before: datetime) -> int:
    """Hide the batches that are due, one in each transaction, and return their number."""

    def hide(session: Session, _: UUID) -> list[UUID]:
        found = session.scalars(select(Batch.id).where(_over(before)).limit(1).with_for_update(skip_locked=True)).all()
        # Check again under the lock: a resubmit may have happened in between.
        hidden = update(Batch).where(Batch.id.in_(found), _over(before)).values(received_at=None).returning(Batch.id)
        return list(session.scalars(hidden))

    return sum(1 for _ in _blocks(sessions, hide))


def _delete_jobs(sessions: sessionmaker[Session], condition: ColumnElement[bool]) -> int:
    """Remove jobs with all their rows, and return their number."""

    def remove(session: Session, last: UUID) -> list[UUID]:
        wanted = select(Job.id).where(Job.id > last, condition).order_by(Job.id).limit(_JOBS_AT_ONCE)
        ids = list(session.scalars(wanted.with_for_update(skip_locked=True)))
        session.execute(delete(Job).where(Job.id.in_(ids)))
        return ids

    return sum(map(len, _blocks(sessions, remove)))


def _blocks(sessions: sessionmaker[Session], step: Callable[[Session, UUID], list[UUID]]) -> Iterator[list[UUID]]:
    """Repeat a step, one transaction each, from the last id of the one before, until it finds nothing."""
    last = _NOWHERE
    while True:
        with sessions.begin() as session:
            done = step(session, last)
        if not done:
            return
        last = done[-1]
        yield done


def _delete_lines(sessions: sessionmaker[Session], before: datetime) -> int:
    """Remove hidden batches with their lines, and return the number of lines."""
    hidden = Batch.received_at.is_(None), Batch.created_at < before
    with sessions() as session:
        batch_ids = list(session.scalars(select(Batch.id).where(*hidden)))
    lines = 0
    for batch_id in batch_ids:
        while removed := _delete_some_lines(sessions, batch_id):
            lines += removed
        with sessions.begin() as session:
            session.execute(delete(Batch).where(Batch.id == batch_id, *hidden))
    return lines


def _delete_some_lines(sessions: sessionmaker[Session], batch_id: UUID) -> int:
    of_batch = BatchItem.batch_id == batch_id
    with sessions.begin() as session:
        some = select(BatchItem.number).where(of_batch).order_by(BatchItem.number).limit(_LINES_AT_ONCE)
        numbers = session.scalars(some).all()
        if numbers:
            session.execute(delete(BatchItem).where(of_batch, BatchItem.number <= numbers[-1]))
    return len(numbers)


def _delete_events(sessions: sessionmaker[Session], before: datetime) -> int:
    """Remove the oldest events of the audit record, and return their number."""

    def remove(session: Session, last: UUID) -> list[UUID]:
        wanted = select(AuditEvent.id).where(AuditEvent.id > last, AuditEvent.at < before)
        ids = list(session.scalars(wanted.order_by(AuditEvent.id).limit(_EVENTS_AT_ONCE)))
        session.execute(delete(AuditEvent).where(AuditEvent.id.in_(ids)))
        return ids

    return sum(map(len, _blocks(sessions, remove)))
