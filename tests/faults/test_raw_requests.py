"""Requests that no client library sends, written byte by byte: line breaks in headers, bodies that hold requests."""

import logging
import socket
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.app import service
from tests.servers import wait_until

MISSING = "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"
EVIL = "Set-Cookie: evil=1"
SMUGGLED = "GET /v1/batches HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """Give a client of a service of this file's own."""
    own: Path = tmp_path_factory.mktemp("raw")
    with service.running(service.sqlite_settings(own)) as running:
        yield running


def exchange(client: httpx.Client, request: str) -> list[str]:
    """Send bytes as they stand, and return the heads of all answers that come until the server is done with them."""
    with socket.create_connection((client.base_url.host, client.base_url.port or 80), timeout=10.0) as connection:
        connection.sendall(request.encode("latin-1"))
        got = b"".join(iter(lambda: connection.recv(65_536), b"")).decode("latin-1")
    return [f"HTTP/1.1 {part}".partition("\r\n\r\n")[0] for part in got.split("HTTP/1.1 ")[1:]]


def head(target: str = "/v1/jobs", *lines: str, method: str = "GET") -> str:
    return "\r\n".join([f"{method} {target} HTTP/1.1", "Host: 127.0.0.1", "Connection: close", *lines, "", ""])


BREAKS = {"line feed": "\n", "carriage return": "\r", "both": "\r\n ", "tab and feed": "\t\n", "nul": "\0"}


@pytest.mark.parametrize(
    "name", ["X-Request-ID", "Prefer", "Idempotency-Key", "traceparent", "If-None-Match", "Accept"]
)
@pytest.mark.parametrize("line_break", BREAKS.values(), ids=BREAKS)
def test_a_break_in_a_header_is_refused(client: httpx.Client, name: str, line_break: str) -> None:
    for target in ("/v1/jobs", MISSING, "/health/live"):
        (answer,) = exchange(client, head(target, f"{name}: wait=1{line_break}{EVIL}"))
        assert answer.startswith("HTTP/1.1 400 ")
        assert "evil" not in answer


ENCODED = ["%0d%0a", "%0a", "%E5%98%8A%E5%98%8D", "\u0085", "\\r\\n", "%00"]


@pytest.mark.parametrize("line_break", ENCODED)
def test_a_break_that_is_written_otherwise_opens_no_header(client: httpx.Client, line_break: str) -> None:
    text = f"a{line_break}{EVIL}".replace(" ", "%20")
    requests = [head("/v1/jobs", f"{name}: {text}") for name in ("X-Request-ID", "Idempotency-Key", "Last-Event-ID")]
    requests += [head(f"/v1/jobs{target}{text}") for target in ("/", "?asset_id=", "?cursor=", "?tag=a:", "?nothing=")]
    requests += [head(f"/v1/{text}/jobs"), head(f"/problems/{text}"), head(f"/v1/conductors?search={text}")]
    for request in requests:
        (answer,) = exchange(client, request)
        assert answer.split()[1] in {"200", "400", "404"}, answer
        assert "evil" not in answer, answer


@pytest.mark.parametrize("given", ["a b", "a;b", "<script>", "\u00e4", "a" * 129, "", "{}"])
def test_an_id_that_is_not_plain_is_not_sent_back(client: httpx.Client, given: str) -> None:
    (answer,) = exchange(client, head("/health/live", f"X-Request-ID: {given}"))
    (line,) = [line for line in answer.split("\r\n") if line.lower().startswith("x-request-id: ")]
    assert len(line) == len("x-request-id: ") + 36


JSON = "Content-Type: application/json"
SMUGGLING = {
    "two lengths": head("/v1/jobs", JSON, "Content-Length: 2", "Content-Length: 60", method="POST") + "{}" + SMUGGLED,
    "length and chunks": head("/v1/jobs", JSON, "Content-Length: 6", "Transfer-Encoding: chunked", method="POST")
    + "0\r\n\r\n"
    + SMUGGLED,
    "two encodings": head("/v1/jobs", JSON, "Transfer-Encoding: chunked", "Transfer-Encoding: x", method="POST")
    + "0\r\n\r\n"
    + SMUGGLED,
    "a negative length": head("/v1/jobs", JSON, "Content-Length: -1", method="POST") + "{}" + SMUGGLED,
    "a negative chunk": head("/v1/batches", JSON, "Transfer-Encoding: chunked", method="POST") + "-5\r\n{}" + SMUGGLED,
    "a space before the colon": head("/v1/jobs", "Content-Length : 5", method="POST") + SMUGGLED,
    "a line that is no header": head("/v1/jobs", "evil") + SMUGGLED,
}


@pytest.mark.parametrize("request_", SMUGGLING.values(), ids=SMUGGLING)
def test_a_request_within_a_request_is_not_answered(client: httpx.Client, request_: str) -> None:
    (answer,) = exchange(client, request_)
    assert answer.startswith("HTTP/1.1 400 ")


@pytest.mark.parametrize("target", ["http://evil.example/v1/jobs", "//evil.example/v1/jobs", "evil.example:443", "*"])
def test_another_host_in_the_request_line_gets_nowhere(client: httpx.Client, target: str) -> None:
    for answer in exchange(client, head(target)):
        assert answer.split()[1] in {"200", "400", "401", "404", "405"}
        assert "evil" not in answer


@pytest.mark.parametrize("media_type", ["application/json", "application/x-ndjson", "text/csv"])
def test_a_sender_who_leaves_is_no_defect(
    client: httpx.Client, caplog: pytest.LogCaptureFixture, media_type: str
) -> None:
    caplog.set_level(logging.INFO)
    with socket.create_connection((client.base_url.host, client.base_url.port or 80)) as connection:
        lines = (f"Content-Type: {media_type}", "Content-Length: 100000")
        connection.sendall((head("/v1/batches", *lines, method="POST") + "{").encode())
    wait_until(
        lambda: [record for record in caplog.records if record.name == "app.http.request_log"],
        what="the request's line",
    )
    assert [record for record in caplog.records if record.levelno >= logging.ERROR] == []


def test_the_service_goes_on(client: httpx.Client) -> None:
    assert client.get("/health/ready").status_code == 200
