"""Count the lines of a batch by state, from its chunks."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from uuid import UUID

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.tables import Job, JobStatus


@dataclass(frozen=True, slots=True)
class Counts:
    """The lines of a batch by state, the share of work done, and the times of its first start and last end.

    `reused` counts the successful lines whose results were stored before.
    """

    accepted: int = 0
    running: int = 0
    successful: int = 0
    failed: int = 0
    dismissed: int = 0
    reused: int = 0
    progress: float = 0.0
    started_at: datetime | None = None
    finished_at: datetime | None = None

    @property
    def lines(self) -> int:
        """Return the number of lines, rejected ones excluded."""
        return self.accepted + self.running + self.successful + self.failed + self.dismissed

    @property
    def status(self) -> JobStatus:
        """Return the state of the batch; a finished batch is successful if any of its lines is."""
        if self.accepted + self.running:
            begun = self.accepted < self.lines
            return JobStatus.RUNNING if begun else JobStatus.ACCEPTED
        if self.dismissed:
            return JobStatus.DISMISSED
        return JobStatus.SUCCESSFUL if self.successful else JobStatus.FAILED


def counts(session: Session, batch_ids: Sequence[UUID]) -> dict[UUID, Counts]:
    """Count the lines of batches by state, from their chunks."""
    lines, failed = func.sum(func.coalesce(Job.lines, 0)), func.sum(func.coalesce(Job.failed_lines, 0))
    done = func.sum(func.coalesce(Job.lines, 0) * Job.progress)
    reused = func.sum(func.coalesce(Job.reused_lines, 0))
    moments = func.min(Job.started_at), func.max(Job.finished_at)
    statement = select(Job.batch_id, Job.status, lines, failed, reused, done, *moments).where(
        Job.batch_id.in_(batch_ids)
    )
    grouped: dict[UUID | None, list[_Group]] = {batch_id: [] for batch_id in batch_ids}
    for found in session.execute(statement.group_by(Job.batch_id, Job.status)):
        grouped[found[0]].append(_Group(*found[1:]))
    return {batch_id: _counted(grouped[batch_id]) for batch_id in batch_ids}


@dataclass(frozen=True, slots=True)
class _Group:
    """The chunks of one batch in one state."""

    status: JobStatus
    lines: int
    failed: int
    reused: int
    done: float
    started_at: datetime | None
    finished_at: datetime | None


def _counted(groups: Sequence[_Group]) -> Counts:
    by_status = {group.status: group for group in groups}
    nothing = _Group(JobStatus.ACCEPTED, 0, 0, 0, 0.0, None, None)
    ended = [by_status.get(status, nothing) for status in (JobStatus.SUCCESSFUL, JobStatus.FAILED)]
    waiting, running, dismissed = (
        by_status.get(status, nothing) for status in (JobStatus.ACCEPTED, JobStatus.RUNNING, JobStatus.DISMISSED)
    )
    whole = sum(group.lines for group in groups)
    done = sum(group.lines for group in (*ended, dismissed)) + running.done
    still_open = waiting.lines + running.lines > 0
    return Counts(
        accepted=waiting.lines,
        running=running.lines,
        successful=sum(group.lines - group.failed for group in ended),
        failed=sum(group.failed for group in ended),
        dismissed=dismissed.lines,
        reused=sum(group.reused for group in ended),
        progress=min(1.0, done / whole) if whole else 1.0,
        started_at=min((group.started_at for group in groups if group.started_at), default=None),
        finished_at=None if still_open else max((g.finished_at for g in groups if g.finished_at), default=None),
    )
