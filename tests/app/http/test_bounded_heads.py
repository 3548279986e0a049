"""Heads of requests, written byte by byte: those within the bounds are served, and others are not taken in."""

import contextlib
import json
import select
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import pytest
from starlette.types import Receive, Scope, Send

from app.http import bounded_heads
from app.http.bounded_heads import MOST_BYTES, MOST_FIELDS
from app.http.problems import MEDIA_TYPE, ProblemKind
from app.serve import HTTP
from tests.app import service

ENDLESS = 1 << 26  # what a client sends at most before a test fails, far above the buffers of two sockets
OWN_FIELDS = 1  # Host


@contextmanager
def connected(client: httpx.Client) -> Iterator[socket.socket]:
    with socket.create_connection((client.base_url.host, client.base_url.port or 80), timeout=20.0) as connection:
        yield connection


def head(*fields: str, target: str = "/health/live", method: str = "GET") -> bytes:
    return "\r\n".join([f"{method} {target} HTTP/1.1", "Host: 127.0.0.1", *fields, "", ""]).encode()


def rest(connection: socket.socket) -> bytes:
    """Return all that comes until the server ends the connection."""
    return b"".join(iter(lambda: connection.recv(65_536), b""))


def exchange(client: httpx.Client, request: bytes) -> bytes:
    with connected(client) as connection:
        connection.sendall(request)
        return rest(connection)


def statuses(answers: bytes) -> list[str]:
    return [part.split()[0].decode() for part in answers.split(b"HTTP/1.1 ")[1:]]


def endlessly(connection: socket.socket, piece: bytes) -> int:
    """Send a piece again and again until the server says something or ends; return how many bytes that took."""
    sent = 0
    while sent < ENDLESS and not select.select([connection], [], [], 0.0)[0]:
        try:
            connection.sendall(piece)
        except (BrokenPipeError, ConnectionResetError):
            break
        sent += len(piece)
    return sent


TOO_LARGE = {
    "a value": head("X-A: " + "a" * 300_000),
    "a value just beyond": head("X-A: " + "a" * MOST_BYTES),
    "a name": head("a" * 300_000 + ": 1"),
    "an address": head(target="/v1/jobs?cursor=" + "a" * 100_000),
    "many fields": head(*("a: b" for _ in range(20_000))),
    "a field too many": head(*("a: b" for _ in range(MOST_FIELDS - OWN_FIELDS + 1))),
    "many long fields": head(*("a: " + "b" * 1000 for _ in range(100))),
    "a post": head("X-A: " + "a" * 300_000, "Content-Length: 2", method="POST") + b"{}",
}


@pytest.mark.parametrize("request_", TOO_LARGE.values(), ids=TOO_LARGE)
def test_a_head_that_is_too_large_is_431(shared_client: httpx.Client, request_: bytes) -> None:
    answer = exchange(shared_client, request_)
    assert statuses(answer) == ["431"]
    fields, _, body = answer.partition(b"\r\n\r\n")
    assert f"content-type: {MEDIA_TYPE}" in fields.decode().lower()
    assert "connection: close" in fields.decode().lower()
    document = json.loads(body)
    assert (document["status"], document["type"]) == (431, "/problems/head-too-large")
    assert shared_client.get(document["type"]).json()["title"] == ProblemKind.HEAD_TOO_LARGE.title


WITHIN = {
    "a long value": head("X-A: " + "a" * (MOST_BYTES - 200), "Connection: close"),
    "many fields": head(*("a: b" for _ in range(MOST_FIELDS - OWN_FIELDS - 1)), "Connection: close"),
}


@pytest.mark.parametrize("request_", WITHIN.values(), ids=WITHIN)
def test_a_head_within_the_bound_is_served(shared_client: httpx.Client, request_: bytes) -> None:
    assert statuses(exchange(shared_client, request_)) == ["200"]


def test_each_request_of_a_connection_has_the_bound_for_itself(shared_client: httpx.Client) -> None:
    long = "X-A: " + "a" * 40_000
    body = b" " * 300_000
    post = head(
        long,
        "Content-Type: application/json",
        f"Content-Length: {len(body)}",
        target="/v1/jobs",
        method="POST",
    )
    requests = head(long) * 3 + post + body + head(long) + head(long, "Connection: close")
    assert statuses(exchange(shared_client, requests)) == ["200", "200", "200", "422", "200", "200"]


