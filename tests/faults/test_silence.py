"""Those that are there and do not answer: a Redis that accepts connections, and a worker that comes back too late."""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import redis
from sqlalchemy.orm import Session, sessionmaker

from app.client import Client
from app.runtime.settings import Settings
from app.tables import JobStatus
from tests.documents import add_job, count_points, history, long_request, look, short_request
from tests.faults import figures
from tests.faults.deployment import deployed
from tests.in_process import send
from tests.processes import busy_child, children, running_worker
from tests.servers import wait_until

POSTS = 20
LONGEST_POST_SECONDS = 10.0
LONGEST_SECONDS = 120.0


@contextmanager
def frozen(*processes: int) -> Iterator[None]:
    """Keep processes from running, and let them go on."""
    for process in processes:
        os.kill(process, signal.SIGSTOP)
    try:
        yield
    finally:
        for process in processes:
            os.kill(process, signal.SIGCONT)


def test_a_redis_that_never_answers_delays_posts_and_loses_none(tmp_path: Path) -> None:
    seconds, accepted = [], []
    with deployed(tmp_path, workers=1) as service, Client(service.address) as client:
        with redis.Redis.from_url(service.settings.broker_url) as broker:
            process = int(broker.info("server")["process_id"])
        with frozen(process):
            for _ in range(POSTS):
                begin = time.monotonic()
                accepted.append(client.submit_document(short_request()))
                seconds.append(time.monotonic() - begin)
        begin = time.monotonic()
        for job in accepted:
            assert client.wait(job, seconds=LONGEST_SECONDS).status == "successful"
        end = time.monotonic()
    assert max(seconds) < LONGEST_POST_SECONDS
    figures.note(
        "silent Redis",
        {
            "posts, all accepted and successful": POSTS,
            "longest post, s": round(max(seconds), 2),
            "from the first answer of Redis to the last end, s": round(end - begin, 1),
        },
    )


@pytest.mark.parametrize("deployment", ["production"], indirect=True)
def test_a_zombies_late_result_is_dropped(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    points = 4
    with running_worker(deployment) as zombie:
        job_id = add_job(deployed, long_request(points))
        assert send(deployment, job_id)
        wait_until(lambda: look(deployed, job_id).progress > 0.0, 60.0, "progress")
        (pool,) = children(zombie.pid)
        with frozen(zombie.pid, pool, busy_child(zombie)), running_worker(deployment):
            wait_until(lambda: look(deployed, job_id).status is JobStatus.SUCCESSFUL, 90.0, "the end of the job")
            ended = look(deployed, job_id).finished_at
        log = deployment.data_dir / "process.log"
        wait_until(lambda: "this attempt are dropped" in log.read_text(), 60.0, "the zombie's end of the job")
    assert history(deployed, job_id) == [
        ("accepted", 0),
        ("running", 1),
        ("released", 1),
        ("running", 2),
        ("successful", 2),
    ]
    assert look(deployed, job_id).finished_at == ended
    assert count_points(deployed, job_id) == points
