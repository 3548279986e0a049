"""POSTs under an Idempotency-Key whose server dies before its answer is out, or whose answer is lost on its way."""

import contextlib
import inspect
import json
import socket
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from uuid import UUID

import httpx
from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.client import Client
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.tables import BatchItem, IdempotencyKey, Job
from tests.app import service
from tests.app.lines import SHORT
from tests.documents import short_request
from tests.processes import running
from tests.servers import free_port, wait_until
from worker.sweep import sweep

KEY = {"Idempotency-Key": "order-17"}
LINES = [example("c11-twin")] * 600  # more than are stored at once


@contextlib.contextmanager
def api_killed_at_the_end(settings: Settings) -> Iterator[str]:
    """Run the API in a process that gets no chance to tidy up, and give its address."""
    port = free_port()

    def listens() -> bool:
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", port)) == 0

    with running(settings, "-m", "app.serve", "127.0.0.1", str(port)):
        wait_until(listens, 60.0, "the API")
        yield f"http://127.0.0.1:{port}"


def test_a_post_whose_server_dies_before_it_publishes_is_done_once(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    """The API is killed after the commit, while a broker that accepts and never answers keeps it from publishing."""

    def stored() -> list[UUID]:
        with sessions() as session:
            return list(session.scalars(select(Job.id)))

    def lost_post(address: str) -> None:
        with contextlib.suppress(httpx.HTTPError):
            httpx.post(f"{address}/v1/jobs", json=short_request(), headers=KEY, timeout=60.0)

    with socket.create_server(("127.0.0.1", 0)) as silent:
        broker = f"redis://127.0.0.1:{silent.getsockname()[1]}/0"
        deaf = settings.model_copy(update={"broker_url": broker, "broker_timeout_seconds": 60.0})
        with ThreadPoolExecutor(1) as pool, api_killed_at_the_end(deaf) as address:
            pool.submit(lost_post, address)
            wait_until(stored, what="the commit")
    (job_id,) = stored()
    with service.running(settings) as client:
        again = client.post("/v1/jobs", json=short_request(), headers=KEY)
        assert again.headers["idempotency-replayed"] == "true"
        assert again.json()["id"] == str(job_id)
        assert again.headers["location"] == f"/v1/jobs/{job_id}"
        assert len(client.get("/v1/jobs").json()["jobs"]) == 1
    assert sweep(sessions, settings.model_copy(update={"sweep_seconds": 1e-9})) == 1


def test_a_batch_whose_server_dies_while_it_comes_in_is_taken_in_once(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    """The repeated post has to wait for the end of the dead server's lease, and finds patience enough for that."""
    body = "".join(json.dumps(document) + "\n" for document in [{"analysis": SHORT}, *LINES]).encode()
    killed = threading.Event()

    def without_end() -> Iterator[bytes]:
        yield body
        killed.wait(60.0)

    def lost_post(address: str) -> None:
        headers = {**KEY, "Content-Type": "application/x-ndjson"}
        with contextlib.suppress(httpx.HTTPError):
            httpx.post(f"{address}/v1/batches", content=without_end(), headers=headers, timeout=60.0)

    def begun() -> bool:
        with sessions() as session:
            return session.scalar(select(BatchItem.number).limit(1)) is not None

    with ThreadPoolExecutor(1) as pool:
        with api_killed_at_the_end(settings.model_copy(update={"key_lease_seconds": 3.0})) as address:
            pool.submit(lost_post, address)
            wait_until(begun, what="the first lines")
        killed.set()
    with sessions() as session:
        assert session.scalars(select(IdempotencyKey.status)).one() is None
    with service.running(settings) as http, Client(str(http.base_url), patience_seconds=10.0) as client:
        batch = client.submit_batch(LINES, SHORT, idempotency_key=KEY["Idempotency-Key"])
        assert batch.lines.total == len(LINES)
        assert [found["id"] for found in http.get("/v1/batches").json()["batches"]] == [str(batch.id)]
        assert client.submit_batch(LINES, SHORT, idempotency_key=KEY["Idempotency-Key"]).id == batch.id


@contextlib.contextmanager
def lossy(address: str, losses: int) -> Iterator[tuple[str, list[int]]]:
    """Pass posts on to a service, but lose its first answers; give the address and the statuses of all answers."""
    statuses: list[int] = []

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            kept = {name: self.headers[name] for name in ("Content-Type", "Idempotency-Key")}
            answer = httpx.post(f"{address}{self.path}", content=body, headers=kept, timeout=60.0)
            statuses.append(answer.status_code)
            if len(statuses) <= losses:
                self.close_connection = True
                return
            self.send_response(answer.status_code)
            self.send_header("Content-Length", str(len(answer.content)))
            self.end_headers()
            self.wfile.write(answer.content)

        def log_message(self, *_: object) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}", statuses
        finally:
            server.shutdown()
            thread.join()


def test_the_client_gets_the_job_whose_answer_was_lost(settings: Settings) -> None:
    with service.running(settings) as http, lossy(str(http.base_url).rstrip("/"), 2) as (address, statuses):
        with Client(address) as client:
            job = client.submit_document(short_request())
        assert statuses == [202] * 3
        assert [found["id"] for found in http.get("/v1/jobs").json()["jobs"]] == [str(job.id)]


def test_the_client_gets_the_batch_whose_answer_was_lost(settings: Settings) -> None:
    with service.running(settings) as http, lossy(str(http.base_url).rstrip("/"), 1) as (address, statuses):
        with Client(address) as client:
            batch = client.submit_batch(LINES[:2], SHORT)
        assert statuses == [202] * 2
        assert [found["id"] for found in http.get("/v1/batches").json()["batches"]] == [str(batch.id)]


def test_the_client_outlasts_the_lease_of_a_server_that_died() -> None:
    patience = inspect.signature(Client).parameters["patience_seconds"].default
    assert Settings().key_lease_seconds < patience / 2.0
