"""Workers and their parts killed with SIGKILL in the middle of a job, embedded and with PostgreSQL and Redis."""

import os
import signal
import time
from contextlib import ExitStack
from uuid import UUID

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import job_records
from app.jobs.dispatch import open_queue
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage import stored_results
from app.tables import FailureKind, JobStatus
from tests.documents import add_job, count_points, history, long_request, look, short_request
from tests.in_process import send
from tests.processes import Process, busy_child, children, group, kill_group, pool_children, running_worker
from tests.servers import free_port, redis_server, wait_until

POINTS = 4
FREQUENCY_ROWS = 4  # two models of one and two loops
FINISHED_AT_SECOND_ATTEMPT = [("accepted", 0), ("running", 1), ("released", 1), ("running", 2), ("successful", 2)]


def submit(sessions: sessionmaker[Session], settings: Settings) -> UUID:
    job_id = add_job(sessions, long_request(POINTS))
    assert send(settings, job_id)
    return job_id


def wait_for_progress(sessions: sessionmaker[Session], job_id: UUID, attempt: int = 1) -> None:
    def advanced() -> bool:
        job = look(sessions, job_id)
        return job.attempt == attempt and job.status is JobStatus.RUNNING and job.progress > 0.0

    wait_until(advanced, 60.0, f"progress of attempt {attempt}")
    assert look(sessions, job_id).progress < 1.0


def wait_for_end(sessions: sessionmaker[Session], job_id: UUID) -> JobStatus:
    running = (JobStatus.ACCEPTED, JobStatus.RUNNING)
    wait_until(lambda: look(sessions, job_id).status not in running, 90.0, "the end of the job")
    return look(sessions, job_id).status


def assert_finished_once(sessions: sessionmaker[Session], job_id: UUID) -> None:
    assert wait_for_end(sessions, job_id) is JobStatus.SUCCESSFUL
    assert history(sessions, job_id) == FINISHED_AT_SECOND_ATTEMPT
    assert count_points(sessions, job_id) == POINTS
    with sessions() as session:
        found = [row["span.horizontal_tension_n"] for row in stored_results.rows(session, job_id, "frequencies")]
    (axis,) = long_request(POINTS)["study"]["axes"]
    assert found == [tension for tension in axis["values"] for _ in range(FREQUENCY_ROWS)]


