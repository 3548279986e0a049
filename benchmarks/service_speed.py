"""The service against the engine alone: a batch through HTTP, queue, workers and database; posts and reads under load.

PostgreSQL and Redis are private instances on loopback; the API (two processes) and the workers are separate processes.
Preparing a batch and reading its results in the client are not timed.

The engine alone computes the same lines in the same stacks, in this process. Because the machine's speed drifts, it
runs every other stack right before the batch and the rest right after it; the ratio is the median of several such
rounds. As in a worker, the garbage collector skips the objects that are loaded at the start.
"""

import contextlib
import gc
import json
import signal
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import psycopg

from app import schemas
from app.convert import STACK
from app.convert.assemble import SoundParts, gather
from app.reference.source_lines import example
from app.runtime import processes
from app.runtime.settings import Settings
from app.storage.migration import migrate
from benchmarks.lease_costs import lease_costs
from benchmarks.load import CLIENTS, Request, closed_loop, open_loop
from benchmarks.processor import seconds_by_role
from engine.analysis import analyse_stack
from engine.spec import Analysis, Line
from tests.servers import free_port, postgres_server, redis_server
from worker.memory import settle

POSTS = 1000
POST_RUNS = 9
POSTS_PER_S = 100.0
READS = 5000
RUNS = 3
LOOK_SECONDS = 0.2
COST_LINES = 1000
WARM_LINES = 64
STANDARD: dict[str, Any] = {
    "loops": [1, 2],
    "models": ["hybrid", "finite_element"],
    "finite_element_loops": [],
    "wind_speeds_m_per_s": {"start": 4.0, "stop": 12.0, "count": 11},
}


@dataclass(frozen=True, slots=True)
class Running:
    """A running service: its settings and port."""

    settings: Settings
    port: int

    @property
    def address(self) -> str:
        """Return the service's base URL."""
        return f"http://127.0.0.1:{self.port}"


def service(lines: int = 1000) -> Iterator[tuple[str, float]]:
    """Yield all figures of the service; short runs are repeated and their median is taken."""
    documents = _documents(lines)
    stacks = _stacks(documents)
    ratios = []
    with _running() as running:
        for _ in range(RUNS):
            before = _engine_seconds(stacks[::2])
            one = _timed_batch(running, documents, workers=1)
            ratios.append(one.whole / (before + _engine_seconds(stacks[1::2])))
        two = _timed_batch(running, documents, workers=2)
        yield "service_overhead_ratio", statistics.median(ratios)
        yield "two_worker_speedup", one.working / two.working
        yield "two_worker_batch_speedup", one.whole / two.whole
        yield from _costs(running, documents[:COST_LINES])
        yield from _posts(running)
        yield from _reads(running)
        yield from lease_costs(running.settings)


def _documents(count: int) -> list[dict[str, Any]]:
    """Draw plausible lines: the source's twin bundle with its dimensions varied by up to 20 %, on other spans."""
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


def _stacks(documents: list[dict[str, Any]]) -> list[list[Line]]:
    """Return the engine's lines, in the stacks in which a worker computes them."""
    analysis = schemas.Analysis.model_validate(STANDARD)
    lines = [_specification(document, analysis)[0] for document in documents]
    return [lines[first : first + STACK] for first in range(0, len(lines), STACK)]


def _specification(document: dict[str, Any], asked: schemas.Analysis) -> tuple[Line, Analysis]:
    line = schemas.Line.model_validate({name: value for name, value in document.items() if name != "reference"})
    made, analysis, faults = gather(SoundParts.of(line), asked)
    assert made is not None and not faults
    return made, analysis


def _engine_seconds(stacks: Sequence[list[Line]]) -> float:
    _, analysis = _specification(_documents(1)[0], schemas.Analysis.model_validate(STANDARD))
    for stack in stacks[:1]:
        _analyse(stack, analysis)
    settle()
    begin = time.perf_counter()
    for stack in stacks:
        _analyse(stack, analysis)
    seconds = time.perf_counter() - begin
    gc.unfreeze()
    return seconds


