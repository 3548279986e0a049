import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from uuid import UUID

import pytest
from sqlalchemy import update
from sqlalchemy.orm import Session, sessionmaker

import engine.analysis
from app import convert
from app.convert import Advance, PointResult
from app.jobs import job_records, leases
from app.runtime.settings import Settings
from app.schemas.placement import EXAMPLE
from app.security.caller import LOCAL
from app.storage import steady_clock, stored_results
from app.tables import FailureKind, Job, JobStatus
from tests.documents import (
    add_job,
    count_points,
    history,
    long_request,
    look,
    point_result,
    short_request,
)
from tests.in_process import run_job
from tests.servers import wait_until
from worker.execute import execute


def stopped_while_running(
    sessions: sessionmaker[Session], settings: Settings, job_id: UUID, seconds: float = 30.0
) -> None:
    """Run a job in a thread, and cancel it once its heartbeat has told of progress."""
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(execute, sessions, settings, job_id, "here")
        wait_until(lambda: look(sessions, job_id).progress > 0.0, seconds, "progress")
        with sessions.begin() as session:
            job_records.cancel(session, LOCAL, job_id)
        future.result(seconds)


def test_job_is_computed_and_stored(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions, short_request())
    run_job(settings, job_id)
    expected = [item for item in convert.run(short_request()) if isinstance(item, PointResult)]
    with sessions() as session:
        assert list(stored_results.rows(session, job_id, "limit_cycles")) == expected[0].tables["limit_cycles"]
    job = look(sessions, job_id)
    assert (job.status, job.engine_version) == (JobStatus.SUCCESSFUL, expected[0].engine_version)


def test_second_delivery_changes_nothing(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions, short_request())
    run_job(settings, job_id, "first")
    finished, past = look(sessions, job_id).finished_at, history(sessions, job_id)
    run_job(settings, job_id, "second")
    assert look(sessions, job_id).finished_at == finished
    assert history(sessions, job_id) == past == [("accepted", 0), ("running", 1), ("successful", 1)]


def test_input_that_the_engine_refuses_fails_by_input(sessions: sessionmaker[Session], settings: Settings) -> None:
    document = short_request()
    document["line"]["span"]["length_m"] = -1.0
    job_id = add_job(sessions, document)
    run_job(settings, job_id)
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind, job.attempt) == (JobStatus.FAILED, FailureKind.INPUT, 1)
    assert "length_m" in (job.failure_detail or "")
    assert job.document == document


def test_running_job_stops_when_cancelled(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions, long_request(30))
    stopped_while_running(sessions, settings, job_id)
    assert look(sessions, job_id).status is JobStatus.DISMISSED
    assert count_points(sessions, job_id) == 0
    kinds = [kind for kind, _ in history(sessions, job_id)]
    assert kinds == ["accepted", "running", "cancel_requested", "dismissed"]


def test_a_search_for_places_stops_between_generations(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions, short_request() | {"placement": EXAMPLE | {"generations": 200, "population": 8}})
    stopped_while_running(sessions, settings, job_id, 60.0)
    assert look(sessions, job_id).status is JobStatus.DISMISSED
    assert count_points(sessions, job_id) == 0


def test_job_past_the_soft_limit_keeps_the_points_it_has(sessions: sessionmaker[Session], settings: Settings) -> None:
    hasty = settings.model_copy(update={"soft_time_limit_seconds": 1e-3})
    job_id = add_job(sessions, long_request(5))
    run_job(hasty, job_id)
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind) == (JobStatus.FAILED, FailureKind.TIME_LIMIT)
    assert job.failure_detail == "The job ran longer than the limit of 0.001 s."
    assert count_points(sessions, job_id) < 5


def test_job_taken_away_stores_nothing(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions, long_request(30))
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(execute, sessions, settings, job_id, "zombie")
        wait_until(lambda: look(sessions, job_id).progress > 0.0, what="progress")
        with sessions.begin() as session:
            leases.release_expired(session, settings, "zombie")
        future.result(30.0)
    job = look(sessions, job_id)
    assert (job.status, job.attempt) == (JobStatus.ACCEPTED, 1)
    assert count_points(sessions, job_id) == 0


