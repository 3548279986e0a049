"""Jobs from their owner's side: create, look up, list, cancel. The caller opens and commits the transaction."""

import hashlib
import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any
from uuid import UUID

from sqlalchemy import ColumnElement, Select, delete, extract, func, select, tuple_, update
from sqlalchemy.orm import Session, defer, sessionmaker
from uuid_utils.compat import uuid7

from app.convert import expected_bytes
from app.reference.text_forms import written_forms
from app.runtime import correlation
from app.runtime.correlation import Ids
from app.security import audit
from app.security.caller import Caller, Owned
from app.storage import counters, stored_bytes
from app.storage.database import database_time, insert_rows
from app.tables import AuditAction, Batch, BatchItem, Job, JobEvent, JobEventKind, JobStatus, JobTag

LABELS = frozenset({"name", "asset_id", "tags"})

_COLUMNS = tuple(column.key for column in Job.__table__.columns)


class CancelOutcome(StrEnum):
    """What a cancel did: ended a queued job, asked a running one to stop, removed or kept an ended one, found none."""

    DISMISSED = "dismissed"
    REQUESTED = "requested"
    REMOVED = "removed"
    KEPT = "kept"
    MISSING = "missing"


@dataclass(frozen=True, slots=True)
class JobFilters:
    """Filters for a list of jobs; None or empty matches any job. Every tag must match: one of None by its key alone.

    Chunks appear only in the list of their batch.
    """

    status: JobStatus | None = None
    asset_id: str | None = None
    tags: Mapping[str, str | None] = field(default_factory=dict)
    batch_id: UUID | None = None
    created_after: datetime | None = None
    created_before: datetime | None = None
    statuses: Collection[JobStatus] = ()
    shortest_seconds: float | None = None
    longest_seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Submission:
    """A requested job: the caller, the document to compute, its labels, and the ids of the request."""

    caller: Caller
    document: Mapping[str, Any]
    name: str | None = None
    asset_id: str | None = None
    tags: Mapping[str, str] = field(default_factory=dict)
    ids: Ids = field(default_factory=correlation.of_this_work)


def make(submission: Submission, now: datetime) -> Job:
    """Return the job of a submission with its tags and with its size, expected results included, for `insert` to store.

    Raises
    ------
    ValueError
        If the document holds NaN or an infinity, which JSON cannot carry.
    """
    return Job(
        id=uuid7(),
        owner=submission.caller.owner,
        created_at=now,
        status=JobStatus.ACCEPTED,
        progress=0.0,
        step="",
        attempt=0,
        cancel_requested=False,
        name=submission.name,
        asset_id=submission.asset_id,
        document=submission.document,
        input_hash=input_hash(submission.document),
        request_bytes=stored_bytes.of_request(submission.document),
        result_bytes=expected_bytes(submission.document),
        request_id=submission.ids.request_id,
        trace_parent=submission.ids.trace_parent,
        tags=[JobTag(key=key, value=value) for key, value in sorted(submission.tags.items())],
    )


def insert(session: Session, jobs: Sequence[Job]) -> None:
    """Store new jobs with their tags and first events, one statement per table; they do not join the session.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database refuses a row, or fails.
    """
    insert_rows(session, Job, [{name: getattr(job, name) for name in _COLUMNS} for job in jobs])
    tags = [{"job_id": job.id, "key": tag.key, "value": tag.value} for job in jobs for tag in job.tags]
    insert_rows(session, JobTag, tags)
    accepted = {"kind": JobEventKind.ACCEPTED, "attempt": 0}
    insert_rows(session, JobEvent, [{"job_id": job.id, "at": job.created_at, **accepted} for job in jobs])


