"""The workers that are there, as they say themselves. The caller commits the transaction."""

from collections.abc import Sequence
from datetime import timedelta

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from app.convert import ENGINE_VERSION
from app.runtime.settings import Settings
from app.storage.database import database_time
from app.tables import Worker

_FORGOTTEN_AFTER = timedelta(hours=1)


def report(session: Session, settings: Settings, name: str) -> None:
    """Say that a worker is there, and forget those that have been silent for long."""
    now = database_time(session)
    worker = session.get(Worker, name)
    if worker is None:
        worker = Worker(name=name, started_at=now, processes=settings.worker_processes, version=ENGINE_VERSION)
        session.add(worker)
    worker.seen_at = now
    session.execute(delete(Worker).where(Worker.seen_at < now - _FORGOTTEN_AFTER))


def leave(session: Session, name: str) -> None:
    """Say that a worker has ended."""
    session.execute(delete(Worker).where(Worker.name == name))


def listed(session: Session) -> Sequence[Worker]:
    """Return all workers of the last hour that have not said that they ended, in the order of their start."""
    return session.scalars(select(Worker).order_by(Worker.started_at, Worker.name)).all()


def report_seconds(settings: Settings) -> float:
    """Return the time between two reports; a worker that has missed two of them counts as silent."""
    return settings.lease_seconds / 2.0
