"""`galloping serve` as a whole: the job by HTTP, a clean end, and a start after everything was killed."""

import json
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from uuid import UUID

import httpx
import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from tests.documents import hasty_settings, history, long_request, short_request
from tests.embedded import serving, status, submit, wait_for
from tests.processes import group, kill_group, running
from tests.servers import free_port, wait_until


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    """Give settings of an embedded service with short times."""
    return hasty_settings(tmp_path)


@pytest.fixture
def sessions(settings: Settings) -> Iterator[sessionmaker[Session]]:
    """Give sessions on the service's database, which the service itself makes."""
    engine = make_engine(settings)
    yield session_factory(engine)
    engine.dispose()


def test_job_by_http_and_a_clean_end(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with serving(settings, free_port()) as (process, client):
        client.headers["X-Request-ID"] = "asset-17"
        location = submit(client, short_request())
        wait_for(client, location, "successful")
        rows = client.get(f"{location}/results/limit-cycles").raise_for_status().json()
        assert rows
        assert client.get("/health/live", headers={"X-A": "a" * 70_000}).status_code == 431
        start = time.monotonic()
        process.terminate()
        assert process.wait(20.0) == 0
        assert time.monotonic() - start < 15.0
        assert group(process) == []
    written = (settings.data_dir / "process.log").read_text().splitlines()
    lines = [json.loads(line) for line in written if line.startswith("{")]  # Celery prints a warning to root
    of_job = [line["event"] for line in lines if line.get("job_id") == location.rpartition("/")[2]]
    assert of_job == ["job begins", "job ends"]  # from the worker, under the id of the request to the API
    assert {line["request_id"] for line in lines if "job_id" in line} == {"asset-17"}


def test_next_start_goes_on_where_it_was(settings: Settings, sessions: sessionmaker[Session]) -> None:
    port = free_port()
    with serving(settings, port) as (process, client):
        interrupted = submit(client, long_request(4))
        wait_for_progress(client, interrupted, 1)
        queued = [submit(client, short_request()) for _ in range(3)]
        process.kill()
        process.wait()
        # The API gives up its port, and the worker ends, though nobody told them.
        wait_until(lambda: group(process) == [], 10.0, "the end of the orphans")
    with serving(settings, port) as (process, client):
        wait_for_progress(client, interrupted, 2)
        kill_group(process)
    with serving(settings, port) as (_, client):
        for location in (interrupted, *queued):
            wait_for(client, location, "successful")
        ids = [UUID(status(client, location)["id"]) for location in (interrupted, *queued)]
    assert [kind for kind, _ in history(sessions, ids[0])] == [
        "accepted",
        *("running", "released"),
        *("running", "released"),
        *("running", "successful"),
    ]
    for job_id in ids[1:]:
        assert [kind for kind, _ in history(sessions, job_id)].count("successful") == 1


def wait_for_progress(client: httpx.Client, location: str, attempt: int) -> None:
    def advanced() -> bool:
        job = status(client, location)
        return bool(job["attempt"] == attempt and 0.0 < job["progress"] < 1.0)

    wait_until(advanced, 60.0, f"progress of attempt {attempt}")


def test_api_that_cannot_start_ends_the_service_with_its_code(settings: Settings) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        with running(settings, "-m", "app.cli", "serve", "--port", str(port)) as second:
            assert second.wait(60.0) not in (0, None)
            assert group(second) == []
