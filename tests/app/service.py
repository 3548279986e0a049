"""The real application behind a real server on a free loopback port, for tests that speak HTTP."""

import contextlib
import socket
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import uvicorn
from starlette.types import ASGIApp

from app.main import create_app
from app.runtime.settings import Settings
from app.serve import HTTP
from app.storage.migration import migrate
from tests.documents import short_request
from tests.in_process import run_job
from tests.servers import wait_until


@contextlib.contextmanager
def running(settings: Settings) -> Iterator[httpx.Client]:
    """Serve the application with these settings on a migrated database, and give a client of it."""
    migrate(settings)
    with serving(create_app(settings), http=HTTP) as client:
        yield client


@contextlib.contextmanager
def serving(app: ASGIApp, **options: Any) -> Iterator[httpx.Client]:
    """Serve an application on a free loopback port in a thread, and give a client of it."""
    plain: dict[str, Any] = {"log_config": None, "ws": "none", "proxy_headers": False, "timeout_graceful_shutdown": 5}
    server = uvicorn.Server(uvicorn.Config(app, **plain, **options))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
        thread.start()
        try:
            wait_until(lambda: server.started, what="the server")
            with httpx.Client(base_url=f"http://127.0.0.1:{listener.getsockname()[1]}", timeout=60.0) as client:
                yield client
        finally:
            server.should_exit = True
            thread.join(30.0)


def sqlite_settings(directory: Path, **changes: Any) -> Settings:
    """Return settings whose every file lies in a directory."""
    return Settings(data_dir=directory, **changes)


ANEW = {"Cache-Control": "no-cache"}  # equal requests of other tests are not to answer this one


def submit(client: httpx.Client, document: dict[str, Any] | None = None) -> dict[str, Any]:
    """Post a request and return the status document."""
    answer = client.post("/v1/jobs", json=document or short_request(), headers=ANEW)
    assert answer.status_code == 202, answer.text
    status: dict[str, Any] = answer.json()
    return status


def finished(client: httpx.Client, settings: Settings, document: dict[str, Any] | None = None) -> str:
    """Post a request, work it off in this process with the real engine, and return the address of its status."""
    status = submit(client, document)
    run_job(settings, UUID(status["id"]))
    return f"/v1/jobs/{status['id']}"


def chunks(client: httpx.Client, address: str, status: str = "accepted") -> list[UUID]:
    """Return the ids of a batch's chunks in a state."""
    query = {"batch_id": address.rpartition("/")[2], "status": status}
    return [UUID(job["id"]) for job in client.get("/v1/jobs", params=query).json()["jobs"]]


def work_off(client: httpx.Client, settings: Settings, address: str) -> dict[str, Any]:
    """Work off the chunks of a batch that wait, in this process with the real engine, and return its status."""
    for chunk in chunks(client, address):
        run_job(settings, chunk)
    status: dict[str, Any] = client.get(address).json()
    return status


def submit_as(client: httpx.Client, header: dict[str, str]) -> str:
    """Post a request with a key, and return the job's id."""
    job: str = client.post("/v1/jobs", json=short_request(), headers={**header, **ANEW}).raise_for_status().json()["id"]
    return job
