"""A service that fails in the ways of the real one behind a bad network, scripted: what the client does about it."""

import contextlib
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from app.answers.jobs import JobDocument
from app.client import Client, ServiceError
from app.reference.source_lines import example
from app.schemas.fields import example_of
from tests.servers import free_port

ACCEPTED = JobDocument.model_validate(example_of(JobDocument)).model_dump_json().encode()
HANG_UP = 0


class Scripted(BaseHTTPRequestHandler):
    """Answers with the next status of the script, and notes the key and the body of every request."""

    script: list[int]
    retry_after: str
    seen: list[tuple[str, bytes]]

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.seen.append((self.headers["Idempotency-Key"], body))
        status = self.script.pop(0)
        if status == HANG_UP:
            self.close_connection = True
            return
        self.send_response(status)
        self.send_header("Retry-After", self.retry_after)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(ACCEPTED)))
        self.end_headers()
        self.wfile.write(ACCEPTED)

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the name that the base class gives
        pass


@contextlib.contextmanager
def scripted(*script: int, retry_after: str = "0") -> Iterator[tuple[str, list[tuple[str, bytes]]]]:
    seen: list[tuple[str, bytes]] = []
    handler = type("Handler", (Scripted,), {"script": list(script), "retry_after": retry_after, "seen": seen})
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}", seen
        finally:
            server.shutdown()
            thread.join()


def test_a_post_is_tried_again_under_its_key() -> None:
    with scripted(HANG_UP, 503, 429, 409, 202) as (address, seen), Client(address) as client:
        assert client.submit(example("c11-twin")).id
        assert len(seen) == 5
        assert len(set(seen)) == 1
    with scripted(202, 202) as (address, seen), Client(address) as client:
        client.submit(example("c11-twin"))
        client.submit(example("c11-twin"))
        assert len({key for key, _ in seen}) == 2


def test_a_batch_is_sent_whole_at_every_try() -> None:
    with scripted(HANG_UP, 503, 500) as (address, seen), Client(address) as client:
        with pytest.raises(ServiceError, match="500"):
            client.submit_batch(example("c11-twin") for _ in range(10))
        assert len(set(seen)) == 1
        assert seen[0][1].count(b"\n") == 11


@pytest.mark.parametrize("status", [400, 401, 403, 404, 500])
def test_what_another_try_does_not_change_is_not_tried_again(status: int) -> None:
    with scripted(status) as (address, seen), Client(address) as client:
        with pytest.raises(ServiceError, match=str(status)):
            client.submit(example("c11-twin"))
        assert len(seen) == 1


def test_patience_has_an_end() -> None:
    address = f"http://127.0.0.1:{free_port()}"
    with Client(address, patience_seconds=0.3) as client, pytest.raises(ServiceError, match="does not answer"):
        client.job("a")
    with scripted(*[503] * 50) as (busy, seen), Client(busy, patience_seconds=0.5) as client:
        with pytest.raises(ServiceError, match="503"):
            client.submit(example("c11-twin"))
        assert len(seen) > 1


@pytest.mark.parametrize("status", [429, 502, 503, 504, 409])
def test_another_try_waits_as_long_as_is_asked_for(monkeypatch: pytest.MonkeyPatch, status: int) -> None:
    pauses: list[float] = []
    monkeypatch.setattr("app.client.connection.time.sleep", pauses.append)
    with scripted(status, 202, retry_after="7") as (address, _), Client(address) as client:
        assert client.submit(example("c11-twin")).id
    assert pauses == [7.0]
    with scripted(status, 202, retry_after="7") as (address, seen), Client(address, patience_seconds=3.0) as client:
        client.submit(example("c11-twin"))
        assert len(seen) == 2
    assert 0.0 < pauses[1] <= 3.0  # the last try comes at the end of patience


def test_an_address_that_is_none_is_refused_at_once() -> None:
    with pytest.raises(ServiceError, match="not the address of a service"), Client("ftp://host") as client:
        client.job("a")
