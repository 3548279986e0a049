"""Machines whose clocks are wrong or set while jobs run, and workers that are stopped for longer than their leases."""

import os
import re
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from uuid import UUID

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import job_records
from app.jobs.job_records import CancelOutcome
from app.operation.service_status import read_status
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage import stored_results
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from app.tables import JobStatus
from tests import servers
from tests.documents import add_job, count_points, hasty_settings, history, long_request, look
from tests.in_process import send
from tests.moved_clocks import MovedClock
from tests.processes import Process, kill_group, running_worker
from tests.servers import free_port, wait_until

HOUR = 3600
POINTS = 4
AT_ONCE = [("accepted", 0), ("running", 1), ("successful", 1)]
AT_SECOND_ATTEMPT = [("accepted", 0), ("running", 1), ("released", 1), ("running", 2), ("successful", 2)]


def submit(sessions: sessionmaker[Session], settings: Settings, points: int = POINTS) -> UUID:
    job_id = add_job(sessions, long_request(points))
    assert send(settings, job_id)
    return job_id


@contextmanager
def stopped(worker: Process) -> Iterator[None]:
    """Stop all processes of a worker, and let them go on."""
    os.killpg(worker.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.killpg(worker.pid, signal.SIGCONT)


def wait_for_progress(sessions: sessionmaker[Session], job_id: UUID) -> None:
    wait_until(lambda: look(sessions, job_id).progress > 0.0, 60.0, "progress")


def assert_finished(
    sessions: sessionmaker[Session], job_id: UUID, past: list[tuple[str, int]], points: int = POINTS
) -> None:
    open_states = (JobStatus.ACCEPTED, JobStatus.RUNNING)
    wait_until(lambda: look(sessions, job_id).status not in open_states, 60.0, "the end of the job")
    assert history(sessions, job_id) == past
    assert count_points(sessions, job_id) == points


def test_a_clock_set_back_after_a_kill_holds_up_no_job(tmp_path: Path) -> None:
    settings = hasty_settings(tmp_path)
    migrate(settings)
    engine = make_engine(settings)
    sessions = session_factory(engine)
    ahead = MovedClock(tmp_path / "clock", HOUR)
    with running_worker(settings, ahead.environment) as worker:
        job_id, cancelled = submit(sessions, settings), submit(sessions, settings, 60)
        wait_for_progress(sessions, job_id)
        wait_for_progress(sessions, cancelled)
        kill_group(worker)
    with sessions.begin() as session:
        assert job_records.cancel(session, LOCAL, cancelled) is CancelOutcome.REQUESTED
    clock, *_ = read_status(settings).faults()
    assert re.fullmatch(r"The database's clock has gone back by 3[56]\d\d s, and no worker has run since\.", clock)
    with running_worker(settings):
        assert_finished(sessions, job_id, AT_SECOND_ATTEMPT)
        wait_until(lambda: look(sessions, cancelled).status is JobStatus.DISMISSED, 20.0, "the end of the other job")
        found = read_status(settings)
        assert [fault for fault in found.faults() if "clock" in fault] == []
        assert found.contents is not None
        assert all(0.0 <= worker.seen_seconds_ago < 60.0 for worker in found.contents.workers)
    engine.dispose()


@pytest.mark.parametrize("deployment", ["production"], indirect=True)
def test_workers_whose_clocks_are_an_hour_off_agree(
    deployment: Settings, deployed: sessionmaker[Session], tmp_path: Path
) -> None:
    """The first is stopped for longer than its lease and comes back while, and after, another computes its job."""
    off = {name: MovedClock(tmp_path / name, seconds) for name, seconds in (("ahead", HOUR), ("behind", -HOUR))}
    with running_worker(deployment, off["ahead"].environment) as first:
        job_id = submit(deployed, deployment)
        assert_finished(deployed, job_id, AT_ONCE)
        began, ended = look(deployed, job_id).started_at, look(deployed, job_id).finished_at
        assert began is not None and ended is not None
        assert began < ended and abs(ended - datetime.now(UTC)) < timedelta(seconds=60)
        job_id = submit(deployed, deployment)
        wait_for_progress(deployed, job_id)
        with stopped(first), running_worker(deployment, off["behind"].environment):
            assert_finished(deployed, job_id, AT_SECOND_ATTEMPT)
            end = look(deployed, job_id).finished_at
        log = deployment.data_dir / "process.log"
        wait_until(lambda: "this attempt are dropped" in log.read_text(), 60.0, "the late end of the first attempt")
    assert history(deployed, job_id) == AT_SECOND_ATTEMPT
    assert look(deployed, job_id).finished_at == end
    with deployed() as session:
        found = [row["span.horizontal_tension_n"] for row in stored_results.rows(session, job_id, "frequencies")]
    (axis,) = long_request(POINTS)["study"]["axes"]
    assert sorted(set(found)) == axis["values"]
    assert count_points(deployed, job_id) == POINTS


def test_a_servers_clock_that_is_set_takes_no_job_from_a_worker(tmp_path: Path, redis_address: str) -> None:
    with servers.postgres_directory() as directory:
        clock = MovedClock(directory)
        with servers.postgres_running(directory, free_port(), extra=clock.environment) as address:
            settings = Settings.model_validate(
                {**hasty_settings(tmp_path).model_dump(), "database_url": address, "broker_url": redis_address}
            )
            migrate(settings)
            engine = make_engine(settings)
            sessions = session_factory(engine)
            with running_worker(settings) as worker:
                job_id = submit(sessions, settings, 8)
                wait_for_progress(sessions, job_id)
                for step in (2 * HOUR, -HOUR, 0):
                    clock.set(step)
                    time.sleep(4.0 * settings.sweep_seconds)
                    assert [fault for fault in read_status(settings).faults() if "silent" in fault] == []
                assert_finished(sessions, job_id, AT_ONCE, 8)
                job_id = submit(sessions, settings)
                wait_for_progress(sessions, job_id)
                clock.set(-HOUR)
                kill_group(worker)
            with running_worker(settings):
                assert_finished(sessions, job_id, AT_SECOND_ATTEMPT)
            engine.dispose()
