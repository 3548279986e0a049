import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

from app.main import create_app
from tests.app import service

PARENT = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"
PROGRAM = f"""
from opentelemetry import trace
from app import correlation, telemetry
from app.settings import Settings

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


def test_the_span_of_a_job_goes_to_the_collector_under_that_of_its_request(tmp_path: Path) -> None:
    taken: list[tuple[str, bytes]] = []
    with HTTPServer(("127.0.0.1", 0), type("Handler", (Collector,), {"taken": taken})) as server:
        threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True).start()
        endpoint = f"http://127.0.0.1:{server.server_address[1]}"
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM],
            env={"OTEL_EXPORTER_OTLP_ENDPOINT": endpoint, "GALLOPING_DATA_DIR": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        )
        server.shutdown()
    ((path, body),) = taken
    assert path == "/v1/traces"
    trace_id, parent_id = PARENT.split("-")[1:3]
    assert bytes.fromhex(trace_id) in body and bytes.fromhex(parent_id) in body
    assert b"galloping-worker" in body and b"j7" in body
    # What is told of in the logs and to further jobs is the span itself, in the same trace.
    assert done.stdout.split("-")[1] == trace_id and done.stdout.split("-")[2] != parent_id


def test_nothing_is_traced_unless_it_is_asked_for(tmp_path: Path) -> None:
    kinds = ("tracing", "metrics", "logs", "operation_spans")
    assert not any(vars(create_app(service.sqlite_settings(tmp_path)))["_telemetry"][kind] for kind in kinds)
