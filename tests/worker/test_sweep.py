from pathlib import Path

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.jobs.dispatch import open_queue
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.tables import JobStatus
from tests.batch_rows import add_batch
from tests.documents import STRANGER, add_job, create_job, look
from tests.servers import free_port
from worker.sweep import ClockKeeper, call_next, release, sweep


@pytest.fixture
def eager(settings: Settings) -> Settings:
    """Give settings under which a new job is the sweeper's at once."""
    return settings.model_copy(update={"sweep_seconds": 1e-9})


def messages(folder: Path) -> list[str]:
    return [path.read_text() for path in (folder / "broker" / "messages").iterdir()]


def test_unsent_jobs_are_sent_once(sessions: sessionmaker[Session], eager: Settings, tmp_path: Path) -> None:
    made = [add_job(sessions) for _ in range(3)]
    assert sweep(sessions, eager) == 3
    assert sweep(sessions, eager) == 0
    assert len(messages(tmp_path)) == 3
    for job_id in made:
        assert sum(str(job_id) in message for message in messages(tmp_path)) == 1
        assert look(sessions, job_id).dispatched_at is not None


def test_expired_lease_goes_back_and_is_sent(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        leases.claim(session, job_id, "gone", -1.0)
    ClockKeeper(sessions, settings).look()
    assert sweep(sessions, settings) == 1
    job = look(sessions, job_id)
    assert (job.status, job.attempt) == (JobStatus.ACCEPTED, 1)
    assert job.dispatched_at is not None


def test_dispatch_that_failed_is_made_good_when_the_broker_is_back(
    sessions: sessionmaker[Session], eager: Settings, redis_address: str
) -> None:
    job_id = add_job(sessions)
    down = eager.model_copy(update={"broker_url": f"redis://127.0.0.1:{free_port()}/0"})
    assert sweep(sessions, down) == 0
    assert look(sessions, job_id).dispatched_at is None
    back = eager.model_copy(update={"broker_url": redis_address})
    assert sweep(sessions, back) == 1
    with open_queue(back) as queue:
        assert not queue.is_empty()


def test_message_that_was_lost_is_sent_again(sessions: sessionmaker[Session], eager: Settings, tmp_path: Path) -> None:
    job_id = add_job(sessions)
    impatient = eager.model_copy(update={"redispatch_seconds": 1e-9})
    assert sweep(sessions, impatient) == 1
    assert sweep(sessions, impatient) == 0  # the message is still there
    for path in (tmp_path / "broker" / "messages").iterdir():
        path.unlink()
    assert sweep(sessions, impatient) == 1
    assert str(job_id) in messages(tmp_path)[0]


def test_broker_that_fails_midway_leaves_the_rest_unsent(
    sessions: sessionmaker[Session], eager: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = add_job(sessions), add_job(sessions)
    folder = tmp_path / "broker" / "messages"
    take = leases.take_undispatched

    def take_and_break(session: Session, settings: Settings, *, queue_is_empty: bool, chunks: bool) -> list[object]:
        taken = take(session, settings, queue_is_empty=queue_is_empty, chunks=chunks)
        if not chunks:
            folder.rename(folder.with_name("gone"))  # the broker goes away between the look and the sending
        return list(taken)

    monkeypatch.setattr(leases, "take_undispatched", take_and_break)
    assert sweep(sessions, eager) == 0
    assert [look(sessions, job_id).dispatched_at for job_id in (first, second)] == [None, None]


def test_release_gives_back_only_what_is_lost(sessions: sessionmaker[Session], settings: Settings) -> None:
    lost, held = add_job(sessions), add_job(sessions)
    with sessions.begin() as session:
        leases.claim(session, lost, "dead", 60.0)
        leases.claim(session, held, "living", 60.0)
    assert release(sessions, settings) == 0
    assert release(sessions, settings, "dead") == 1
    assert look(sessions, held).status is JobStatus.RUNNING


def test_jobs_of_an_owner_who_runs_as_many_as_he_may_wait_without_messages(
    sessions: sessionmaker[Session], eager: Settings, tmp_path: Path
) -> None:
    bounded = eager.model_copy(update={"running_jobs_per_owner": 1})
    running, waiting = add_job(sessions), add_job(sessions)
    with sessions.begin() as session:
        held = leases.claim(session, running, "here", 60.0)
        stranger = create_job(session, STRANGER, {"line": {}}).id
    assert held is not None
    assert sweep(sessions, bounded) == 1
    assert [str(stranger) in message for message in messages(tmp_path)] == [True]
    with sessions.begin() as session:
        assert leases.dismiss(session, held)
    assert sweep(sessions, bounded) == 1
    assert str(waiting) in "".join(messages(tmp_path))


def test_the_next_job_is_called_where_no_message_waits(
    sessions: sessionmaker[Session], settings: Settings, tmp_path: Path
) -> None:
    call_next(sessions, settings, LOCAL.owner)
    assert messages(tmp_path) == [], "nothing waits"
    first, _ = add_job(sessions), add_job(sessions)
    call_next(sessions, settings, STRANGER.owner)
    assert messages(tmp_path) == []
    for _ in range(2):
        call_next(sessions, settings, LOCAL.owner)
    (message,) = messages(tmp_path)
    assert str(first) in message, "the second call found it"


def test_a_chunk_is_called_by_the_queue_of_chunks(
    sessions: sessionmaker[Session], settings: Settings, tmp_path: Path
) -> None:
    add_batch(sessions, 1)
    call_next(sessions, settings, LOCAL.owner)
    with open_queue(settings) as queue:
        assert (queue.length(), queue.length(chunk=True)) == (0, 1)
