"""Jobs and a batch while workers are killed, and Redis, PostgreSQL and the API are restarted under them."""

import random
import statistics
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.client import Client
from app.reference.source_lines import example
from app.storage.database import make_engine, session_factory
from app.tables import BatchItem, Job, JobEvent, JobEventKind, JobStatus, PointRow
from tests.faults import figures
from tests.faults.deployment import Deployment, Part, deployed, kill_some_worker
from tests.faults.scale import SCALE
from tests.servers import wait_until

JOBS, LINES, KILLS = (max(least, round(SCALE * whole)) for whole, least in ((1000, 20), (20_000, 200), (32, 8)))
SEED = 20261122
POSTERS = 4
LONGEST_SECONDS = 240.0  # from the last fault, or from when it was accepted, to the end of a job
PATIENCE_SECONDS = 120.0
ANALYSIS = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}


def line(tension: float) -> dict[str, Any]:
    """Return a line that no other is equal to, so that none is answered with what is stored."""
    found = example("c11-twin")
    return {**found, "span": {**found["span"], "horizontal_tension_n": tension}}


def post_jobs(address: str, numbers: range, pause_seconds: float) -> list[UUID]:
    """Post jobs at a steady pace and return the ids that were accepted."""
    accepted = []
    with Client(address, patience_seconds=PATIENCE_SECONDS) as service:
        for number in numbers:
            accepted.append(service.submit(line(31_000.0 + number), ANALYSIS).id)
            time.sleep(pause_seconds)
    return accepted


def post_batch(address: str) -> UUID:
    with Client(address, patience_seconds=PATIENCE_SECONDS) as service:
        return service.submit_batch((line(20_000.0 + 0.5 * number) for number in range(LINES)), ANALYSIS).id


def disturb(service: Deployment, chance: random.Random) -> Iterator[str]:
    """Kill and restart, every few seconds, and tell what it was."""
    restarts: dict[str, Part[Any]] = {"Redis": service.redis, "PostgreSQL": service.postgres, "API": service.api}
    order = ["Redis", "API", "PostgreSQL", "Redis", "API", "PostgreSQL", "Redis"]
    due = {(place + 1) * KILLS // (len(order) + 1): name for place, name in enumerate(order)}
    for number in range(KILLS):
        time.sleep(chance.uniform(3.0, 6.0))
        yield kill_some_worker(service.workers, chance)
        if name := due.get(number):
            restarts[name].stop()
            time.sleep(chance.uniform(1.0, 3.0))
            restarts[name].start()
            yield name


@dataclass(frozen=True, slots=True)
class Books:
    """All that the database holds in the end."""

    jobs: list[Job]
    events: dict[UUID, list[tuple[JobEventKind, int]]]
    points: list[tuple[UUID, int, float | None]]
    asked: dict[int, float]

    def chunks(self, batch: UUID) -> list[Job]:
        return [job for job in self.jobs if job.batch_id == batch]

    def single(self) -> list[Job]:
        return [job for job in self.jobs if job.batch_id is None]


def read_books(session: Session) -> Books:
    events: dict[UUID, list[tuple[JobEventKind, int]]] = {}
    for job_id, kind, attempt in session.execute(
        select(JobEvent.job_id, JobEvent.kind, JobEvent.attempt).order_by(JobEvent.id)
    ):
        events.setdefault(job_id, []).append((kind, attempt))
    points = select(PointRow.job_id, PointRow.point, PointRow.horizontal_tension_n)
    items = session.execute(select(BatchItem.number, BatchItem.document))
    asked = {number: document["span"]["horizontal_tension_n"] for number, document in items if document}
    return Books(list(session.scalars(select(Job))), events, [(a, b, c) for a, b, c in session.execute(points)], asked)


def still_open(service: Deployment) -> int:
    engine = make_engine(service.settings)
    try:
        with session_factory(engine)() as session:
            waiting = Job.status.in_((JobStatus.ACCEPTED, JobStatus.RUNNING))
            return len(session.scalars(select(Job.id).where(waiting)).all())
    finally:
        engine.dispose()


def final_books(service: Deployment) -> Books:
    engine = make_engine(service.settings)
    try:
        with session_factory(engine)() as session:
            return read_books(session)
    finally:
        engine.dispose()


def assert_each_ended_once(books: Books) -> None:
    for job in books.jobs:
        assert job.status is JobStatus.SUCCESSFUL, (job.id, job.status, job.failure_detail)
        history = books.events[job.id]
        assert [attempt for kind, attempt in history if kind is JobEventKind.SUCCESSFUL] == [job.attempt]
        runs = [attempt for kind, attempt in history if kind is JobEventKind.RUNNING]
        assert runs == list(range(1, job.attempt + 1))
        assert history[-1] == (JobEventKind.SUCCESSFUL, job.attempt)


def assert_results_are_those_asked_for(books: Books, batch: UUID) -> None:
    of_batch = {job.id for job in books.chunks(batch)}
    lines = {point: tension for job, point, tension in books.points if job in of_batch}
    assert len(books.points) == JOBS + LINES
    assert lines == pytest.approx(books.asked, rel=1e-9)
    jobs = {job: tension for job, _, tension in books.points if job not in of_batch}
    asked = {job.id: job.document["line"]["span"]["horizontal_tension_n"] for job in books.single()}
    assert jobs == pytest.approx(asked, rel=1e-9)


@pytest.mark.timeout(840)
def test_nothing_is_lost_nothing_done_twice_and_nothing_stuck(tmp_path: Path) -> None:
    chance, happened = random.Random(SEED), Counter[str]()
    with deployed(tmp_path, workers=3) as service, ThreadPoolExecutor(POSTERS) as pool:
        batch_id = post_batch(service.address)
        begin = time.monotonic()
        pause = 3.5 * KILLS * POSTERS / JOBS
        posters = [
            pool.submit(post_jobs, service.address, range(first, JOBS, POSTERS), pause) for first in range(POSTERS)
        ]
        for name in disturb(service, chance):
            happened[name] += 1
        accepted = {job_id for poster in posters for job_id in poster.result()}
        calm = time.monotonic()
        wait_until(lambda: still_open(service) == 0, LONGEST_SECONDS, "the end of all jobs")
        end = time.monotonic()
        books = final_books(service)
    assert len(accepted) == JOBS
    assert {job.id for job in books.single()} == accepted
    assert len(books.asked) == LINES
    assert_each_ended_once(books)
    assert_results_are_those_asked_for(books, batch_id)
    waits = [(job.finished_at - job.created_at).total_seconds() for job in books.single() if job.finished_at]
    assert max(waits) < LONGEST_SECONDS
    lost = sum(kind is JobEventKind.RELEASED for history in books.events.values() for kind, _ in history)
    figures.note(
        "restarts",
        {
            "jobs": JOBS,
            "lines of the batch": LINES,
            "messages of the batch": len(books.chunks(batch_id)),
            "killed": {kind: happened[kind] for kind in ("process", "pool", "supervisor", "worker")},
            "killed and restarted": {name: happened[name] for name in ("Redis", "PostgreSQL", "API")},
            "attempts lost": lost,
            "most attempts that a job needed": max(job.attempt for job in books.jobs),
            "duration of posts and faults, s": round(calm - begin, 1),
            "from the last fault to the last end, s": round(end - calm, 1),
            "longest time of a job, s": round(max(waits), 1),
            "median time of a job, s": round(statistics.median(waits), 2),
        },
    )
