import re
from datetime import timedelta
from pathlib import Path

from sqlalchemy import text, update
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.operation import service_status, workers
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage.database import database_time
from app.tables import JobStatus, SteadyClock
from tests.batch_rows import add_batch, run
from tests.documents import add_job
from tests.in_process import send
from tests.processes import running_worker
from tests.servers import free_port, wait_until
from worker.sweep import ClockKeeper


def test_work_is_counted_as_it_is(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    waiting, running, lost = (add_job(deployed) for _ in range(3))
    _, (done, _) = add_batch(deployed, 2, 2)
    run(deployed, done)
    with deployed.begin() as session:
        workers.report(session, deployment, "here")
        leases.claim(session, running, "here", 60.0)
        leases.claim(session, lost, "gone", -1.0)
    assert send(deployment, waiting)
    found = service_status.read_status(deployment)
    assert (found.database, found.broker) == ("ok", "ok")
    assert found.contents is not None
    assert found.queues == service_status.Queues(jobs=1, chunks=0)
    assert found.contents.jobs.by_status == dict.fromkeys(JobStatus, 0) | {JobStatus.ACCEPTED: 1, JobStatus.RUNNING: 2}
    assert found.contents.chunks.by_status[JobStatus.SUCCESSFUL] == 1
    assert found.contents.chunks.by_status[JobStatus.ACCEPTED] == 1
    assert found.contents.jobs.oldest_waiting_seconds is not None
    assert 0.0 <= found.contents.jobs.oldest_waiting_seconds < 60.0
    assert found.contents.leases == service_status.Leases(held=2, expired=1, undispatched=1)
    (worker,) = found.contents.workers
    assert (worker.name, worker.running, worker.processes, worker.silent) == ("here", 1, 2, False)
    (owner,) = found.contents.owners.items()
    assert owner[0] == LOCAL.owner
    assert (owner[1].running, owner[1].waiting) == (2, 2)
    assert 0 < owner[1].expected < owner[1].stored
    assert found.faults() == ["1 leases have expired, and no worker has released their jobs."]


def test_workers_come_and_go(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    def seen() -> list[bool]:
        contents = service_status.read_status(deployment).contents
        return [worker.silent for worker in contents.workers] if contents else []

    assert "No worker is running." in service_status.read_status(deployment).faults()
    with running_worker(deployment) as process:
        wait_until(lambda: seen() == [False], what="the worker in the list")
        assert service_status.read_status(deployment).faults() == []
        process.terminate()
        process.wait(20.0)
        assert seen() == []


def test_a_worker_that_was_killed_is_silent_and_at_last_forgotten(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    with sessions.begin() as session:
        workers.report(session, settings, "killed")
        session.flush()
        (worker,) = workers.listed(session)
        worker.seen_at -= timedelta(seconds=3.0 * workers.report_seconds(settings))
    assert any("The worker killed has been silent" in fault for fault in service_status.read_status(settings).faults())
    with sessions.begin() as session:
        workers.listed(session)[0].seen_at -= timedelta(hours=1)
        session.flush()
        workers.report(session, settings, "other")
    with sessions() as session:
        assert [worker.name for worker in workers.listed(session)] == ["other"]


def test_a_clock_that_went_back_is_said_so_until_a_worker_has_run(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    with sessions.begin() as session:
        workers.report(session, settings, "killed")
        session.execute(update(SteadyClock).values(reading=database_time(session) + timedelta(seconds=3468.9)))
    found = service_status.read_status(settings)
    (sentence,) = (fault for fault in found.faults() if "clock" in fault)
    assert re.fullmatch(r"The database's clock has gone back by 34\d\d s, and no worker has run since\.", sentence)
    ClockKeeper(sessions, settings).look()
    assert [fault for fault in service_status.read_status(settings).faults() if "clock" in fault] == []


def test_what_does_not_answer_is_said_so(tmp_path: Path) -> None:
    database, broker = (f"{kind}://127.0.0.1:{free_port()}/0" for kind in ("postgresql", "redis"))
    found = service_status.read_status(Settings(data_dir=tmp_path, database_url=database, broker_url=broker))
    assert (found.queues, found.contents) == (None, None)
    assert found.faults() == ["The database cannot be reached.", "The broker cannot be reached."]


def test_a_database_of_another_version_is_said_so(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '0001'"))
    found = service_status.read_status(settings)
    assert found.contents is None
    assert "galloping migrate" in found.faults()[0]
