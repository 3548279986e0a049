"""What does not wait for what: a single job for a long batch, and an owner for the long jobs of another."""

import itertools
from datetime import datetime
from uuid import UUID, uuid4

from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.batches.batch_records import Chunk
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.tables import Job, JobStatus
from tests.documents import STRANGER, add_job, create_job, long_request, look, short_request
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


def test_long_jobs_of_one_owner_leave_a_process_to_others(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    """Two processes, one job at once of an owner: his messages come first and run nothing, and no job is left."""
    bounded = deployment.model_copy(update={"worker_processes": 2, "running_jobs_per_owner": 1})
    long = [add_job(deployed, long_request(4)) for _ in range(4)]
    assert send(bounded, *long)
    with running_worker(bounded):
        wait_until(lambda: len(running(deployed)) == 1, 60.0, "the first of them")
        with deployed.begin() as session:
            short = create_job(session, STRANGER, short_request()).id
        assert send(bounded, short)
        seen = set()
        wait_until(lambda: seen.add(len(running(deployed))) or ended(deployed) == 5, 120.0, "the end of all")  # type: ignore[func-returns-value]
    times = {job_id: times_of(deployed, job_id) for job_id in (*long, short)}
    assert seen <= {0, 1}
    assert times[short][1] < min(times[job_id][1] for job_id in long[1:])
    in_order = sorted(times[job_id] for job_id in long)
    pauses = [(later[0] - earlier[1]).total_seconds() for earlier, later in itertools.pairwise(in_order)]
    assert min(pauses) >= 0.0, "one after another"
    assert max(pauses) < bounded.redispatch_seconds, "the end of one calls the next, and no sweeper"


def times_of(sessions: sessionmaker[Session], job_id: UUID) -> tuple[datetime, datetime]:
    with sessions() as session:
        job = session.get_one(Job, job_id)
    assert job.status is JobStatus.SUCCESSFUL
    assert job.started_at is not None and job.finished_at is not None
    return job.started_at, job.finished_at


def running(sessions: sessionmaker[Session]) -> list[UUID]:
    mine = Job.owner == LOCAL.owner, Job.status == JobStatus.RUNNING
    with sessions() as session:
        return list(session.scalars(select(Job.id).where(*mine)))


def ended(sessions: sessionmaker[Session]) -> int:
    with sessions() as session:
        return session.scalar(select(func.count()).select_from(Job).where(Job.finished_at.is_not(None))) or 0
