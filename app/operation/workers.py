"""The list of workers, which they keep themselves. The caller commits the transaction."""

from collections.abc import Sequence
from datetime import timedelta

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from app.convert import ENGINE_VERSION
from app.runtime.settings import Settings
from app.storage.database import database_time
from app.storage.steady_clock import steady_time
from app.tables import Worker

_FORGOTTEN_AFTER = timedelta(hours=1)


def report(session: Session, settings: Settings, name: str) -> None:
    """Record that a worker is alive, and forget workers that have long been silent."""
    now = steady_time(session)
    worker = session.get(Worker, name)
    if worker is None:
        started_at = database_time(session)
        worker = Worker(name=name, started_at=started_at, processes=settings.worker_processes, version=ENGINE_VERSION)
        session.add(worker)
    worker.seen_at = now
    session.execute(delete(Worker).where(Worker.seen_at < now - _FORGOTTEN_AFTER))


def leave(session: Session, name: str) -> None:
    """Record that a worker has ended."""
    session.execute(delete(Worker).where(Worker.name == name))


def listed(session: Session) -> Sequence[Worker]:
    """Return the workers that reported within the last hour and have not ended, in the order of their start."""
    return session.scalars(select(Worker).order_by(Worker.started_at, Worker.name)).all()


def report_seconds(settings: Settings) -> float:
    """Return the time between two reports; a worker that misses two of them counts as silent."""
    return settings.lease_seconds / 2.0