def test_whole_worker_killed_and_another_finishes_the_job_once(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    with running_worker(deployment) as worker:
        job_id = submit(deployed, deployment)
        wait_for_progress(deployed, job_id)
        kill_group(worker)
    assert look(deployed, job_id).status is JobStatus.RUNNING
    with running_worker(deployment):
        assert_finished_once(deployed, job_id)


def test_process_at_work_killed_and_the_same_worker_finishes_the_job_once(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    with running_worker(deployment) as worker:
        job_id = submit(deployed, deployment)
        wait_for_progress(deployed, job_id)
        os.kill(busy_child(worker), signal.SIGKILL)
        assert_finished_once(deployed, job_id)


def test_pool_killed_gives_its_job_back_before_the_lease_ends(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    patient = deployment.model_copy(update={"lease_seconds": 600.0})
    with running_worker(patient) as worker:
        job_id = submit(deployed, patient)
        wait_for_progress(deployed, job_id)
        (pool,) = children(worker.pid)
        os.kill(pool, signal.SIGKILL)
        assert_finished_once(deployed, job_id)


@pytest.mark.parametrize("deployment", ["embedded"], indirect=True)
def test_idle_processes_killed_do_not_stop_the_pool(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    with running_worker(deployment) as worker:
        first = pool_children(worker)
        for pid in first:
            os.kill(pid, signal.SIGKILL)
        job_id = submit(deployed, deployment)
        assert wait_for_end(deployed, job_id) is JobStatus.SUCCESSFUL
        assert not set(first) & set(pool_children(worker))


@pytest.mark.parametrize("deployment", ["production"], indirect=True)
def test_orphans_of_a_killed_supervisor_end(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    with running_worker(deployment) as worker:
        job_id = submit(deployed, deployment)
        wait_for_progress(deployed, job_id)
        assert len(group(worker)) == 4
        worker.kill()
        worker.wait()
        wait_until(lambda: group(worker) == [], 5.0, "the end of the orphans")
    assert look(deployed, job_id).status is JobStatus.RUNNING


@pytest.mark.parametrize("deployment", ["embedded"], indirect=True)
def test_job_that_loses_all_its_workers_fails_with_the_sentence(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    strict = deployment.model_copy(update={"max_attempts": 2})
    with running_worker(strict) as worker:
        job_id = submit(deployed, strict)
        for attempt in (1, 2):
            wait_for_progress(deployed, job_id, attempt)
            (pool,) = children(worker.pid)
            os.kill(pool, signal.SIGKILL)
            wait_until(lambda pool=pool: children(worker.pid) not in ([], [pool]), 30.0, "a new pool")  # type: ignore[misc]
        assert wait_for_end(deployed, job_id) is JobStatus.FAILED
    job = look(deployed, job_id)
    assert (job.failure_kind, job.attempt) == (FailureKind.WORKER_LOST, 2)
    assert job.failure_detail == "The service gave up the job because its worker was lost in each of 2 attempts."
    assert job.document == long_request(POINTS)


def stop_in_time(worker: Process, seconds: float) -> int:
    start = time.monotonic()
    worker.terminate()
    code = worker.wait(seconds)
    assert time.monotonic() - start < seconds
    return code


def test_process_that_hangs_is_killed_and_its_job_fails_by_the_limit(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    limits = {"soft_time_limit_seconds": 3.0, "hard_time_limit_seconds": 4.0, "lease_seconds": 5.0}
    strict = deployment.model_copy(update={**limits, "worker_processes": 1})
    with running_worker(strict) as worker:
        job_id = add_job(deployed, long_request(60))
        assert send(strict, job_id)
        wait_for_progress(deployed, job_id)
        hanging = busy_child(worker)
        os.kill(hanging, signal.SIGSTOP)  # it neither computes nor beats nor hears of the soft limit
        assert wait_for_end(deployed, job_id) is JobStatus.FAILED
        job = look(deployed, job_id)
        assert (job.failure_kind, job.attempt) == (FailureKind.TIME_LIMIT, 1)
        next_job = add_job(deployed, short_request())
        assert send(strict, next_job)
        assert wait_for_end(deployed, next_job) is JobStatus.SUCCESSFUL
        assert hanging not in pool_children(worker)


def test_job_too_long_ends_at_the_soft_limit(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    strict = deployment.model_copy(update={"soft_time_limit_seconds": 1.0, "hard_time_limit_seconds": 30.0})
    with running_worker(strict) as worker:
        before = pool_children(worker)
        job_id = add_job(deployed, long_request(60))
        assert send(strict, job_id)
        assert wait_for_end(deployed, job_id) is JobStatus.FAILED
        assert look(deployed, job_id).failure_kind is FailureKind.TIME_LIMIT
        assert pool_children(worker) == before


@pytest.mark.parametrize("deployment", ["production"], indirect=True)
def test_stopped_worker_gives_its_job_back(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    with running_worker(deployment) as worker:
        job_id = add_job(deployed, long_request(60))
        assert send(deployment, job_id)
        wait_for_progress(deployed, job_id)
        assert stop_in_time(worker, 20.0) == 0
        assert group(worker) == []
    job = look(deployed, job_id)
    assert job.status is JobStatus.ACCEPTED
    assert history(deployed, job_id)[-1] == ("released", 1)
    # Its message waits for another worker already.
    assert job.dispatched_at is not None
    with open_queue(deployment) as queue:
        assert not queue.is_empty()


@pytest.mark.parametrize("deployment", ["embedded"], indirect=True)
def test_stopped_worker_ends_a_job_that_fits_into_its_time(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    patient = deployment.model_copy(update={"shutdown_seconds": 60.0})
    with running_worker(patient) as worker:
        job_id = submit(deployed, patient)
        wait_for_progress(deployed, job_id)
        assert stop_in_time(worker, 50.0) == 0
    assert look(deployed, job_id).status is JobStatus.SUCCESSFUL
    assert history(deployed, job_id) == [("accepted", 0), ("running", 1), ("successful", 1)]


def test_duplicates_are_harmless_and_a_running_job_can_be_cancelled(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    with running_worker(deployment):
        job_id, stopped = add_job(deployed, short_request()), add_job(deployed, long_request(60))
        with open_queue(deployment) as queue:
            for message in (job_id, job_id, stopped, job_id):
                queue.send(message)
        assert wait_for_end(deployed, job_id) is JobStatus.SUCCESSFUL
        wait_for_progress(deployed, stopped)
        with deployed.begin() as session:
            job_records.cancel(session, LOCAL, stopped)
        assert wait_for_end(deployed, stopped) is JobStatus.DISMISSED
        with open_queue(deployment) as queue:
            wait_until(queue.is_empty, what="an empty queue")
    assert history(deployed, job_id) == [("accepted", 0), ("running", 1), ("successful", 1)]


@pytest.mark.parametrize("deployment", ["production"], indirect=True)
def test_worker_outlives_its_redis(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    port = free_port()
    moved = deployment.model_copy(update={"broker_url": f"redis://127.0.0.1:{port}/0"})
    with ExitStack() as worker:
        with redis_server(port):
            worker.enter_context(running_worker(moved))
            before = add_job(deployed, short_request())
            assert send(moved, before)
            assert wait_for_end(deployed, before) is JobStatus.SUCCESSFUL
        between = add_job(deployed, short_request())
        assert not send(moved, between)
        with redis_server(port):
            assert wait_for_end(deployed, between) is JobStatus.SUCCESSFUL
