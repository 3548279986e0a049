"""The states of watched jobs and batches. The query names the owner of each, so that another's is missing."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from uuid import UUID

from sqlalchemy import select, tuple_
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import batch_progress
from app.jobs.batch_progress import Counts
from app.security.caller import Owned
from app.tables import ENDED, Batch, Job, JobEvent, JobEventKind, JobStatus


@dataclass(frozen=True, slots=True)
class Happening:
    """One event in a job's history."""

    id: int
    at: datetime
    kind: JobEventKind
    attempt: int
    detail: str | None


@dataclass(frozen=True, slots=True)
class JobSeen:
    """The state of a job and its events so far."""

    status: JobStatus
    attempt: int
    cancel_requested: bool
    progress: float
    step: str
    events: tuple[Happening, ...] = ()

    @property
    def ended(self) -> bool:
        """Tell whether the state is final."""
        return self.status in ENDED


@dataclass(frozen=True, slots=True)
class BatchSeen:
    """The state of a batch."""

    rejected_lines: int
    counts: Counts

    @property
    def ended(self) -> bool:
        """Tell whether no line waits or runs; failed lines may still be resubmitted."""
        return self.counts.status in ENDED


def jobs_seen(readers: sessionmaker[Session], before: Mapping[Owned, JobSeen | None]) -> dict[Owned, JobSeen]:
    """Return the states of jobs; the events are read only of those that have changed otherwise."""
    columns = Job.owner, Job.id, Job.status, Job.attempt, Job.cancel_requested, Job.progress, Job.step
    with readers() as session:
        rows = session.execute(select(*columns).where(tuple_(Job.owner, Job.id).in_(before)))
        found = {Owned(*row[:2]): JobSeen(*row[2:]) for row in rows}
        events = _events(session, [key.id for key, job in found.items() if _stage(job) != _stage(before[key])])
    return {key: replace(job, events=_of(before[key], events.get(key.id))) for key, job in found.items()}


def batches_seen(readers: sessionmaker[Session], before: Mapping[Owned, BatchSeen | None]) -> dict[Owned, BatchSeen]:
    """Return the states of batches that are wholly received."""
    wanted = select(Batch.owner, Batch.id, Batch.rejected_lines).where(Batch.received_at.is_not(None))
    with readers() as session:
        rows = session.execute(wanted.where(tuple_(Batch.owner, Batch.id).in_(before))).all()
        counts = batch_progress.counts(session, [row.id for row in rows])
    return {Owned(row.owner, row.id): BatchSeen(row.rejected_lines, counts[row.id]) for row in rows}


def _stage(job: JobSeen | None) -> tuple[object, ...]:
    return () if job is None else (job.status, job.attempt, job.cancel_requested)


def _of(before: JobSeen | None, events: tuple[Happening, ...] | None) -> tuple[Happening, ...]:
    """Return a job's events as just read, otherwise the earlier ones."""
    return events if events is not None else before.events if before is not None else ()


def _events(session: Session, job_ids: Collection[UUID]) -> dict[UUID, tuple[Happening, ...]]:
    columns = JobEvent.job_id, JobEvent.id, JobEvent.at, JobEvent.kind, JobEvent.attempt, JobEvent.detail
    statement = select(*columns).where(JobEvent.job_id.in_(job_ids)).order_by(JobEvent.id)
    found: dict[UUID, list[Happening]] = {}
    for row in session.execute(statement) if job_ids else ():
        found.setdefault(row[0], []).append(Happening(*row[1:]))
    return {job_id: tuple(happenings) for job_id, happenings in found.items()}
