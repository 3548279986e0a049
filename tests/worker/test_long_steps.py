"""Jobs in a step of the engine that takes a minute, cancelled in real pools: the process ends with its job."""

from uuid import UUID

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.batches.intake import Incoming, receive
from app.jobs import batch_progress, job_records
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.tables import JobStatus
from tests.documents import (
    SILENT_STEP,
    STRANGER,
    add_job,
    count_points,
    history,
    long_request,
    look,
    short_request,
    silent_request,
)
from tests.in_process import send
from tests.processes import pool_children, running_worker
from tests.servers import wait_until

POINTS = 6
LINES = 3  # the stack of a chunk is one step
AT_ONCE = [("accepted", 0), ("running", 1), ("successful", 1)]


@pytest.fixture
def patient(deployment: Settings) -> Settings:
    """Give settings under which no lease ends in a test, and a job has little time to stop."""
    return deployment.model_copy(update={"lease_seconds": 600.0, "stop_seconds": 0.3})


def wait_for_step(sessions: sessionmaker[Session], job_id: UUID, step: str) -> None:
    wait_until(lambda: look(sessions, job_id).step == step, 60.0, "the long step")


def counts(sessions: sessionmaker[Session], batch_id: UUID) -> batch_progress.Counts:
    with sessions() as session:
        return batch_progress.counts(session, [batch_id])[batch_id]


def test_a_cancelled_job_ends_with_its_process_and_its_neighbour_goes_on(
    patient: Settings, deployed: sessionmaker[Session]
) -> None:
    with running_worker(patient) as worker:
        silent = add_job(deployed, silent_request())
        assert send(patient, silent)
        wait_for_step(deployed, silent, SILENT_STEP)
        neighbour = add_job(deployed, long_request(POINTS))
        waiting = add_job(deployed, short_request())
        assert send(patient, neighbour, waiting)
        wait_until(lambda: look(deployed, neighbour).progress > 0.0, 60.0, "progress of the neighbour")
        before = set(pool_children(worker))
        with deployed.begin() as session:
            job_records.cancel(session, LOCAL, silent)
        wait_until(lambda: look(deployed, silent).status is JobStatus.DISMISSED, 20.0, "the end of the cancelled job")
        wait_until(lambda: len(before - set(pool_children(worker))) == 1, 10.0, "the end of its process")
        for job_id in (waiting, neighbour):
            wait_until(lambda job_id=job_id: look(deployed, job_id).status is JobStatus.SUCCESSFUL, 60.0, "the others")  # type: ignore[misc]
        wait_until(lambda: len(pool_children(worker)) == patient.worker_processes, 20.0, "a whole pool")
    assert history(deployed, silent)[1:] == [("running", 1), ("cancel_requested", 1), ("dismissed", 1)]
    assert history(deployed, neighbour) == history(deployed, waiting) == AT_ONCE
    assert (count_points(deployed, silent), count_points(deployed, neighbour)) == (0, POINTS)


@pytest.mark.parametrize("deployment", ["embedded"], indirect=True)
def test_a_cancelled_chunk_frees_the_only_process_for_another_owners(
    patient: Settings, deployed: sessionmaker[Session]
) -> None:
    alone = patient.model_copy(update={"worker_processes": 1, "chunk_seconds": 600.0})
    documents = (silent_request(), short_request())
    with running_worker(alone) as worker:
        batches = []
        for caller, document in zip((LOCAL, STRANGER), documents, strict=True):
            incoming = Incoming(document["analysis"], iter([document["line"]] * LINES))
            receipt = receive(deployed, alone, caller, incoming, atomic=False)
            assert send(alone, *receipt.chunk_ids, chunk=True)
            batches.append(receipt)
        silent, other = batches
        wait_for_step(deployed, silent.chunk_ids[0], f"lines 1 to {LINES} of {LINES}")
        (process,) = pool_children(worker)
        with deployed.begin() as session:
            batch_records.cancel(session, LOCAL, silent.batch_id)
        wait_until(lambda: process not in pool_children(worker), 10.0, "the end of the process")
        wait_until(lambda: counts(deployed, other.batch_id).successful == LINES, 30.0, "the other batch")
    assert history(deployed, other.chunk_ids[0]) == AT_ONCE
    assert counts(deployed, silent.batch_id).dismissed == LINES