def _analyse(lines: list[Line], analysis: Analysis) -> None:
    for _ in analyse_stack(lines, analysis):
        pass


@contextlib.contextmanager
def _running() -> Iterator[Running]:
    """Run the API on a new PostgreSQL and a new Redis."""
    with tempfile.TemporaryDirectory() as directory, postgres_server() as database, redis_server() as broker:
        unlimited = {"reads_per_minute": 10**9, "changes_per_minute": 10**9}
        settings = Settings(
            data_dir=Path(directory), database_url=database, broker_url=broker, api_processes=2, **unlimited
        )
        migrate(settings)
        port = free_port()
        with (Path(directory) / "api.log").open("wb") as log:
            api = processes.start(settings, "app.serve", "127.0.0.1", str(port), log=log)
            try:
                running = Running(settings, port)
                _wait(lambda: _is_up(running), 120.0)
                yield running
            finally:
                processes.stop([api], signal.SIGTERM, 10.0)


def _is_up(running: Running) -> bool:
    try:
        return httpx.get(f"{running.address}/health/live").is_success
    except httpx.TransportError:
        return False


@contextlib.contextmanager
def _working(running: Running, workers: int) -> Iterator[httpx.Client]:
    """Run worker processes, warm them up with a batch each, and yield a client."""
    settings = running.settings.model_copy(update={"worker_processes": workers})
    with (settings.data_dir / "worker.log").open("ab") as log:
        worker = processes.start(settings, "worker", log=log)
    try:
        with httpx.Client(base_url=running.address, timeout=600.0) as client:
            for _ in range(workers):
                _run_batch(client, _body(_documents(WARM_LINES)))
            yield client
    finally:
        processes.stop([worker], signal.SIGTERM, 30.0)


@dataclass(frozen=True, slots=True)
class Times:
    """Time from the first byte of a batch to the last byte of its results, and from its first chunk to its last [s]."""

    whole: float
    working: float


def _timed_batch(running: Running, documents: list[dict[str, Any]], workers: int) -> Times:
    body = _body(documents)
    with _working(running, workers) as client, psycopg.connect(_plain(running), autocommit=True) as database:
        after = _number(database, "SELECT extract(epoch FROM clock_timestamp())")
        begin = time.perf_counter()
        found = _run_batch(client, body)
        seconds = time.perf_counter() - begin
        working = "SELECT extract(epoch FROM max(finished_at) - min(started_at)) FROM jobs"
        recent = _number(database, f"{working} WHERE started_at > to_timestamp({after})")
    assert [json.loads(text)["status"] for text in found.splitlines()] == ["successful"] * len(documents)
    return Times(seconds, recent)


def _costs(running: Running, documents: list[dict[str, Any]]) -> Iterator[tuple[str, float]]:
    """Yield the cost per line of a batch: processor time by role [ms], messages, rows, and bytes in the database."""
    body, lines = _body(documents), len(documents)
    with _working(running, 1) as client, psycopg.connect(_plain(running), autocommit=True) as database:
        spent, rows, stored, logged = seconds_by_role(), *_stored(database)
        jobs = _number(database, "SELECT count(*) FROM jobs")
        _run_batch(client, body)
        spent = seconds_by_role() - spent
        for role, name in (("worker", "worker"), ("app.serve", "api"), ("postgres", "database"), ("redis", "broker")):
            yield f"line_{name}_ms", 1e3 * spent[role] / lines
        after = _stored(database)
        yield "line_messages", (_number(database, "SELECT count(*) FROM jobs") - jobs) / lines
        for name, now, before in zip(("rows", "bytes", "log_bytes"), after, (rows, stored, logged), strict=True):
            yield f"line_{name}", (now - before) / lines


def _plain(running: Running) -> str:
    return running.settings.database_url.replace("+psycopg", "")


