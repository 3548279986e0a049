"""Clocks of the server, the API and the workers set at random while jobs run and workers are killed."""

import random
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from uuid import UUID

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.client import Client
from app.jobs import job_records
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage.database import make_engine, session_factory
from app.tables import ENDED, Job, JobEvent, JobEventKind, JobStatus, PointRow
from tests.documents import SILENT_STEP, add_job, long_request, look, short_request, silent_request
from tests.faults import figures
from tests.faults.deployment import deployed, kill_some_worker
from tests.faults.scale import SCALE
from tests.in_process import send
from tests.processes import pool_children, running_worker
from tests.servers import wait_until

JOBS, STEPS = (max(least, round(SCALE * whole)) for whole, least in ((60, 12), (36, 9)))
POINTS = 2
FURTHEST_SECONDS = 7200
SEED = 20261130
LONGEST_SECONDS = 240.0  # from the last fault to the last end; far less than any step


def post_jobs(address: str) -> list[UUID]:
    with Client(address, patience_seconds=60.0) as service:
        accepted = []
        for number in range(JOBS):
            document = long_request(POINTS)
            document["line"]["span"]["length_m"] = 100.0 + number  # no job is answered with what is stored
            accepted.append(service.submit_document(document).id)
            time.sleep(0.4)
    return accepted


def test_clocks_that_are_set_lose_nothing_and_hold_nothing_up(tmp_path: Path) -> None:
    chance, killed, moved = random.Random(SEED), Counter[str](), 0
    with deployed(tmp_path, workers=3, moved_clocks=True) as service, ThreadPoolExecutor(1) as poster:
        engine = make_engine(service.settings)
        sessions = session_factory(engine)
        posted = poster.submit(post_jobs, service.address)
        for number in range(STEPS):
            time.sleep(chance.uniform(1.0, 2.5))
            for clock in service.clocks[:1] if number % 3 else service.clocks[1:]:
                clock.set(chance.randint(-FURTHEST_SECONDS, FURTHEST_SECONDS))
                moved += 1
            if number % 3 == 2:
                killed[kill_some_worker(service.workers, chance)] += 1
        last_fault = time.monotonic()
        accepted = posted.result(300.0)
        wait_until(lambda: not _open_jobs(sessions), LONGEST_SECONDS, "the end of all jobs")
        seconds = time.monotonic() - last_fault
        lost, attempts = _assert_whole(sessions, accepted)
        engine.dispose()
    assert lost <= killed.total()
    figures.note(
        "clocks",
        {
            "jobs, all successful": JOBS,
            "clocks set, each by up to two hours ahead or back": moved,
            "killed": dict(killed),
            "attempts lost": lost,
            "most attempts that a job needed": attempts,
            "from the last fault to the last end, s": round(seconds, 1),
        },
    )


def _open_jobs(sessions: sessionmaker[Session]) -> bool:
    with sessions() as session:
        return session.scalars(select(Job.id).where(Job.status.not_in(ENDED)).limit(1)).first() is not None


def _assert_whole(sessions: sessionmaker[Session], accepted: list[UUID]) -> tuple[int, int]:
    """Hold that each job ended once with all its points; return the attempts lost, and the most of one job."""
    with sessions() as session:
        jobs = session.scalars(select(Job)).all()
        events = Counter((event.job_id, event.kind) for event in session.scalars(select(JobEvent)))
        points = Counter(session.scalars(select(PointRow.job_id)))
    assert {job.id for job in jobs} == set(accepted)
    assert {job.status for job in jobs} == {JobStatus.SUCCESSFUL}
    assert {(events[job.id, JobEventKind.SUCCESSFUL], points[job.id]) for job in jobs} == {(1, POINTS)}
    assert all(events[job.id, JobEventKind.RELEASED] == job.attempt - 1 for job in jobs)
    return sum(job.attempt - 1 for job in jobs), max(job.attempt for job in jobs)


@pytest.mark.parametrize("deployment", ["production"], indirect=True)
def test_a_cancelled_job_in_a_long_step_frees_its_process(
    deployment: Settings, deployed: sessionmaker[Session]
) -> None:
    alone = deployment.model_copy(update={"worker_processes": 1, "stop_seconds": 5.0, "lease_seconds": 600.0})
    with running_worker(alone) as worker:
        silent, following = add_job(deployed, silent_request()), add_job(deployed, short_request())
        assert send(alone, silent, following)
        wait_until(lambda: look(deployed, silent).step == SILENT_STEP, 60.0, "the long step")
        (process,) = pool_children(worker)
        begin = time.monotonic()
        with deployed.begin() as session:
            job_records.cancel(session, LOCAL, silent)
        wait_until(lambda: look(deployed, silent).status is JobStatus.DISMISSED, 30.0, "the end of the job")
        dismissed = time.monotonic() - begin
        wait_until(lambda: process not in pool_children(worker), 30.0, "the end of its process")
        ended = time.monotonic() - begin
        wait_until(lambda: look(deployed, following).status is JobStatus.SUCCESSFUL, 30.0, "the next job")
        successful = time.monotonic() - begin
    figures.note(
        "cancelled in a long step",
        {
            "from the cancel to `dismissed`, s": round(dismissed, 1),
            "from the cancel to the end of the process, s": round(ended, 1),
            "from the cancel to the end of the next job, s": round(successful, 1),
        },
    )
