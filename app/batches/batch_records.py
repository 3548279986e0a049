"""Batches from their owner's side: receive in parts, list, cancel, resubmit.

Workers compute a batch in chunks, and each chunk is a job. The state of a line follows from its chunk and its result,
and is stored nowhere else. The caller commits the transaction.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any
from uuid import UUID

from sqlalchemy import ColumnElement, Select, and_, delete, func, insert, select, tuple_, update
from sqlalchemy.orm import Session
from uuid_utils.compat import uuid7

from app.convert import NumberedLine, expected_bytes
from app.jobs import batch_progress, owner_quotas
from app.jobs.job_records import CancelOutcome, input_hash
from app.jobs.owner_quotas import Amount, Quotas
from app.runtime import correlation
from app.security import audit
from app.security.caller import Caller
from app.storage import counters, stored_bytes
from app.storage.database import database_time, insert_rows
from app.tables import AuditAction, Batch, BatchItem, Job, JobEvent, JobEventKind, JobStatus, PointRow

_ABANDONED = timedelta(hours=6)


@dataclass(frozen=True, slots=True)
class Chunk:
    """The lines of a batch in one message: which part of it, their number, and the bytes that each may leave."""

    id: UUID
    part: int
    lines: int
    line_bytes: int = 0


def begin(session: Session, caller: Caller, analysis: dict[str, Any]) -> UUID:
    """Add a batch that stays invisible until `accept` is called, and return its id."""
    batch = Batch(id=uuid7(), owner=caller.owner, created_at=database_time(session), analysis=analysis)
    batch.request_bytes = stored_bytes.of_request(analysis)
    session.add(batch)
    session.flush()
    return batch.id


def add_items(session: Session, items: Sequence[dict[str, Any]]) -> None:
    """Add lines of one batch in the order of their numbers, each a mapping with the columns of `BatchItem`."""
    if not items:
        return
    insert_rows(session, BatchItem, items)
    batch_id, first, last = items[0]["batch_id"], items[0]["number"], items[-1]["number"]
    added = BatchItem.batch_id == batch_id, BatchItem.number.between(first, last)
    size = Batch.request_bytes + stored_bytes.of_lines(session, *added)
    session.execute(update(Batch).where(Batch.id == batch_id).values(request_bytes=size))


def accept(
    session: Session,
    caller: Caller,
    batch_id: UUID,
    chunks: Sequence[Chunk],
    rejected_lines: int,
    *,
    anew: bool = False,
) -> None:
    """Make a batch visible whose lines are all stored, and queue its chunks for workers.

    With `anew`, workers compute the lines even if their results are stored.
    """
    now = database_time(session)
    received = update(Batch).where(Batch.id == batch_id).values(received_at=now, rejected_lines=rejected_lines)
    session.execute(received)
    _add_chunks(session, caller, batch_id, chunks, now, anew=anew)
    lines = sum(chunk.lines for chunk in chunks)
    audit.record(session, caller, AuditAction.BATCH_SUBMITTED, batch_id, f"{lines} lines", at=now)


def require_room(session: Session, caller: Caller, chunks: Sequence[Chunk], allowed: Quotas) -> None:
    """Check that the owner may have so many more chunks waiting, and what they and their lines may leave.

    Raises
    ------
    OverQuota
        If the owner may not.
    """
    size = sum(stored_bytes.ROW_BYTES + chunk.lines * chunk.line_bytes for chunk in chunks)
    allowed.require(session, caller.owner, Amount(len(chunks), size))


def note(session: Session, batch_id: UUID, notes: Sequence[str]) -> None:
    """Store sentences on how the body of a batch was read."""
    if notes:
        session.execute(update(Batch).where(Batch.id == batch_id).values(notes=list(notes)))


def discard(session: Session, batch_id: UUID) -> None:
    """Remove a batch that was not accepted, with its lines."""
    session.execute(delete(Batch).where(Batch.id == batch_id))


def discard_abandoned(session: Session) -> int:
    """Remove batches whose receiving process died hours ago, and return their number."""
    abandoned = Batch.created_at < database_time(session) - _ABANDONED
    statement = delete(Batch).where(Batch.received_at.is_(None), abandoned).returning(Batch.id)
    return len(session.scalars(statement).all())


def get(session: Session, owner: str, batch_id: UUID) -> Batch | None:
    """Return a completely received batch, or None if the owner has no batch of that id."""
    return session.scalars(_of(owner, batch_id)).one_or_none()


def page(
    session: Session,
    owner: str,
    after: tuple[datetime, UUID] | None,
    limit: int,
    created: tuple[datetime | None, datetime | None] = (None, None),
) -> list[Batch]:
    """Return the owner's newest batches, or those after `after`, the (created_at, id) of the last one seen.

    `created` are moments after and before which the batches were created, None for any.
    """
    statement = select(Batch).where(Batch.owner == owner, Batch.received_at.is_not(None))
    since, until = created
    if since is not None:
        statement = statement.where(Batch.created_at > since)
    if until is not None:
        statement = statement.where(Batch.created_at < until)
    if after is not None:
        statement = statement.where(tuple_(Batch.created_at, Batch.id) < after)
    return list(session.scalars(statement.order_by(Batch.created_at.desc(), Batch.id.desc()).limit(limit)))


def outcome(session: Session, batch_id: UUID) -> str:
    """Return a fingerprint of a finished batch, for its ETag."""
    columns = Job.id, Job.status, Job.engine_version, Job.finished_at, Job.lines, Job.failed_lines
    statement = select(*columns).where(Job.batch_id == batch_id).order_by(Job.id)
    return hashlib.sha256(repr(session.execute(statement).all()).encode()).hexdigest()


def relabel(session: Session, caller: Caller, batch: Batch, name: str | None, tags: dict[str, str]) -> None:
    """Give a batch another name and other tags."""
    batch.name, batch.tags = name, tags or None
    audit.record(session, caller, AuditAction.BATCH_RELABELLED, batch.id)


def cancel(session: Session, caller: Caller, batch_id: UUID, *, may_remove: bool = True) -> CancelOutcome:
    """End queued chunks at once and ask running ones to stop; remove a finished batch, if it may be."""
    if _locked(session, caller.owner, batch_id) is None:
        return CancelOutcome.MISSING
    before = batch_progress.counts(session, [batch_id])[batch_id]
    if not before.accepted + before.running and not may_remove:
        return CancelOutcome.KEPT
    if not before.accepted + before.running:
        session.execute(delete(Job).where(Job.batch_id == batch_id))
        session.execute(delete(Batch).where(Batch.id == batch_id))
        audit.record(session, caller, AuditAction.BATCH_REMOVED, batch_id)
        return CancelOutcome.REMOVED
    # Lock the chunks first, so that none changes state between the two updates.
    still_open = Job.batch_id == batch_id, Job.status.in_((JobStatus.ACCEPTED, JobStatus.RUNNING))
    session.execute(select(Job.id).where(*still_open).order_by(Job.id).with_for_update())
    _dismiss_waiting(session, batch_id)
    running = _ask_running(session, batch_id)
    audit.record(session, caller, AuditAction.BATCH_CANCELLED, batch_id)
    return CancelOutcome.REQUESTED if running else CancelOutcome.DISMISSED


def resubmit(
    session: Session, caller: Caller, batch_id: UUID, chunk_lines: int, allowed: Quotas = owner_quotas.NONE
) -> list[UUID]:
    """Put the failed lines into new chunks, and return the ids of these; empty if no line failed.

    The lines keep their numbers. The results of all other lines stay untouched.

    Raises
    ------
    OverQuota
        If the owner may not have so many more chunks waiting, or their results.
    """
    batch = _locked(session, caller.owner, batch_id)
    numbers = [] if batch is None else _failed_numbers(session, batch_id)
    if batch is None or not numbers:
        return []
    line_bytes = expected_bytes({"analysis": batch.analysis})
    for job in session.scalars(select(Job).where(*_has_failures(batch_id))).all():
        job.lines, job.failed_lines = (job.lines or 0) - (job.failed_lines or 0), 0
    session.flush()
    parts = session.scalar(select(func.count()).select_from(Job).where(Job.batch_id == batch_id)) or 0
    chunks: list[Chunk] = []
    for first in range(0, len(numbers), chunk_lines):
        moved = numbers[first : first + chunk_lines]
        chunks.append(Chunk(uuid7(), parts + len(chunks) + 1, len(moved), line_bytes))
        belongs = BatchItem.batch_id == batch_id, BatchItem.number.in_(moved)
        session.execute(update(BatchItem).where(*belongs).values(chunk_id=chunks[-1].id))
    require_room(session, caller, chunks, allowed)
    _add_chunks(session, caller, batch_id, chunks, database_time(session))
    audit.record(session, caller, AuditAction.BATCH_RESUBMITTED, batch_id, f"{len(numbers)} lines")
    return [chunk.id for chunk in chunks]


def lines_of_chunk(session: Session, job_id: UUID, batch_id: UUID) -> tuple[dict[str, Any], list[NumberedLine]]:
    """Return the analysis of the batch and the numbered lines of a chunk, for a worker."""
    analysis = session.scalars(select(Batch.analysis).where(Batch.id == batch_id)).one()
    statement = select(BatchItem.number, BatchItem.document, BatchItem.known).where(BatchItem.chunk_id == job_id)
    rows = session.execute(statement.order_by(BatchItem.number))
    return analysis, [NumberedLine(number, document or {}, known) for number, document, known in rows]


def chunk_of_line(session: Session, batch_id: UUID, number: int) -> UUID | None:
    """Return the id of the chunk that computes a line, None if there is no such line or it was rejected."""
    mine = BatchItem.batch_id == batch_id, BatchItem.number == number
    return session.scalars(select(BatchItem.chunk_id).where(*mine)).one_or_none()


def _of(owner: str, batch_id: UUID) -> Select[Batch]:
    return select(Batch).where(Batch.id == batch_id, Batch.owner == owner, Batch.received_at.is_not(None))


def _locked(session: Session, owner: str, batch_id: UUID) -> Batch | None:
    """Return a batch with its row locked, so that two changes of the whole batch wait for each other."""
    return session.scalars(_of(owner, batch_id).with_for_update()).one_or_none()


def _has_failures(batch_id: UUID) -> tuple[ColumnElement[bool], ...]:
    ended = Job.status.in_((JobStatus.SUCCESSFUL, JobStatus.FAILED))
    return Job.batch_id == batch_id, ended, Job.failed_lines > 0


def _failed_numbers(session: Session, batch_id: UUID) -> list[int]:
    """Return the numbers of the lines that have no result although their chunk has ended."""
    solved = and_(PointRow.job_id == BatchItem.chunk_id, PointRow.point == BatchItem.number, PointRow.failure.is_(None))
    statement = (
        select(BatchItem.number)
        .join(Job, Job.id == BatchItem.chunk_id)
        .outerjoin(PointRow, solved)
        .where(BatchItem.batch_id == batch_id, *_has_failures(batch_id), PointRow.job_id.is_(None))
    )
    return list(session.scalars(statement.order_by(BatchItem.number)))


def _add_chunks(
    session: Session, caller: Caller, batch_id: UUID, chunks: Sequence[Chunk], now: datetime, *, anew: bool = False
) -> None:
    if not chunks:
        return
    session.add_all(_as_job(caller, batch_id, chunk, now, anew=anew) for chunk in chunks)
    session.flush()
    events = [{"job_id": c.id, "at": now, "kind": JobEventKind.ACCEPTED, "attempt": 0} for c in chunks]
    session.execute(insert(JobEvent), events)


def _as_job(caller: Caller, batch_id: UUID, chunk: Chunk, now: datetime, *, anew: bool) -> Job:
    document = {"batch_id": str(batch_id), "part": chunk.part, **({"anew": True} if anew else {})}
    return Job(
        id=chunk.id,
        owner=caller.owner,
        created_at=now,
        status=JobStatus.ACCEPTED,
        batch_id=batch_id,
        document=document,
        input_hash=input_hash(document),
        request_id=correlation.request_id(),
        trace_parent=correlation.trace_parent(),
        lines=chunk.lines,
        request_bytes=stored_bytes.of_request(document),
        result_bytes=chunk.lines * chunk.line_bytes,
    )


def _dismiss_waiting(session: Session, batch_id: UUID) -> None:
    now = database_time(session)
    waiting = Job.batch_id == batch_id, Job.status == JobStatus.ACCEPTED
    statement = update(Job).where(*waiting).values(status=JobStatus.DISMISSED, finished_at=now, result_bytes=0)
    dismissed = session.execute(statement.returning(Job.id, Job.attempt)).all()
    _record(session, dismissed, JobEventKind.DISMISSED, now)
    counters.add_end(session, JobStatus.DISMISSED, chunk=True, count=len(dismissed))


def _ask_running(session: Session, batch_id: UUID) -> bool:
    """Ask the running chunks to stop; tell whether there are any, asked now or before."""
    now = database_time(session)
    running = Job.batch_id == batch_id, Job.status == JobStatus.RUNNING
    statement = update(Job).where(*running, Job.cancel_requested.is_(False)).values(cancel_requested=True)
    _record(session, session.execute(statement.returning(Job.id, Job.attempt)), JobEventKind.CANCEL_REQUESTED, now)
    return session.execute(select(Job.id).where(*running).limit(1)).first() is not None


def _record(session: Session, found: Any, kind: JobEventKind, now: datetime) -> None:
    events = [{"job_id": job_id, "at": now, "kind": kind, "attempt": attempt} for job_id, attempt in found]
    if events:
        session.execute(insert(JobEvent), events)