def _stored(database: psycopg.Connection) -> tuple[float, float, float]:
    """Return total rows and bytes stored, and bytes of the write-ahead log so far."""
    tables = ("jobs", "job_events", "batches", "batch_items", "results")
    rows = sum(_number(database, f"SELECT count(*) FROM {table}") for table in tables)
    stored = sum(_number(database, f"SELECT pg_total_relation_size('{table}')") for table in tables)
    return rows, stored, _number(database, "SELECT pg_current_wal_lsn() - '0/0'::pg_lsn")


def _number(database: psycopg.Connection, statement: str) -> float:
    found = database.execute(statement.encode()).fetchone()
    assert found is not None
    return float(found[0])


def _body(documents: list[dict[str, Any]]) -> bytes:
    return "".join(json.dumps(item) + "\n" for item in ({"analysis": STANDARD}, *documents)).encode()


def _run_batch(client: httpx.Client, body: bytes) -> bytes:
    headers = {"Content-Type": "application/x-ndjson", "Cache-Control": "no-cache"}
    answer = client.post("/v1/batches", content=body, headers=headers)
    address = answer.raise_for_status().headers["location"]
    while client.get(address).raise_for_status().json()["status"] in {"accepted", "running"}:
        time.sleep(LOOK_SECONDS)
    return client.get(f"{address}/results").raise_for_status().content


def _wait(condition: Callable[[], bool], seconds: float) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"the service did not start within {seconds:g} s"
        time.sleep(0.05)


def _posts(running: Running) -> Iterator[tuple[str, float]]:
    posts = [_post(29e3 + number / 10.0) for number in range(POSTS)]
    request: Request = lambda number: posts[number % POSTS]  # noqa: E731 - as short as what it stands for
    closed_loop(running.port, request, 2, b"202")
    spent, latencies, rates = seconds_by_role(), [], []
    for _ in range(POST_RUNS):
        begin = time.perf_counter()
        times = closed_loop(running.port, request, POSTS // CLIENTS, b"202")
        rates.append(POSTS / (time.perf_counter() - begin))
        latencies.append(_p99_ms(times))
    spent = seconds_by_role() - spent
    yield "post_p99_ms", statistics.median(latencies)
    yield "posts_per_s", statistics.median(rates)
    steady = [open_loop(running.port, request, POSTS, POSTS_PER_S, b"202") for _ in range(RUNS)]
    yield "post_open_p99_ms", statistics.median(map(_p99_ms, steady))
    for role, name in (("app.serve", "api"), ("postgres", "database"), ("redis", "broker")):
        yield f"post_{name}_ms", 1e3 * spent[role] / (POST_RUNS * POSTS)


def _post(tension: float) -> bytes:
    """Return a complete HTTP request; the tension makes its line different from all others."""
    line = example("c11-twin")
    body = json.dumps({"line": line | {"span": line["span"] | {"horizontal_tension_n": tension}}}).encode()
    fields = f"Host: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
    return f"POST /v1/jobs HTTP/1.1\r\n{fields}".encode() + body


def _p99_ms(times: list[float]) -> float:
    return 1e3 * float(np.percentile(times, 99))


def _reads(running: Running) -> Iterator[tuple[str, float]]:
    jobs = httpx.get(f"{running.address}/v1/jobs?limit=500").json()["jobs"]
    requests = [f"GET /v1/jobs/{job['id']} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode() for job in jobs]
    request: Request = lambda number: requests[number % len(requests)]  # noqa: E731 - as above
    closed_loop(running.port, request, 2, b"200")
    spent, rates = seconds_by_role(), []
    for _ in range(RUNS):
        begin = time.perf_counter()
        closed_loop(running.port, request, READS // CLIENTS, b"200")
        rates.append(READS / (time.perf_counter() - begin))
    spent = seconds_by_role() - spent
    yield "status_reads_per_s", statistics.median(rates)
    for role, name in (("app.serve", "api"), ("postgres", "database")):
        yield f"read_{name}_ms", 1e3 * spent[role] / (RUNS * READS)


if __name__ == "__main__":
    for name, figure in service():
        print(f"{name:28} {figure:10.4g}", flush=True)