def test_a_head_that_comes_byte_by_byte_is_served(shared_client: httpx.Client) -> None:
    with connected(shared_client) as connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in head("Connection: close"):
            connection.sendall(bytes([byte]))
        assert statuses(rest(connection)) == ["200"]


def test_a_head_without_end_is_ended(shared_client: httpx.Client) -> None:
    with connected(shared_client) as connection:
        connection.sendall(b"GET /health/live HTTP/1.1\r\nX-A: ")
        assert endlessly(connection, b"a" * 65_536) < ENDLESS
        assert statuses(rest(connection)) == ["431"]


CHUNKS = head("Content-Type: application/json", "Transfer-Encoding: chunked", target="/v1/jobs", method="POST")


@pytest.mark.parametrize("begin", [b"2;a=", b"2\r\n{}\r\n0\r\nX-A: "], ids=["extension", "trailer"])
def test_what_is_no_part_of_a_body_has_an_end_within_it_too(shared_client: httpx.Client, begin: bytes) -> None:
    with connected(shared_client) as connection:
        connection.sendall(CHUNKS + begin)
        assert endlessly(connection, b"a" * 65_536) < ENDLESS
    assert shared_client.get("/health/live").status_code == 200


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a head take half a second at most."""
    monkeypatch.setattr("app.http.bounded_heads._HEAD_SECONDS", 0.5)


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("before", [b"", head()], ids=["first", "second"])
@pytest.mark.parametrize("begun", [b"", b"G", b"GET /health/live HTTP/1.1\r\nHost: a\r\nX-A: a"])
def test_a_head_that_does_not_come_to_its_end_is_not_waited_for(
    shared_client: httpx.Client, before: bytes, begun: bytes
) -> None:
    with connected(shared_client) as connection:
        connection.sendall(before + begun)
        assert statuses(rest(connection)) == ["200"] * bool(before)


@pytest.mark.usefixtures("impatient")
def test_a_head_is_not_lengthened_by_a_byte_now_and_then(shared_client: httpx.Client) -> None:
    with connected(shared_client) as connection:
        connection.sendall(b"GET /health/live HTTP/1.1\r\nX-A: ")
        for _ in range(200):
            if select.select([connection], [], [], 0.1)[0]:
                break
            connection.sendall(b"a")
        assert rest(connection) == b""


@pytest.mark.usefixtures("impatient")
def test_only_heads_have_to_hurry(shared_client: httpx.Client) -> None:
    post = head("Content-Type: application/json", "Content-Length: 2", target="/v1/jobs", method="POST")
    with connected(shared_client) as connection:
        for last in (head(), head("Connection: close")):
            connection.sendall(post)
            time.sleep(1.0)
            connection.sendall(b"{}" + last)
        assert statuses(rest(connection)) == ["422", "200", "422", "200"]


LARGE = 1 << 26


async def large(scope: Scope, receive: Receive, send: Send) -> None:
    """Answer with more than the buffers of two sockets hold."""
    if scope["type"] != "http":
        raise RuntimeError("no lifespan here")
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"%d" % LARGE)]})
    await send({"type": "http.response.body", "body": bytes(LARGE)})


def test_a_client_that_takes_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded_heads, "_STALLED_SECONDS", 0.5)
    with service.serving(large, http=HTTP) as client, connected(client) as connection:
        connection.sendall(head())
        connection.recv(1)
        time.sleep(2.0)
        with contextlib.suppress(ConnectionResetError):
            assert len(rest(connection)) < LARGE


def test_a_client_that_takes_little_by_little_gets_everything(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded_heads, "_STALLED_SECONDS", 1.0)
    with service.serving(large, http=HTTP) as client, connected(client) as connection:
        connection.sendall(head("Connection: close"))
        taken = 0
        for _ in range(20):
            taken += len(connection.recv(1 << 21, socket.MSG_WAITALL))
            time.sleep(0.15)
        assert taken + len(rest(connection)) > LARGE
