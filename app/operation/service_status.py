"""The status of the whole service for its operator: database, broker, workers, queues, jobs, leases."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from app.jobs.dispatch import BrokerUnavailable, open_queue
from app.jobs.owner_quotas import Standing, standings
from app.operation import workers
from app.runtime.settings import Settings
from app.storage.database import database_time, make_engine, session_factory
from app.storage.migration import schema_fault
from app.storage.steady_clock import TOLERANCE, steady_time, unnoted_step
from app.tables import Job, JobStatus

GOOD = "ok"


@dataclass(frozen=True, slots=True)
class WorkerState:
    """A worker, the number of its running jobs, and the time since its last report."""

    name: str
    version: str
    processes: int
    running: int
    seen_seconds_ago: float
    silent: bool


@dataclass(frozen=True, slots=True)
class Work:
    """Jobs, or chunks of batches: their number in each state, and how long the oldest has waited for a worker."""

    by_status: dict[JobStatus, int]
    oldest_waiting_seconds: float | None


@dataclass(frozen=True, slots=True)
class Leases:
    """Running jobs with a lease, expired leases, and waiting jobs that have no message yet."""

    held: int
    expired: int
    undispatched: int


@dataclass(frozen=True, slots=True)
class Queues:
    """The number of messages that wait for a worker."""

    jobs: int
    chunks: int


@dataclass(frozen=True, slots=True)
class Contents:
    """The part of the status that comes from the database; `owners` is what each owner has.

    `clock_went_back_seconds` is the step of the database's clock that no worker has allowed for yet, else zero.
    """

    jobs: Work
    chunks: Work
    leases: Leases
    workers: Sequence[WorkerState]
    owners: Mapping[str, Standing]
    clock_went_back_seconds: float


@dataclass(frozen=True, slots=True)
class Status:
    """The whole status; `queues` or `contents` is None if the broker or the database does not answer."""

    database: str
    broker: str
    queues: Queues | None
    contents: Contents | None

    def faults(self) -> list[str]:
        """Return a sentence for each problem that needs the operator; empty if all is well."""
        faults = [f"The {name} {state}." for name, state in self._parts() if state != GOOD]
        if self.contents is None:
            return faults
        if self.contents.clock_went_back_seconds > TOLERANCE.total_seconds():
            step = f"{self.contents.clock_went_back_seconds:.0f} s"
            faults.append(f"The database's clock has gone back by {step}, and no worker has run since.")
        if all(worker.silent for worker in self.contents.workers):
            faults.append("No worker is running.")
        faults += [
            f"The worker {w.name} has been silent for {w.seen_seconds_ago:.0f} s."
            for w in self.contents.workers
            if w.silent
        ]
        if self.contents.leases.expired:
            faults.append(f"{self.contents.leases.expired} leases have expired, and no worker has released their jobs.")
        return faults

    def _parts(self) -> tuple[tuple[str, str], ...]:
        return ("database", self.database), ("broker", self.broker)


def read_status(settings: Settings) -> Status:
    """Query the database and the broker; record which of them does not answer.

    Raises
    ------
    OSError
        If the directory of an SQLite database cannot be created.
    """
    engine = make_engine(settings)
    try:
        with engine.connect() as connection:
            database = schema_fault(connection) or GOOD
        with session_factory(engine, read_only=True)() as session:
            contents = _contents(session, settings) if database == GOOD else None
    except SQLAlchemyError:
        database, contents = "cannot be reached", None
    finally:
        engine.dispose()
    queues = _queues(settings)
    return Status(database, GOOD if queues else "cannot be reached", queues, contents)


def _queues(settings: Settings) -> Queues | None:
    try:
        with open_queue(settings) as queue:
            return Queues(queue.length(), queue.length(chunk=True))
    except BrokerUnavailable:
        return None


def _contents(session: Session, settings: Settings) -> Contents:
    now, steady = database_time(session), steady_time(session)
    return Contents(
        jobs=_work(session, now, chunks=False),
        chunks=_work(session, now, chunks=True),
        leases=_leases(session, steady),
        workers=_workers(session, settings, steady),
        owners=standings(session),
        clock_went_back_seconds=unnoted_step(session).total_seconds(),
    )


def _work(session: Session, now: datetime, *, chunks: bool) -> Work:
    kind = Job.batch_id.is_not(None) if chunks else Job.batch_id.is_(None)
    counted = select(Job.status, func.count(), func.min(Job.created_at)).where(kind).group_by(Job.status)
    found = {status: (count, oldest) for status, count, oldest in session.execute(counted)}
    _, oldest = found.get(JobStatus.ACCEPTED, (0, None))
    waiting = max(0.0, (now - oldest).total_seconds()) if oldest else None
    return Work({status: found.get(status, (0, None))[0] for status in JobStatus}, waiting)


def _leases(session: Session, now: datetime) -> Leases:
    running, waiting = Job.status == JobStatus.RUNNING, Job.status == JobStatus.ACCEPTED

    def count(*conditions: object) -> int:
        return session.scalar(select(func.count()).select_from(Job).where(*conditions)) or 0  # type: ignore[arg-type]

    return Leases(
        held=count(running),
        expired=count(running, Job.lease_expires_at <= now),
        undispatched=count(waiting, Job.dispatched_at.is_(None)),
    )


def _workers(session: Session, settings: Settings, now: datetime) -> list[WorkerState]:
    counted = select(Job.lease_owner, func.count()).where(Job.status == JobStatus.RUNNING).group_by(Job.lease_owner)
    running = {row[0]: row[1] for row in session.execute(counted)}
    patience = 2.5 * workers.report_seconds(settings)
    found = []
    for worker in workers.listed(session):
        age = (now - worker.seen_at).total_seconds()
        state = WorkerState(
            worker.name, worker.version, worker.processes, running.get(worker.name, 0), age, silent=age > patience
        )
        found.append(state)
    return found
