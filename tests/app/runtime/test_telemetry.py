import contextlib
import json
import sqlite3
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

from app.main import create_app
from app.runtime.version import SERVICE_VERSION
from tests.app import service
from tests.documents import hasty_settings, short_request
from tests.embedded import serving, submit, wait_for
from tests.servers import free_port, wait_until

PARENT = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"
PROGRAM = f"""
from opentelemetry import trace
from app.runtime import correlation, telemetry
from app.runtime.settings import Settings

telemetry.configure(Settings(opentelemetry=True), "worker")
with telemetry.job_span(correlation.Ids("r", "{PARENT}", "j7", 2)):
    print(correlation.trace_parent())
trace.get_tracer_provider().shutdown()
"""


class Collector(BaseHTTPRequestHandler):
    """Keeps what is exported to it."""

    taken: list[tuple[str, bytes]]

    def do_POST(self) -> None:
        self.taken.append((self.path, self.rfile.read(int(self.headers["Content-Length"]))))
        self.send_response(200)
        self.send_header("Content-Length", "0")
        self.end_headers()

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the name that the base class gives
        pass


@contextmanager
def collector() -> Iterator[tuple[str, list[tuple[str, bytes]]]]:
    """Run a collector; give its address and what it takes."""
    taken: list[tuple[str, bytes]] = []
    with HTTPServer(("127.0.0.1", 0), type("Handler", (Collector,), {"taken": taken})) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}", taken
        finally:
            server.shutdown()
            thread.join()


def test_the_span_of_a_job_goes_to_the_collector_under_that_of_its_request(tmp_path: Path) -> None:
    with collector() as (endpoint, taken):
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM],
            env={"OTEL_EXPORTER_OTLP_ENDPOINT": endpoint, "GALLOPING_DATA_DIR": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        )
    ((path, body),) = taken
    assert path == "/v1/traces"
    trace_id, parent_id = PARENT.split("-")[1:3]
    assert bytes.fromhex(trace_id) in body and bytes.fromhex(parent_id) in body
    assert b"galloping-worker" in body and b"j7" in body
    # What is told of in the logs and to further jobs is the span itself, in the same trace.
    assert done.stdout.split("-")[1] == trace_id and done.stdout.split("-")[2] != parent_id


def test_request_and_job_are_spans_of_the_callers_trace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The process of a job ends with it, and the API with its last request: neither may take its spans along.
    settings = hasty_settings(tmp_path).model_copy(update={"opentelemetry": True, "max_jobs_per_process": 1})
    with collector() as (endpoint, taken):
        monkeypatch.setenv("OTEL_EXPORTER_OTLP_ENDPOINT", endpoint)
        with serving(settings, free_port()) as (process, client):
            client.headers["traceparent"] = PARENT
            location = submit(client, short_request())
            wait_for(client, location, "successful")
            wait_until(lambda: any(b"galloping-worker" in body for _, body in taken), what="the job's span")
            client.get("/v1/fields").raise_for_status()
            process.terminate()
            assert process.wait(20.0) == 0
    with contextlib.closing(sqlite3.connect(tmp_path / "galloping.sqlite3")) as database:
        ((job_parent,),) = database.execute("SELECT trace_parent FROM jobs")
    trace_id, parent_id = PARENT.split("-")[1:3]
    _, job_trace_id, span_id, _ = job_parent.split("-")
    assert job_trace_id == trace_id
    assert span_id != parent_id
    api = [body for _, body in taken if b"galloping-api" in body and b"POST /v1/jobs" in body]
    worker = [body for _, body in taken if b"galloping-worker" in body]
    assert any(bytes.fromhex(trace_id) in body and bytes.fromhex(parent_id) in body for body in api)
    assert any(bytes.fromhex(span_id) in body for body in api)  # the request's own
    assert any(bytes.fromhex(trace_id) in body and bytes.fromhex(span_id) in body for body in worker)
    assert any(b"GET /v1/fields" in body for _, body in taken)
    assert any(location.rpartition("/")[2].encode() in body for body in worker)


def test_the_operators_names_come_first_and_the_version_is_told(tmp_path: Path) -> None:
    with collector() as (endpoint, taken):
        own = {"OTEL_SERVICE_NAME": "span-safety", "OTEL_RESOURCE_ATTRIBUTES": "deployment.environment.name=trial"}
        environment = {"OTEL_EXPORTER_OTLP_ENDPOINT": endpoint, "GALLOPING_DATA_DIR": str(tmp_path), **own}
        subprocess.run([sys.executable, "-c", PROGRAM], env=environment, check=True, capture_output=True)
    ((_, body),) = taken
    assert b"span-safety" in body and b"galloping-worker" not in body
    assert b"service.version" in body and SERVICE_VERSION.encode() in body
    assert b"deployment.environment.name" in body and b"trial" in body


def test_probes_make_no_spans_and_log_lines_carry_the_trace_of_their_request(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = hasty_settings(tmp_path).model_copy(update={"opentelemetry": True, "log_level": "debug"})
    with collector() as (endpoint, taken):
        monkeypatch.setenv("OTEL_EXPORTER_OTLP_ENDPOINT", endpoint)
        with serving(settings, free_port()) as (process, client):  # it asks for readiness until it is there
            client.get("/metrics").raise_for_status()
            client.get("/v1/fields").raise_for_status()
            process.terminate()
            assert process.wait(20.0) == 0
    spans = b"".join(body for _, body in taken)
    assert b"GET /v1/fields" in spans
    assert b"/health/ready" not in spans and b"/metrics" not in spans
    written = (tmp_path / "process.log").read_text().splitlines()
    lines = [line for line in map(json.loads, (one for one in written if one.startswith("{"))) if "route" in line]
    (logged,) = [line for line in lines if line["route"] == "/v1/fields"]
    assert bytes.fromhex(logged["trace_id"]) in spans
    assert not any("trace_id" in line for line in lines if line["route"] == "/metrics")


def test_nothing_is_traced_unless_it_is_asked_for(tmp_path: Path) -> None:
    kinds = ("tracing", "metrics", "logs", "operation_spans")
    assert not any(vars(create_app(service.sqlite_settings(tmp_path)))["_telemetry"][kind] for kind in kinds)
