"""The audit record: who changed what, written in the transaction of the change."""

from collections.abc import Iterator, Sequence
from datetime import datetime
from uuid import UUID

from sqlalchemy import select
from sqlalchemy.orm import Session
from uuid_utils.compat import uuid7

from app.security.caller import Caller
from app.storage.database import database_time, insert_rows
from app.tables import AuditAction, AuditEvent

_AT_ONCE = 1000

OPERATOR = Caller("operator", frozenset())
"""The caller on the command line of the service's own machine."""


def record(
    session: Session,
    caller: Caller,
    action: AuditAction,
    subject: UUID | None = None,
    detail: str | None = None,
    *,
    at: datetime | None = None,
) -> None:
    """Add a caller's action to the audit record, at the given moment or now."""
    made_by = {"owner": caller.owner, "key_id": caller.key_id}
    session.add(
        AuditEvent(
            id=uuid7(), at=at or database_time(session), action=action, subject=subject, detail=detail, **made_by
        )
    )


def record_submissions(session: Session, jobs: Sequence[tuple[Caller, UUID]], at: datetime) -> None:
    """Add to the audit record, in one statement, that callers submitted jobs at this moment."""
    of_all = {"at": at, "action": AuditAction.JOB_SUBMITTED, "detail": None}
    insert_rows(
        session,
        AuditEvent,
        [
            {"id": uuid7(), "owner": caller.owner, "key_id": caller.key_id, "subject": job_id, **of_all}
            for caller, job_id in jobs
        ],
    )


def latest(session: Session, owner: str | None, since: datetime | None, limit: int) -> Sequence[AuditEvent]:
    """Return the newest events, newest first, optionally of one owner or since a moment."""
    statement = select(AuditEvent).order_by(AuditEvent.id.desc()).limit(limit)
    if owner is not None:
        statement = statement.where(AuditEvent.owner == owner)
    if since is not None:
        statement = statement.where(AuditEvent.at >= since)
    return session.scalars(statement).all()


def between(
    session: Session, owner: str | None, since: datetime | None, until: datetime | None
) -> Iterator[AuditEvent]:
    """Yield events in the order of their ids, optionally of one owner, since a moment, or before another."""
    statement = select(AuditEvent).order_by(AuditEvent.id).execution_options(yield_per=_AT_ONCE)
    if owner is not None:
        statement = statement.where(AuditEvent.owner == owner)
    if since is not None:
        statement = statement.where(AuditEvent.at >= since)
    if until is not None:
        statement = statement.where(AuditEvent.at < until)
    yield from session.scalars(statement)