def test_fault_of_our_own_fails_the_job_without_showing_its_inside(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> Iterator[Advance | PointResult]:
        yield point_result(0)
        raise RuntimeError("secret path")

    monkeypatch.setattr(convert, "run", broken)
    job_id = add_job(sessions)
    run_job(settings, job_id)
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind) == (JobStatus.FAILED, FailureKind.INTERNAL)
    assert job.failure_detail == "The computation stopped on an internal error (RuntimeError); the log has the details."
    assert count_points(sessions, job_id) == 1


def test_all_points_failed_is_a_failed_job(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    points = [point_result(0, failure="It overflowed."), point_result(1, failure="Again.")]
    monkeypatch.setattr(convert, "run", lambda *_: iter(points))
    failed, mixed = add_job(sessions), add_job(sessions)
    run_job(settings, failed)
    points[1] = point_result(1)
    run_job(settings, mixed)
    assert look(sessions, failed).failure_kind is FailureKind.NO_CONVERGENCE
    assert look(sessions, failed).failure_detail == "It overflowed."
    assert look(sessions, mixed).status is JobStatus.SUCCESSFUL
    assert [count_points(sessions, job_id) for job_id in (failed, mixed)] == [2, 2]


def test_long_step_does_not_lose_the_lease(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    released: list[int] = []

    def slow(*_: object) -> Iterator[Advance | PointResult]:
        for _step in range(6):
            time.sleep(0.6)  # all steps together are longer than the lease, which bears a slow heartbeat
            with sessions.begin() as session:
                steady_clock.move_on(session, None)
                released.append(leases.release_expired(session, short))
        yield point_result(0)

    monkeypatch.setattr(convert, "run", slow)
    short = settings.model_copy(update={"lease_seconds": 3.0, "heartbeat_seconds": 0.05})
    job_id = add_job(sessions)
    run_job(short, job_id)
    assert released == [0] * 6
    assert look(sessions, job_id).status is JobStatus.SUCCESSFUL


@pytest.mark.parametrize("lost", [False, True])
def test_a_job_that_does_not_stop_in_time_ends_with_its_process(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch, lost: bool
) -> None:
    ended = Event()

    def deaf(*_: object) -> Iterator[Advance | PointResult]:
        with sessions.begin() as session:
            if lost:
                leases.release_expired(session, settings, "here")
            else:
                job_records.cancel(session, LOCAL, job_id)
        assert ended.wait(30.0)
        past.append(look(sessions, job_id).status)
        yield point_result(0)

    past: list[JobStatus] = []
    monkeypatch.setattr(convert, "run", deaf)
    job_id = add_job(sessions)
    hasty = settings.model_copy(update={"stop_seconds": 0.1, "lease_seconds": 600.0})
    execute(sessions, hasty, job_id, "here", ended.set)
    assert past == [JobStatus.ACCEPTED if lost else JobStatus.DISMISSED]
    assert look(sessions, job_id).status is past[0]
    assert count_points(sessions, job_id) == 0


def test_a_job_that_stops_in_time_leaves_its_process(sessions: sessionmaker[Session], settings: Settings) -> None:
    ended = Event()
    job_id = add_job(sessions, long_request(30))
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(execute, sessions, settings, job_id, "here", ended.set)
        wait_until(lambda: look(sessions, job_id).progress > 0.0, what="progress")
        with sessions.begin() as session:
            job_records.cancel(session, LOCAL, job_id)
        future.result(30.0)
    assert look(sessions, job_id).status is JobStatus.DISMISSED
    assert not ended.is_set()


def test_missed_heartbeats_do_not_end_the_job(
    settings: Settings, sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    job_id = add_job(sessions)

    def outage(*_: object) -> Iterator[Advance | PointResult]:
        with sessions.begin() as session:  # a holder of the row makes heartbeats wait, as a slow database does
            session.execute(update(Job).where(Job.id == job_id).values(name="held"))
            time.sleep(0.5)
        yield point_result(0)

    monkeypatch.setattr(convert, "run", outage)
    run_job(settings, job_id)
    assert look(sessions, job_id).status is JobStatus.SUCCESSFUL


def test_a_point_that_a_defect_took_says_so(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> Iterator[object]:
        raise RuntimeError("generator raised StopIteration")
        yield

    monkeypatch.setattr(engine.analysis, "analyse", broken)
    document = short_request() | {"study": {"axes": [{"parameter": "span.length_m", "values": [100.0, 120.0]}]}}
    job_id = add_job(sessions, document)
    run_job(settings, job_id)
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind) == (JobStatus.FAILED, FailureKind.INTERNAL)
    assert count_points(sessions, job_id) == 2
