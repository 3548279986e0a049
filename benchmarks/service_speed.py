"""The service against the engine alone: a batch through HTTP, queue, workers and database; posts and reads under load.

PostgreSQL and Redis are private instances on loopback, the API and the workers processes of their own.
"""

import asyncio
import contextlib
import json
import signal
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from app import processes, schemas
from app.convert.assemble import SoundParts, gather
from app.examples import example
from app.serve import migrate
from app.settings import Settings
from benchmarks.engine_speed import STACK
from engine.analysis import analyse_stack
from engine.spec import Analysis, Line
from tests.servers import free_port, postgres_server, redis_server

CLIENTS = 50
POSTS = 1000
READ_SECONDS = 5.0
WARM_LINES = 64
STANDARD: dict[str, Any] = {
    "loops": [1, 2],
    "models": ["hybrid", "finite_element"],
    "finite_element_loops": [],
    "wind_speeds_m_per_s": {"start": 4.0, "stop": 12.0, "count": 11},
}

Request = Callable[[int], bytes]


@dataclass(frozen=True, slots=True)
class Running:
    """A service that runs: its settings and address."""

    settings: Settings
    port: int

    @property
    def address(self) -> str:
        """Return where it listens."""
        return f"http://127.0.0.1:{self.port}"


def service(lines: int = 1000) -> Iterator[tuple[str, float]]:
    """Yield all figures of the service."""
    documents = _documents(lines)
    alone = _engine_seconds(documents)
    with _running() as running:
        one = _batch_seconds(running, documents, workers=1)
        yield "service_overhead_ratio", one / alone
        yield "two_worker_speedup", one / _batch_seconds(running, documents, workers=2)
        yield "post_p99_ms", _post_p99_ms(running)
        yield "status_reads_per_s", _reads_per_s(running)


def _documents(count: int) -> list[dict[str, Any]]:
    """Draw plausible lines: the source's one with its measures varied by tens of percent."""
    generator = np.random.default_rng(20260101)
    return [_document(generator, number) for number in range(1, count + 1)]


def _document(generator: np.random.Generator, number: int) -> dict[str, Any]:
    line = example("c11-twin")
    tightness = {"catenary_parameter_m": float(generator.uniform(900.0, 1800.0))}
    line["span"] = {"length_m": float(generator.uniform(80.0, 300.0)), "elements": 10, **tightness}
    for part, name in (("conductor", "diameter_m"), ("conductor", "mass_kg_per_m"), ("bundle", "radius_m")):
        line[part][name] *= float(generator.uniform(0.8, 1.2))
    for name, values in line["ice"]["aerodynamics"].items():
        line["ice"]["aerodynamics"][name] = [value * float(generator.uniform(0.8, 1.2)) for value in values]
    return {**line, "reference": f"row-{number}", "asset_id": f"L{number}"}


def _engine_seconds(documents: list[dict[str, Any]]) -> float:
    asked = schemas.Analysis.model_validate(STANDARD)
    made = [_specification(document, asked) for document in documents]
    analysis = made[0][1]
    _analyse([line for line, _ in made[:STACK]], analysis)
    begin = time.perf_counter()
    for first in range(0, len(made), STACK):
        _analyse([line for line, _ in made[first : first + STACK]], analysis)
    return time.perf_counter() - begin


def _specification(document: dict[str, Any], asked: schemas.Analysis) -> tuple[Line, Analysis]:
    line = schemas.Line.model_validate({name: value for name, value in document.items() if name != "reference"})
    made, analysis, faults = gather(SoundParts.of(line), asked)
    assert made is not None and not faults
    return made, analysis


def _analyse(lines: list[Line], analysis: Analysis) -> None:
    for _ in analyse_stack(lines, analysis):
        pass


