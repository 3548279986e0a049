"""Jobs from the worker's side: claim under a lease, keep alive, finish once. The caller commits the transaction.

A chunk of a batch is a job whose points are lines.

Every change by a worker is guarded by its attempt number. Once a job is released and claimed again, writes of the
earlier worker match no row, and its results are dropped.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from enum import StrEnum
from typing import TYPE_CHECKING, Any
from uuid import UUID

from sqlalchemy import ColumnElement, CursorResult, and_, false, func, or_, select, update
from sqlalchemy.orm import InstrumentedAttribute, Session

from app.jobs import turns
from app.jobs.job_records import record
from app.runtime.correlation import Ids
from app.runtime.settings import Settings
from app.storage import counters, stored_bytes, stored_results
from app.storage.counters import CounterName
from app.storage.database import database_moment, database_time
from app.storage.steady_clock import last_reading, steady_time
from app.tables import FailureKind, Job, JobEventKind, JobStatus

if TYPE_CHECKING:
    from app.convert import PointResult

_JOBS_A_SWEEP = 200


class Beat(StrEnum):
    """The answer to a heartbeat: go on, stop for a requested cancel, or stop because another worker has the job."""

    GO_ON = "go_on"
    CANCEL = "cancel"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class Claim:
    """The right to work on a job: the attempt number fences off earlier workers, and the ids go into the logs."""

    job_id: UUID
    attempt: int
    document: dict[str, Any]
    batch_id: UUID | None = None
    ids: Ids = field(default_factory=Ids)
    claimed_at: datetime | None = None
    owner: str = ""


@dataclass(frozen=True, slots=True)
class Failure:
    """Why a job failed: the kind, and a sentence for its owner."""

    kind: FailureKind
    detail: str


def claim(session: Session, job_id: UUID, owner: str, lease_seconds: float) -> Claim | None:
    """Claim an accepted job by compare-and-set; None if it is running, ended or gone, as after a repeated message."""
    steady, now = steady_time(session), database_time(session)
    statement = (
        update(Job)
        .where(Job.id == job_id, Job.status == JobStatus.ACCEPTED)
        .values(
            status=JobStatus.RUNNING,
            attempt=Job.attempt + 1,
            started_at=now,
            progress=0.0,
            step="",
            lease_owner=owner,
            lease_expires_at=steady + timedelta(seconds=lease_seconds),
            claimed_at=steady,
            dispatched_at=func.coalesce(Job.dispatched_at, now),
        )
        .returning(Job.attempt, Job.document, Job.batch_id, Job.owner, Job.request_id, Job.trace_parent)
        .execution_options(synchronize_session=False)
    )
    taken = session.execute(statement).one_or_none()
    if taken is None:
        return None
    record(session, job_id, JobEventKind.RUNNING, attempt=taken.attempt, detail=owner)
    ids = Ids(taken.request_id, taken.trace_parent, str(job_id), taken.attempt)
    return Claim(job_id, taken.attempt, taken.document, taken.batch_id, ids, steady, taken.owner)


def heartbeat(session: Session, held: Claim, lease_seconds: float, progress: float, step: str) -> Beat:
    """Renew the lease, store the progress, and tell whether to go on."""
    end = steady_time(session) + timedelta(seconds=lease_seconds)
    statement = (
        update(Job)
        .where(*_guard(held))
        .values(lease_expires_at=end, progress=progress, step=step)
        .returning(Job.cancel_requested)
        .execution_options(synchronize_session=False)
    )
    cancel_requested = session.execute(statement).scalar_one_or_none()
    if cancel_requested is None:
        return Beat.LOST
    return Beat.CANCEL if cancel_requested else Beat.GO_ON


def finish(session: Session, held: Claim, points: Sequence["PointResult"]) -> bool:
    """Store the results and end the job as successful; return False and store nothing if another worker has the job."""
    version = points[-1].engine_version if points else None
    return _end(session, held, points, {"status": JobStatus.SUCCESSFUL, "progress": 1.0, "engine_version": version})


def fail(session: Session, held: Claim, failure: Failure, points: Sequence["PointResult"] = ()) -> bool:
    """End the job as failed and keep its finished points; return False and store nothing if another worker has it."""
    version = points[-1].engine_version if points else None
    return _end(session, held, points, {**_failed(failure), "engine_version": version}, failure.detail)


def dismiss(session: Session, held: Claim) -> bool:
    """End a running job whose cancel was requested; return False if another worker has the job."""
    return _end(session, held, (), {"status": JobStatus.DISMISSED})


def release_expired(session: Session, settings: Settings, owner: str | None = None) -> int:
    """Release jobs whose lease expired, or all jobs of an owner that is known to be dead; return their number.

    A released job returns to the queue until its attempts are used up; then it fails because its workers were lost. A
    job with a requested cancel is dismissed, and one that exceeded the hard time limit fails for that reason.
    """
    lost = Job.lease_owner == owner if owner else Job.lease_expires_at <= last_reading(session)
    statement = select(Job).where(Job.status == JobStatus.RUNNING, lost).limit(_JOBS_A_SWEEP)
    released = list(session.scalars(statement.with_for_update(skip_locked=True, of=Job)))
    for job in released:
        _release(session, job, settings)
    if released:
        counters.add(session, CounterName.LEASES, "returned" if owner else "expired", count=len(released))
    return len(released)


def shorten(session: Session, lease_seconds: float) -> None:
    """End each lease in `lease_seconds` at the latest, since some were given by a clock that was ahead for a moment.

    A worker that lives renews its lease with its next heartbeat.
    """
    end = steady_time(session) + timedelta(seconds=lease_seconds)
    statement = update(Job).where(Job.status == JobStatus.RUNNING, Job.lease_expires_at > end)
    session.execute(statement.values(lease_expires_at=end).execution_options(synchronize_session=False))


def postpone(session: Session, by: timedelta) -> None:
    """Move all running leases by a time in which no sweeper ran.

    It may only be a step of the clock, and then living workers renew their leases.
    """
    for job in session.scalars(select(Job).where(Job.status == JobStatus.RUNNING).with_for_update(of=Job)):
        job.lease_expires_at = job.lease_expires_at and job.lease_expires_at + by
        job.claimed_at = job.claimed_at and job.claimed_at + by


def holds_jobs(session: Session, owner: str) -> bool:
    """Tell whether a worker has running jobs."""
    held = select(Job.id).where(Job.status == JobStatus.RUNNING, Job.lease_owner == owner)
    return session.execute(held.limit(1)).first() is not None


def take_undispatched(
    session: Session, settings: Settings, *, queue_is_empty: bool, chunks: bool = False
) -> list[UUID]:
    """Mark jobs, or chunks, that need a message as dispatched, and return their ids to send after the commit.

    The oldest come first. They are jobs never sent (after a short grace for the process that created them), released
    jobs, and jobs whose message must be lost: sent a while ago, still unclaimed, and the queue is empty.
    """
    now = database_time(session)
    never_sent = and_(
        Job.dispatched_at.is_(None),
        or_(Job.attempt > 0, _is_far(Job.created_at, now, settings.sweep_seconds)),
    )
    overdue = _is_far(Job.dispatched_at, now, settings.redispatch_seconds)
    wanted = or_(never_sent, overdue if queue_is_empty else false())
    if most_running := settings.running_jobs_per_owner:
        wanted = and_(wanted, Job.owner.not_in(turns.having(most_running)))  # a message would run nothing
    of_batch = Job.batch_id.is_not(None) if chunks else Job.batch_id.is_(None)
    statement = select(Job.id).where(Job.status == JobStatus.ACCEPTED, of_batch, wanted)
    oldest = statement.order_by(Job.created_at, Job.id)
    found = list(session.scalars(oldest.limit(_JOBS_A_SWEEP).with_for_update(skip_locked=True)))
    _set_dispatched(session, found, now)
    return found


def mark_dispatched(session: Session, job_ids: Sequence[UUID]) -> None:
    """Record that the broker has the messages of these jobs."""
    _set_dispatched(session, job_ids, database_moment(session))


def mark_undispatched(session: Session, job_ids: Sequence[UUID]) -> None:
    """Record that the messages of these jobs could not be sent, for the next sweep."""
    _set_dispatched(session, job_ids, None)


def _set_dispatched(
    session: Session, job_ids: Sequence[UUID], moment: datetime | ColumnElement[datetime] | None
) -> None:
    statement = update(Job).where(Job.id.in_(job_ids), Job.status == JobStatus.ACCEPTED).values(dispatched_at=moment)
    session.execute(statement.execution_options(synchronize_session=False))


def _is_far(moment: InstrumentedAttribute[Any], now: datetime, seconds: float) -> ColumnElement[bool]:
    """Tell whether a moment is long past, or so far ahead that the clock was set back since."""
    length = timedelta(seconds=seconds)
    return or_(moment <= now - length, moment >= now + length)


def time_limit_sentence(settings: Settings) -> str:
    """Return the sentence that names the time limit."""
    return f"The job ran longer than the limit of {settings.soft_time_limit_seconds:g} s."


def _guard(held: Claim) -> Iterator[ColumnElement[bool]]:
    yield Job.id == held.job_id
    yield Job.attempt == held.attempt
    yield Job.status == JobStatus.RUNNING


def _failed(failure: Failure) -> dict[str, Any]:
    return {"status": JobStatus.FAILED, "failure_kind": failure.kind, "failure_detail": failure.detail}


def _end(
    session: Session,
    held: Claim,
    points: Sequence["PointResult"],
    changes: dict[str, Any],
    detail: str | None = None,
) -> bool:
    if changes["status"] is not JobStatus.DISMISSED:
        changes["failed_lines"] = Job.lines - sum(
            point.failure is None for point in points
        )  # null unless it is a chunk
        changes["reused_lines"] = sum(point.reused for point in points) if held.batch_id is not None else None
    steady, now, rows = steady_time(session), database_time(session), stored_results.rows_of(points)
    over = {"finished_at": now, "lease_owner": None, "lease_expires_at": None, "step": ""}
    changes["result_bytes"] = stored_bytes.of_points(rows)
    statement = update(Job).where(*_guard(held)).values(**over, **changes)
    ended = session.execute(statement.execution_options(synchronize_session=False))
    if not isinstance(ended, CursorResult) or ended.rowcount != 1:
        return False
    stored_results.store(session, held.job_id, rows, held.batch_id)
    record(session, held.job_id, JobEventKind(changes["status"].value), attempt=held.attempt, detail=detail)
    _count_end(session, held, changes, steady)
    return True


def _count_end(session: Session, held: Claim, changes: dict[str, Any], now: datetime) -> None:
    seconds = max(0.0, (now - (held.claimed_at or now)).total_seconds())
    chunk = held.batch_id is not None
    counters.add_end(session, changes["status"], changes.get("failure_kind"), chunk=chunk, seconds=seconds)


def _release(session: Session, job: Job, settings: Settings) -> None:
    """Release one locked job."""
    kind, failure = _verdict(job, settings)
    job.lease_owner = job.lease_expires_at = None
    job.step = ""
    if kind is JobEventKind.RELEASED:
        job.status, job.dispatched_at, job.started_at, job.progress = JobStatus.ACCEPTED, None, None, 0.0
    else:
        job.status, job.finished_at, job.result_bytes = JobStatus(kind.value), database_time(session), 0
        counters.add_end(session, job.status, failure.kind if failure else None, chunk=job.batch_id is not None)
    if failure is not None:
        job.failure_kind, job.failure_detail, job.failed_lines = failure.kind, failure.detail, job.lines
    detail = failure.detail if failure else None
    record(session, job.id, kind, attempt=job.attempt, detail=detail)


def _verdict(job: Job, settings: Settings) -> tuple[JobEventKind, Failure | None]:
    limit = timedelta(seconds=settings.hard_time_limit_seconds)
    if job.cancel_requested:
        return JobEventKind.DISMISSED, None
    # The worker lived no longer than its lease; what follows is time in which the service may have been off.
    if job.claimed_at and job.lease_expires_at and job.claimed_at + limit <= job.lease_expires_at:
        return JobEventKind.FAILED, Failure(FailureKind.TIME_LIMIT, time_limit_sentence(settings))
    if job.attempt >= settings.max_attempts:
        sentence = f"The service gave up the job because its worker was lost in each of {job.attempt} attempts."
        return JobEventKind.FAILED, Failure(FailureKind.WORKER_LOST, sentence)
    return JobEventKind.RELEASED, None
