"""What others wait while clients send or read slowly: `python -m benchmarks.slow_clients`, `--write` for the page.

The embedded service on SQLite, in processes of its own. Slow clients are plain sockets of this process.
"""

import contextlib
import json
import socket
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Event, Thread
from uuid import UUID

import httpx
from sqlalchemy import insert, select

from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.tables import PointRow
from benchmarks.reliability_figures import report
from tests import embedded
from tests.documents import short_request
from tests.servers import free_port

POINTS = 3_000
TRIES = 10
SILENT, TRICKLING, STALLED = 6, 4, (16, 45)
_NDJSON = {"Content-Type": "application/x-ndjson"}
_HEAD = "Host: 127.0.0.1\r\nContent-Type: application/x-ndjson\r\nTransfer-Encoding: chunked\r\n\r\n"
_BYTE_SECONDS = 1.0
_PATIENCE_SECONDS = 120.0


def main() -> None:
    """Print and write what others wait."""
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(data_dir=Path(folder))
        with embedded.serving(settings, free_port()) as (_, client):
            client.timeout = httpx.Timeout(_PATIENCE_SECONDS)
            report("slow clients", {**_of_senders(client), **_of_readers(client, settings)})


def _of_senders(client: httpx.Client) -> dict[str, str]:
    found = {"a batch of 3 lines while nobody is slow": _times(lambda: _batch(client))}
    with _begun(client, SILENT):
        found[f"the same beside {SILENT} that began a batch and send nothing"] = _times(lambda: _batch(client))
    with _begun(client, TRICKLING) as senders, _trickling(senders):
        begun = time.perf_counter()
        found[f"the same beside {TRICKLING} that send a byte a second"] = _times(lambda: _batch(client))
        answer = senders[0].recv(12)
        found["a sender of a byte a second is answered"] = (
            f"{answer[9:].decode()} after {time.perf_counter() - begun:.0f} s"
        )
    return found


def _of_readers(client: httpx.Client, settings: Settings) -> dict[str, str]:
    location = embedded.submit(client, short_request())
    embedded.wait_for(client, location, "successful")
    _enlarge(settings, UUID(location.rpartition("/")[2]))
    found = {"a status while nobody is slow": _times(lambda: client.get(location))}
    for count in STALLED:
        with _stalled(client, f"{location}/results", count):
            found[f"a status beside {count} that read nothing of {POINTS:,} points"] = _times(
                lambda: client.get(location)
            )
    return found


def _times(act: Callable[[], httpx.Response]) -> str:
    seconds = []
    for _ in range(TRIES):
        begun = time.perf_counter()
        act().raise_for_status()
        seconds.append(time.perf_counter() - begun)
    return f"median {statistics.median(seconds):.3f} s, longest {max(seconds):.3f}"


def _batch(client: httpx.Client) -> httpx.Response:
    document = short_request()
    texts = [json.dumps({"analysis": document["analysis"]}), *[json.dumps(document["line"])] * 3]
    return client.post("/v1/batches/estimate", content="\n".join(texts), headers=_NDJSON)


@contextlib.contextmanager
def _connections(client: httpx.Client, count: int) -> Iterator[list[socket.socket]]:
    with contextlib.ExitStack() as stack:
        made = [stack.enter_context(socket.socket()) for _ in range(count)]
        for connection in made:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.settimeout(_PATIENCE_SECONDS)
            connection.connect((client.base_url.host, client.base_url.port or 80))
        yield made


@contextlib.contextmanager
def _begun(client: httpx.Client, count: int) -> Iterator[list[socket.socket]]:
    """Begin batches and send their first line only."""
    first = json.dumps({"analysis": short_request()["analysis"]}) + "\n"
    with _connections(client, count) as made:
        for connection in made:
            connection.sendall(f"POST /v1/batches HTTP/1.1\r\n{_HEAD}{len(first):x}\r\n{first}\r\n".encode())
        yield made


@contextlib.contextmanager
def _trickling(connections: list[socket.socket]) -> Iterator[None]:
    ended = Event()

    def send() -> None:
        while not ended.wait(_BYTE_SECONDS):
            for connection in connections:
                with contextlib.suppress(OSError):
                    connection.sendall(b"1\r\n \r\n")

    thread = Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@contextlib.contextmanager
def _stalled(client: httpx.Client, target: str, count: int) -> Iterator[None]:
    """Ask for an answer many times over, and read only that it begins."""
    with _connections(client, count) as made:
        for connection in made:
            connection.sendall(f"GET {target} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
        for connection in made:
            assert connection.recv(12) == b"HTTP/1.1 200"
        yield


def _enlarge(settings: Settings, job_id: UUID) -> None:
    """Give a job the result of its point many times over."""
    engine = make_engine(settings)
    with session_factory(engine).begin() as session:
        stored = select(PointRow.__table__).where(PointRow.job_id == job_id)
        row = dict(session.execute(stored).mappings().one())
        session.execute(insert(PointRow), [{**row, "point": point} for point in range(1, POINTS)])
    engine.dispose()


if __name__ == "__main__":
    main()
