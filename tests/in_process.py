"""What API and worker do with a job, done in this process: sent to the broker, and worked off by the real engine."""

from uuid import UUID

from app.jobs.dispatch import Sender, celery_application
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from worker.execute import execute


def send(settings: Settings, *job_ids: UUID, chunk: bool = False) -> bool:
    """Send committed jobs, or chunks of a batch, as the API does; tell whether they are with the broker and marked."""
    engine = make_engine(settings)
    sender = Sender(celery_application(settings), session_factory(engine))
    try:
        return sender.send(job_ids, chunk=chunk)
    finally:
        sender.close()
        engine.dispose()


def run_job(settings: Settings, job_id: UUID, owner: str = "test") -> None:
    """Claim, compute and end a job as a worker of this name does."""
    engine = make_engine(settings)
    try:
        execute(session_factory(engine), settings, job_id, owner)
    finally:
        engine.dispose()
