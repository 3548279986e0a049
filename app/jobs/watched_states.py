"""What a look at watched jobs and batches sees."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from uuid import UUID

from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import batch_progress
from app.jobs.batch_progress import Counts
from app.tables import ENDED, Batch, Job, JobEvent, JobEventKind, JobStatus


@dataclass(frozen=True, slots=True)
class Happening:
    """One thing that happened to a job."""

    id: int
    at: datetime
    kind: JobEventKind
    attempt: int
    detail: str | None


@dataclass(frozen=True, slots=True)
class JobSeen:
    """A job as it is, and everything that has happened to it."""

    owner: str
    status: JobStatus
    attempt: int
    cancel_requested: bool
    progress: float
    step: str
    events: tuple[Happening, ...] = ()

    @property
    def ended(self) -> bool:
        """Tell whether nothing will happen to it any more."""
        return self.status in ENDED


@dataclass(frozen=True, slots=True)
class BatchSeen:
    """A batch as it is."""

    owner: str
    rejected_lines: int
    counts: Counts

    @property
    def ended(self) -> bool:
        """Tell whether nothing runs or waits; failed lines may be resubmitted."""
        return self.counts.status in ENDED


def jobs_seen(readers: sessionmaker[Session], before: Mapping[UUID, JobSeen | None]) -> dict[UUID, JobSeen]:
    """Look at jobs; the events are read only of those that have changed otherwise."""
    columns = Job.id, Job.owner, Job.status, Job.attempt, Job.cancel_requested, Job.progress, Job.step
    with readers() as session:
        rows = session.execute(select(*columns).where(Job.id.in_(before)))
        found = {row[0]: JobSeen(*row[1:]) for row in rows}
        events = _events(session, [job_id for job_id, job in found.items() if _stage(job) != _stage(before[job_id])])
    return {job_id: replace(job, events=_of(before[job_id], events.get(job_id))) for job_id, job in found.items()}


def batches_seen(readers: sessionmaker[Session], before: Mapping[UUID, BatchSeen | None]) -> dict[UUID, BatchSeen]:
    """Look at batches that have come in whole."""
    wanted = select(Batch.id, Batch.owner, Batch.rejected_lines)
    with readers() as session:
        rows = session.execute(wanted.where(Batch.id.in_(before), Batch.received_at.is_not(None))).all()
        counts = batch_progress.counts(session, [row.id for row in rows])
    return {row.id: BatchSeen(row.owner, row.rejected_lines, counts[row.id]) for row in rows}


def _stage(job: JobSeen | None) -> tuple[object, ...]:
    return () if job is None else (job.status, job.attempt, job.cancel_requested)


def _of(before: JobSeen | None, events: tuple[Happening, ...] | None) -> tuple[Happening, ...]:
    """Return the events of a job as they were read, else those from before."""
    return events if events is not None else before.events if before is not None else ()


def _events(session: Session, job_ids: Collection[UUID]) -> dict[UUID, tuple[Happening, ...]]:
    columns = JobEvent.job_id, JobEvent.id, JobEvent.at, JobEvent.kind, JobEvent.attempt, JobEvent.detail
    statement = select(*columns).where(JobEvent.job_id.in_(job_ids)).order_by(JobEvent.id)
    found: dict[UUID, list[Happening]] = {}
    for row in session.execute(statement) if job_ids else ():
        found.setdefault(row[0], []).append(Happening(*row[1:]))
    return {job_id: tuple(happenings) for job_id, happenings in found.items()}
