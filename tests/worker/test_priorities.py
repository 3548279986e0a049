"""One process, a long batch, and a single job after it: the job does not wait for the batch."""

from uuid import UUID, uuid4

from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.batches.batch_records import Chunk
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.tables import Job, JobStatus
from tests.documents import add_job, look, short_request
from tests.in_process import send
from tests.processes import running_worker
from tests.servers import wait_until

CHUNKS = 60
MOST_BEFORE = 4  # the one at work, the one that is fetched already, and with a folder as broker one in turn


def add_batch(sessions: sessionmaker[Session]) -> list[UUID]:
    """Make a batch whose every chunk is one line."""
    request = short_request()
    chunks = [Chunk(uuid4(), number, 1) for number in range(1, CHUNKS + 1)]
    with sessions.begin() as session:
        batch_id = batch_records.begin(session, LOCAL, request["analysis"])
        items = [
            {"batch_id": batch_id, "number": c.part, "chunk_id": c.id, "document": request["line"]} for c in chunks
        ]
        batch_records.add_items(
            session, [{**item, "reference": None, "asset_id": None, "faults": None} for item in items]
        )
        batch_records.accept(session, LOCAL, batch_id, chunks, 0, anew=True)
    return [chunk.id for chunk in chunks]


def test_a_single_job_passes_the_chunks_that_wait(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    alone = deployment.model_copy(update={"worker_processes": 1})
    assert send(alone, *add_batch(deployed), chunk=True)
    with running_worker(alone):
        wait_until(lambda: begun_after(deployed, None) >= 2, 60.0, "the first chunks")
        job_id = add_job(deployed, short_request())
        before = begun_after(deployed, None)
        assert send(alone, job_id)
        wait_until(lambda: look(deployed, job_id).status is JobStatus.SUCCESSFUL, 60.0, "the end of the job")
        assert begun_after(deployed, job_id) - before <= MOST_BEFORE
        assert before < CHUNKS // 2


def begun_after(sessions: sessionmaker[Session], job_id: UUID | None) -> int:
    """Count the chunks that have begun, or those that had when a job began."""
    begun = select(func.count()).select_from(Job).where(Job.batch_id.is_not(None), Job.started_at.is_not(None))
    if job_id is not None:
        begun = begun.where(Job.started_at <= look(sessions, job_id).started_at)
    with sessions() as session:
        return session.scalar(begun) or 0