@contextlib.contextmanager
def _running() -> Iterator[Running]:
    """Run the API on a fresh PostgreSQL and Redis."""
    with tempfile.TemporaryDirectory() as directory, postgres_server() as database, redis_server() as broker:
        settings = Settings(data_dir=Path(directory), database_url=database, broker_url=broker)
        migrate(settings)
        port = free_port()
        with (Path(directory) / "api.log").open("wb") as log:
            api = processes.start(settings, "app.serve", "127.0.0.1", str(port), log=log)
            try:
                running = Running(settings, port)
                _wait(lambda: _is_up(running), 30.0)
                yield running
            finally:
                processes.stop([api], signal.SIGTERM, 10.0)


def _is_up(running: Running) -> bool:
    try:
        return httpx.get(f"{running.address}/health/live").is_success
    except httpx.TransportError:
        return False


def _batch_seconds(running: Running, documents: list[dict[str, Any]], workers: int) -> float:
    """Return the time from the first byte of a batch to the last byte of its results [s]."""
    settings = running.settings.model_copy(update={"worker_processes": workers})
    with (settings.data_dir / "worker.log").open("ab") as log:
        worker = processes.start(settings, "worker", log=log)
    try:
        with httpx.Client(base_url=running.address, timeout=300.0) as client:
            for _ in range(workers):
                _run_batch(client, documents[:WARM_LINES])  # the processes of the pool load the engine
            begin = time.perf_counter()
            _run_batch(client, documents)
            return time.perf_counter() - begin
    finally:
        processes.stop([worker], signal.SIGTERM, 30.0)


def _run_batch(client: httpx.Client, documents: list[dict[str, Any]]) -> None:
    body = "".join(json.dumps(item) + "\n" for item in ({"analysis": STANDARD}, *documents))
    answer = client.post("/v1/batches", content=body, headers={"Content-Type": "application/x-ndjson"})
    address = answer.raise_for_status().headers["location"]
    _wait(lambda: client.get(address).json()["status"] not in {"accepted", "running"}, 600.0)
    found = client.get(f"{address}/results").raise_for_status().text.splitlines()
    assert [json.loads(text)["status"] for text in found] == ["successful"] * len(documents)


def _wait(condition: Callable[[], bool], seconds: float) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"nothing came within {seconds:g} s"
        time.sleep(0.05)


def _post_p99_ms(running: Running) -> float:
    body = json.dumps({"line": example("c11-twin")}).encode()
    head = f"POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
    request = head.encode() + body
    times = asyncio.run(_load(running, lambda _: request, POSTS // CLIENTS, b"202"))
    return 1e3 * float(np.percentile(times, 99))


def _reads_per_s(running: Running) -> float:
    jobs = httpx.get(f"{running.address}/v1/jobs?limit=500").json()["jobs"]
    requests = [f"GET /v1/jobs/{job['id']} HTTP/1.1\r\nHost: x\r\n\r\n".encode() for job in jobs]
    asyncio.run(_load(running, lambda n: requests[n % len(requests)], 2, b"200"))
    begin, done = time.perf_counter(), 0
    while time.perf_counter() - begin < READ_SECONDS:
        done += len(asyncio.run(_load(running, lambda n: requests[n % len(requests)], 20, b"200")))
    return done / (time.perf_counter() - begin)


async def _load(running: Running, request: Request, each: int, status: bytes) -> list[float]:
    """Let all clients send requests one after another at once; return the time of each request [s]."""
    clients = [_client(running.port, request, number * each, each, status) for number in range(CLIENTS)]
    return [seconds for times in await asyncio.gather(*clients) for seconds in times]


async def _client(port: int, request: Request, first: int, count: int, status: bytes) -> list[float]:
    # Bare sockets, since a client library on the same two cores would cost more than the service.
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    times = []
    for number in range(first, first + count):
        begin = time.perf_counter()
        writer.write(request(number))
        head = await reader.readuntil(b"\r\n\r\n")
        fields = dict(line.lower().split(b": ", 1) for line in head.split(b"\r\n")[1:-2])
        await reader.readexactly(int(fields[b"content-length"]))
        times.append(time.perf_counter() - begin)
        assert head.split(b" ", 2)[1] == status, head
    writer.close()
    return times


if __name__ == "__main__":
    for name, figure in service():
        print(f"{name:28} {figure:10.4g}", flush=True)
