"""What API and worker do with a job, done in this process: sent to the broker, and worked off by the real engine."""

from uuid import UUID

from app.jobs.dispatch import Sender, celery_application
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.tables import Job, JobStatus
from worker.execute import execute

_MOST_TURNS = 100


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
    """Claim, compute and end a job as a worker of this name does, and jobs of other owners whose turn comes before."""
    engine = make_engine(settings)
    sessions = session_factory(engine)
    try:
        for _ in range(_MOST_TURNS):
            execute(sessions, settings, job_id, owner)
            with sessions() as session:
                job = session.get(Job, job_id)
            if job is None or job.status is not JobStatus.ACCEPTED:
                return
    finally:
        engine.dispose()
