"""The whole embedded service, `galloping serve`, and its client in tests."""

import contextlib
from collections.abc import Iterator
from typing import Any

import httpx

from app.runtime.settings import Settings
from tests.processes import Process, running
from tests.servers import wait_until


@contextlib.contextmanager
def serving(settings: Settings, port: int) -> Iterator[tuple[Process, httpx.Client]]:
    arguments = ["serve", "--port", str(port), "--data-dir", str(settings.data_dir)]
    address = f"http://127.0.0.1:{port}"
    with running(settings, "-m", "app.cli", *arguments) as process, httpx.Client(base_url=address) as client:
        wait_until(lambda: is_ready(client), 60.0, "readiness")
        yield process, client


def is_ready(client: httpx.Client) -> bool:
    try:
        return client.get("/health/ready").status_code == 200
    except httpx.TransportError:
        return False


def submit(client: httpx.Client, document: dict[str, Any]) -> str:
    answer = client.post("/v1/jobs", json=document)
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def status(client: httpx.Client, location: str) -> dict[str, Any]:
    found: dict[str, Any] = client.get(location).raise_for_status().json()
    return found


def wait_for(client: httpx.Client, location: str, state: str) -> None:
    wait_until(lambda: status(client, location)["status"] == state, 90.0, state)
