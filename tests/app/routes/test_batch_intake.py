"""Batches whose senders are slow, beside batches of others."""

import contextlib
import select
import socket
from collections.abc import Iterator
from pathlib import Path

import httpx

from app.reference.source_lines import example
from tests.app import service
from tests.app.lines import SHORT
from tests.servers import wait_until

TWIN = example("c11-twin")
SENDERS = 8  # twice as many as are read at once


@contextlib.contextmanager
def silent_senders(client: httpx.Client, media_type: str) -> Iterator[list[socket.socket]]:
    """Begin batches and send no more than their first byte."""
    head = (
        f"POST /v1/batches HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: {media_type}\r\nContent-Length: 1000\r\n\r\n{{"
    )
    with contextlib.ExitStack() as stack:
        address = client.base_url.host, client.base_url.port or 80
        connections = [stack.enter_context(socket.create_connection(address, 20.0)) for _ in range(SENDERS)]
        for connection in connections:
            connection.sendall(head.encode())
        yield connections


def test_silent_senders_hold_up_nobody_and_are_told(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, silent_body_seconds=6.0)
    with (
        service.running(settings) as client,
        silent_senders(client, "application/x-ndjson") as connections,
    ):
        assert client.post("/v1/batches", json={"lines": [TWIN], "analysis": SHORT}).status_code == 202
        assert not select.select(connections, [], [], 0.0)[0], "the silent ones were to be waiting still"
        for connection in connections:
            answered = rest(connection)
            assert answered.startswith(b"HTTP/1.1 408 ")
            assert b"/problems/too-slow" in answered


def rest(connection: socket.socket) -> bytes:
    return b"".join(iter(lambda: connection.recv(65_536), b""))


def test_an_owner_has_half_of_the_places(tmp_path: Path) -> None:
    with (
        service.running(service.sqlite_settings(tmp_path, senders_at_once=2 * SENDERS)) as client,
        silent_senders(client, "application/x-ndjson"),
    ):
        wait_until(lambda: refused(client), what="a refusal")


def refused(client: httpx.Client) -> bool:
    answer = client.post("/v1/batches/estimate", json={"lines": [TWIN], "analysis": SHORT})
    if answer.status_code == 200:
        return False
    assert (answer.status_code, answer.json()["type"]) == (429, "/problems/busy")
    assert answer.headers["retry-after"] == "5"
    return True
