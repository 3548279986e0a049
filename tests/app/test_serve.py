"""What `tests/e2e/test_serve.py` and `tests/migrations` leave of app.serve: a worker that dies, requests at a stop."""

import contextlib
import json
import os
import signal
import sqlite3
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest

from app.runtime.settings import Settings
from app.storage.migration import migrate
from tests.app.lines import SHORT
from tests.documents import short_request
from tests.embedded import is_ready, serving, submit, wait_for
from tests.processes import children, running
from tests.servers import free_port, wait_until


def test_worker_that_dies_is_started_again(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, sweep_seconds=0.3, worker_processes=1)
    with serving(settings, free_port()) as (process, client):
        before = children(process.pid)
        assert len(before) == 2
        (worker,) = [pid for pid in before if "worker" in Path(f"/proc/{pid}/cmdline").read_text().split("\0")]
        os.kill(worker, signal.SIGKILL)
        wait_until(lambda: len(children(process.pid)) == 2 and worker not in children(process.pid), what="another")
        wait_for(client, submit(client, short_request()), "successful")


@pytest.mark.parametrize("api_processes", [1, 2])
def test_streams_end_at_a_stop(tmp_path: Path, api_processes: int) -> None:
    settings = Settings(data_dir=tmp_path, api_processes=api_processes, shutdown_seconds=120.0)
    migrate(settings)
    port = free_port()
    address = f"http://127.0.0.1:{port}"
    with (
        running(settings, "-m", "app.serve", "127.0.0.1", str(port)) as process,
        httpx.Client(base_url=address, timeout=60.0) as client,
    ):
        wait_until(lambda: is_ready(client), 60.0, "readiness")
        job = submit(client, short_request())
        lines = {"lines": [short_request()["line"]], "analysis": SHORT}
        batch = client.post("/v1/batches", json=lines).headers["location"]
        with client.stream("GET", f"{job}/events") as first, client.stream("GET", f"{batch}/events") as second:
            streams = [first.iter_lines(), second.iter_lines()]
            seen = [next(lines) for lines in streams]
            process.terminate()
            rest = [line for lines in streams for line in lines]  # to their ends, which one cut off would not reach
        assert process.wait(20.0) in {0, -signal.SIGTERM}
        assert seen == ["event: accepted"] * 2
        assert not any(line.startswith("event: ") for line in rest)


@pytest.mark.parametrize("api_processes", [1, 2])
def test_what_comes_in_at_a_stop_is_taken_in(tmp_path: Path, api_processes: int) -> None:
    settings = Settings(data_dir=tmp_path, api_processes=api_processes, shutdown_seconds=120.0)
    migrate(settings)
    port, go_on = free_port(), threading.Event()
    line = json.dumps(short_request()["line"]).encode() + b"\n"
    headers = {"Content-Type": "application/x-ndjson", "Idempotency-Key": "order-17"}

    def slowly() -> Iterator[bytes]:
        yield json.dumps({"analysis": SHORT}).encode() + b"\n" + line
        go_on.wait(60.0)
        yield line

    def is_held() -> bool:
        with contextlib.closing(sqlite3.connect(tmp_path / "galloping.sqlite3")) as database:
            return bool(database.execute("SELECT count(*) FROM idempotency_keys").fetchone() == (1,))

    def are_stopping() -> bool:
        return (tmp_path / "process.log").read_text().count('"Shutting down"') == api_processes

    with (
        running(settings, "-m", "app.serve", "127.0.0.1", str(port)) as process,
        httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60.0) as client,
        ThreadPoolExecutor(1) as pool,
    ):
        wait_until(lambda: is_ready(client), 60.0, "readiness")
        posted = pool.submit(client.post, "/v1/batches", content=slowly(), headers=headers)
        wait_until(is_held, what="the key being held")
        process.terminate()
        wait_until(are_stopping, what="the stop")
        go_on.set()
        answer = posted.result()
        assert process.wait(20.0) in {0, -signal.SIGTERM}
    assert (answer.status_code, answer.json()["lines"]["accepted"]) == (202, 2)
