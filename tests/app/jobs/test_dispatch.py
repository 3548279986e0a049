import asyncio
import json
import socket
import time
from pathlib import Path
from uuid import UUID, uuid4

import pytest
import redis
from sqlalchemy.orm import Session, sessionmaker

from app.coalescing.grouped_calls import GroupedCalls
from app.jobs.dispatch import (
    QUEUE_NAME,
    TASK_NAME,
    BrokerUnavailable,
    Sender,
    celery_application,
    open_queue,
)
from app.runtime.settings import Settings
from tests.documents import add_job, look
from tests.in_process import send
from tests.servers import free_port
from tests.statements import counted


def on_broker(settings: Settings, address: str) -> Settings:
    return settings.model_copy(update={"broker_url": address})


def test_dispatch_hands_over_the_id_and_nothing_else(
    sessions: sessionmaker[Session], settings: Settings, redis_address: str
) -> None:
    job_id = add_job(sessions, {"line": {"secret": "of the utility"}})
    assert send(on_broker(settings, redis_address), job_id)
    with redis.Redis.from_url(redis_address) as client:
        (message,) = client.lrange(QUEUE_NAME, 0, -1)
    assert isinstance(message, bytes)
    headers = json.loads(message)["headers"]
    assert (headers["task"], headers["argsrepr"]) == (TASK_NAME, f"['{job_id}']")
    assert b"utility" not in message
    assert look(sessions, job_id).dispatched_at is not None


def test_embedded_broker_holds_the_message_as_a_file(
    sessions: sessionmaker[Session], settings: Settings, tmp_path: Path
) -> None:
    job_id = add_job(sessions)
    with open_queue(settings) as queue:
        assert queue.is_empty()
    assert send(settings, job_id)
    with open_queue(settings) as queue:
        assert not queue.is_empty()
    (message,) = (tmp_path / "broker" / "messages").iterdir()
    assert str(job_id) in message.read_text()


def test_redis_queue_tells_whether_messages_wait(
    sessions: sessionmaker[Session], settings: Settings, redis_address: str
) -> None:
    with open_queue(on_broker(settings, redis_address)) as queue:
        assert queue.is_empty()
        queue.send(add_job(sessions))
        assert not queue.is_empty()


def test_refusing_broker_leaves_the_job_to_the_sweeper(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions)
    assert not send(on_broker(settings, f"redis://127.0.0.1:{free_port()}/0"), job_id)
    assert look(sessions, job_id).dispatched_at is None


def sent_together(sessions: sessionmaker[Session], settings: Settings, count: int) -> list[UUID]:
    """Send jobs as the API does for its posts; return them."""
    jobs = [add_job(sessions) for _ in range(count)]
    sender = Sender(celery_application(settings), sessions)

    async def send_all() -> None:
        messages = GroupedCalls[UUID, bool]("messages", lambda job_ids: [sender.send(job_ids)] * len(job_ids))
        for job_id in jobs:
            messages.submit(job_id)
        await messages.close()

    asyncio.run(send_all())
    sender.close()
    return jobs


def test_jobs_of_a_group_are_sent_in_one_exchange_and_marked_in_one_statement(
    sessions: sessionmaker[Session], settings: Settings, redis_address: str
) -> None:
    with counted() as statements:
        jobs = sent_together(sessions, on_broker(settings, redis_address), 30)
    with redis.Redis.from_url(redis_address) as client:
        messages = [json.loads(text)["headers"]["id"] for text in client.lrange(QUEUE_NAME, 0, -1)]
    assert len(set(messages)) == 30
    assert all(look(sessions, job_id).dispatched_at is not None for job_id in jobs)
    assert len([text for text in statements if text.startswith("UPDATE")]) == 1


def test_a_group_that_cannot_be_sent_is_left_to_the_sweeper(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    jobs = sent_together(sessions, on_broker(settings, f"redis://127.0.0.1:{free_port()}/0"), 3)
    assert [look(sessions, job_id).dispatched_at for job_id in jobs] == [None] * 3


def test_silent_broker_does_not_hold_up_the_sender(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"redis://127.0.0.1:{silent.getsockname()[1]}/0"
        start = time.monotonic()
        assert not send(on_broker(settings, address), job_id)
        assert time.monotonic() - start < 5.0
    assert look(sessions, job_id).dispatched_at is None


def test_folder_that_cannot_be_made_counts_as_no_broker(settings: Settings, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    blocked = settings.model_copy(update={"data_dir": tmp_path / "file"})
    with pytest.raises(BrokerUnavailable, match="NotADirectoryError"), open_queue(blocked):
        pytest.fail("opened a queue in a file")


def test_database_that_fails_after_sending_leaves_the_job_to_the_sweeper(settings: Settings, tmp_path: Path) -> None:
    nowhere = settings.model_copy(update={"database_url": f"sqlite:///{tmp_path}/without-tables.sqlite3"})
    job_id = uuid4()
    assert not send(nowhere, job_id)


def test_a_message_comes_back_only_after_its_process_must_be_dead(settings: Settings, redis_address: str) -> None:
    for hard_limit in (60.0, 7200.0):
        limits = {"hard_time_limit_seconds": hard_limit, "soft_time_limit_seconds": 30.0}
        options = celery_application(on_broker(settings.model_copy(update=limits), redis_address)).conf
        assert options.broker_transport_options["visibility_timeout"] > hard_limit