def input_hash(document: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a request document, independent of the order of fields and of the line's labels.

    Raises
    ------
    ValueError
        If the document holds NaN or an infinity.
    """
    line = {name: value for name, value in document.get("line", {}).items() if name not in LABELS}
    unlabelled = {**document, "line": line} if line else document
    return hashlib.sha256(canonical(unlabelled).encode()).hexdigest()


def canonical(document: Mapping[str, Any]) -> str:
    """Return the canonical JSON text of a document: equal documents have equal texts.

    Raises
    ------
    ValueError
        If the document holds NaN or an infinity.
    """
    return json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False)


def get(session: Session, owner: str, job_id: UUID) -> Job | None:
    """Return a job with its tags, or None if the owner has no job of that id."""
    return session.scalars(_of(owner, job_id)).one_or_none()


def look_up(sessions: sessionmaker[Session], wanted: Sequence[Owned]) -> list[Job | None]:
    """Return jobs with their tags and without their documents, None where the owner has none of that id."""
    statement = select(Job).where(tuple_(Job.owner, Job.id).in_(wanted))
    with sessions() as session:
        jobs = session.scalars(statement.options(defer(Job.document, raiseload=True)))
        found = {Owned(job.owner, job.id): job for job in jobs}
    return [found.get(key) for key in wanted]


def page(
    session: Session, owner: str, filters: JobFilters, after: tuple[datetime, UUID] | None, limit: int
) -> list[Job]:
    """Return the owner's newest jobs that match the filters, or those after the (created_at, id) of another job."""
    statement = select(Job).where(Job.owner == owner, *_conditions(filters))
    if after is not None:
        statement = statement.where(tuple_(Job.created_at, Job.id) < after)
    return list(session.scalars(statement.order_by(Job.created_at.desc(), Job.id.desc()).limit(limit)))


def cancel(session: Session, caller: Caller, job_id: UUID, *, may_remove: bool = True) -> CancelOutcome:
    """End a queued job at once, ask a running one to stop, or remove a finished one with all its rows, if it may be.

    Removing a chunk removes its lines from the batch.
    """
    _lock_batch(session, job_id)
    # Lock the row, so that no worker claims or finishes the job between the query and the change.
    job = session.scalars(_of(caller.owner, job_id).with_for_update()).one_or_none()
    if job is None:
        return CancelOutcome.MISSING
    if job.status is JobStatus.ACCEPTED:
        job.status, job.finished_at, job.result_bytes = JobStatus.DISMISSED, database_time(session), 0
        audit.record(session, caller, AuditAction.JOB_CANCELLED, job_id)
        record(session, job_id, JobEventKind.DISMISSED, attempt=job.attempt)
        counters.add_end(session, job.status, chunk=job.batch_id is not None)
        return CancelOutcome.DISMISSED
    if job.status is JobStatus.RUNNING:
        if not job.cancel_requested:
            job.cancel_requested = True
            audit.record(session, caller, AuditAction.JOB_CANCELLED, job_id)
            record(session, job_id, JobEventKind.CANCEL_REQUESTED, attempt=job.attempt)
        return CancelOutcome.REQUESTED
    if not may_remove:
        return CancelOutcome.KEPT
    if job.batch_id is not None:
        _remove_lines(session, job.batch_id, job_id)
    session.execute(delete(Job).where(Job.id == job_id))
    audit.record(session, caller, AuditAction.JOB_REMOVED, job_id)
    return CancelOutcome.REMOVED


def _lock_batch(session: Session, job_id: UUID) -> None:
    """Lock the batch of a chunk before the chunk, as what changes a whole batch does."""
    of_chunk = select(Job.batch_id).where(Job.id == job_id).scalar_subquery()
    session.execute(select(Batch.id).where(Batch.id == of_chunk).with_for_update())


def _remove_lines(session: Session, batch_id: UUID, chunk_id: UUID) -> None:
    lines = BatchItem.chunk_id == chunk_id
    left = Batch.request_bytes - stored_bytes.of_lines(session, lines)
    session.execute(update(Batch).where(Batch.id == batch_id).values(request_bytes=left))
    session.execute(delete(BatchItem).where(lines))


def relabel(session: Session, caller: Caller, job: Job, tags: Mapping[str, str], **names: str | None) -> None:
    """Give a job other tags, and those of another name and asset_id that are given."""
    for name, value in names.items():
        setattr(job, name, value)
    session.execute(delete(JobTag).where(JobTag.job_id == job.id))
    insert_rows(session, JobTag, [{"job_id": job.id, "key": key, "value": value} for key, value in tags.items()])
    audit.record(session, caller, AuditAction.JOB_RELABELLED, job.id)


def record(session: Session, job_id: UUID, kind: JobEventKind, *, attempt: int = 0, detail: str | None = None) -> None:
    """Add an event to a job's history, in the transaction in which it happens."""
    session.add(JobEvent(job_id=job_id, at=database_time(session), kind=kind, attempt=attempt, detail=detail))


def _of(owner: str, job_id: UUID) -> Select[Job]:
    return select(Job).where(Job.id == job_id, Job.owner == owner)


def _conditions(filters: JobFilters) -> list[ColumnElement[bool]]:
    conditions = [Job.batch_id.is_(None) if filters.batch_id is None else Job.batch_id == filters.batch_id]
    if filters.status is not None:
        conditions.append(Job.status == filters.status)
    if filters.asset_id is not None:
        conditions.append(Job.asset_id.in_(written_forms(filters.asset_id)))
    if filters.created_after is not None:
        conditions.append(Job.created_at > filters.created_after)
    if filters.created_before is not None:
        conditions.append(Job.created_at < filters.created_before)
    if filters.statuses:
        conditions.append(Job.status.in_(filters.statuses))
    seconds = extract("epoch", func.coalesce(Job.finished_at, func.now())) - extract("epoch", Job.started_at)
    if filters.shortest_seconds is not None:
        conditions.append(seconds >= filters.shortest_seconds)
    if filters.longest_seconds is not None:
        conditions.append(seconds <= filters.longest_seconds)
    for key, value in filters.tags.items():
        tagged = select(JobTag.job_id).where(JobTag.key.in_(written_forms(key)))
        if value is not None:
            tagged = tagged.where(JobTag.value.in_(written_forms(value)))
        conditions.append(Job.id.in_(tagged))
    return conditions
