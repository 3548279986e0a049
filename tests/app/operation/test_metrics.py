import os
import platform
import signal
from pathlib import Path
from uuid import UUID

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families
from sqlalchemy.orm import Session, sessionmaker

from app.convert import ENGINE_VERSION
from app.jobs import job_records, leases
from app.jobs.leases import Failure
from app.operation import metrics, workers
from app.runtime.settings import Settings
from app.runtime.version import SERVICE_VERSION
from app.security.caller import LOCAL
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from app.tables import FailureKind
from tests.app import service
from tests.documents import add_job, point_result
from tests.processes import children, running
from tests.servers import free_port, wait_until

Samples = dict[tuple[str, frozenset[tuple[str, str]]], float]


def scrape(client: httpx.Client) -> Samples:
    answer = client.get("/metrics", headers={"Accept": "text/plain"}).raise_for_status()
    assert answer.headers["content-type"].startswith("text/plain; version=")
    return parsed(answer.text)


def parsed(text: str) -> Samples:
    return {
        (sample.name, frozenset(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def value(samples: Samples, name: str, **labels: str) -> float:
    return samples[name, frozenset(labels.items())]


def requests(samples: Samples, route: str) -> dict[tuple[str, str], float]:
    """Return how many requests of a route were counted, by method and status."""
    name = "galloping_http_request_seconds_count"
    found = {labels: count for (kind, labels), count in samples.items() if kind == name and ("route", route) in labels}
    return {(dict(labels)["method"], dict(labels)["status"]): count for labels, count in found.items()}


def test_requests_are_counted_by_the_template_of_their_route(own_client: httpx.Client) -> None:
    for number in range(5):
        own_client.get(f"/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d{number:02d}")
        own_client.get(f"/nowhere/{number}")
    own_client.head("/health/live")
    own_client.request("BREW", "/v1/jobs")
    wait_until(lambda: requests(scrape(own_client), "/v1/jobs/{job_id}") == {("GET", "4xx"): 5.0}, what="5 requests")
    samples = scrape(own_client)
    assert requests(samples, "/health/live") == {("HEAD", "2xx"): 1.0}
    assert requests(samples, "")["GET", "4xx"] == 5.0
    assert {method for name, labels in samples for key, method in labels if key == "method"} <= {"GET", "HEAD", "other"}


def test_build_process_and_workers_are_told(own_client: httpx.Client, own_settings: Settings) -> None:
    before = scrape(own_client)
    assert value(before, "galloping_workers") == 0.0
    assert not any(name == "galloping_workers_silent_seconds" for name, _ in before)
    engine = make_engine(own_settings)
    with session_factory(engine).begin() as session:
        workers.report(session, own_settings, "w")
    engine.dispose()
    samples = scrape(own_client)
    assert value(samples, "galloping_workers") == 1.0
    assert 0.0 <= value(samples, "galloping_workers_silent_seconds") < 30.0
    (build,) = [dict(labels) for name, labels in samples if name == "galloping_build_info"]
    assert build == {"version": SERVICE_VERSION, "engine": ENGINE_VERSION, "python": platform.python_version()}
    assert value(samples, "process_resident_memory_bytes") > 1e7


def test_jobs_are_counted_as_the_database_has_them(settings: Settings, sessions: sessionmaker[Session]) -> None:
    first, second, third, fourth = (add_job(sessions) for _ in range(4))
    with sessions.begin() as session:
        held = [leases.claim(session, job_id, "w", 60.0) for job_id in (first, second, third)]
    assert held[0] and held[1] and held[2]
    with sessions.begin() as session:
        assert leases.finish(session, held[0], [point_result()])
        assert leases.fail(session, held[1], Failure(FailureKind.TIME_LIMIT, "too long"))
    with sessions.begin() as session:
        assert not leases.finish(session, held[0], [point_result()])  # a late one counts for nothing
        leases.release_expired(session, settings, "w")
        job_records.cancel(session, LOCAL, fourth)
    with sessions.begin() as session:
        job_records.cancel(session, LOCAL, first)  # removes it, but it has been
    with service.running(settings) as client:
        samples = scrape(client)
    ended = "galloping_jobs_ended_total"
    assert value(samples, ended, kind="job", status="successful", failure="") == 1.0
    assert value(samples, ended, kind="job", status="failed", failure="time_limit") == 1.0
    assert value(samples, ended, kind="job", status="dismissed", failure="") == 1.0
    assert value(samples, "galloping_jobs_waiting", kind="job") == 1.0
    assert value(samples, "galloping_jobs_unsent", kind="job") == 1.0
    assert value(samples, "galloping_jobs_running", kind="job") == 0.0
    assert value(samples, "galloping_jobs_waiting", kind="chunk") == 0.0
    assert 0.0 <= value(samples, "galloping_oldest_waiting_seconds", kind="job") < 3600.0
    assert 0.0 < value(samples, "galloping_engine_seconds_total", kind="job") < 3600.0
    assert value(samples, "galloping_leases_lost_total", why="returned") == 1.0
    assert value(samples, "galloping_leases_lost_total", why="expired") == 0.0
    assert value(samples, "galloping_database_up") == 1.0


def test_without_its_database_the_rest_is_told(tmp_path: Path) -> None:
    (tmp_path / "galloping.sqlite3").write_bytes(b"no database, but long enough to be taken for a broken one " * 99)
    engine = make_engine(service.sqlite_settings(tmp_path))
    counted = metrics.requests()
    counted.observe("GET", "/v1/jobs", 200, 0.1)
    text, _ = metrics.text(counted, session_factory(engine, read_only=True), "text/plain")
    samples = parsed(text.decode())
    engine.dispose()
    assert value(samples, "galloping_database_up") == 0.0
    assert requests(samples, "/v1/jobs") == {("GET", "2xx"): 1.0}
    assert ("galloping_jobs_waiting", frozenset({("kind", "job")})) not in samples


@pytest.mark.parametrize("number", [40])
def test_all_processes_of_an_api_are_counted_even_killed_ones(tmp_path: Path, number: int) -> None:
    settings = Settings(data_dir=tmp_path, api_processes=2)
    migrate(settings)
    port = free_port()
    with running(settings, "-m", "app.serve", "127.0.0.1", str(port)) as api:
        address = f"http://127.0.0.1:{port}"
        wait_until(lambda: answers(address), 120.0, "the API")
        served = {pid for pid in children(api.pid) if "spawn_main" in Path(f"/proc/{pid}/cmdline").read_text()}
        assert len(served) == 2
        for _ in range(number):
            assert httpx.get(f"{address}/v1/jobs/{UUID(int=7)}").status_code == 404
        with httpx.Client(base_url=address) as client:
            wait_until(lambda: sum(requests(scrape(client), "/v1/jobs/{job_id}").values()) == number, 60.0, "all")
        assert len(list((tmp_path / f"metrics-{port}").glob("histogram_*.db"))) == 2  # both have served
        for pid in served:
            os.kill(pid, signal.SIGKILL)
        wait_until(lambda: len(children(api.pid)) >= 2 and not served & set(children(api.pid)), 60.0, "new processes")
        wait_until(lambda: answers(address), 120.0, "the API again")
        with httpx.Client(base_url=address) as client:
            assert sum(requests(scrape(client), "/v1/jobs/{job_id}").values()) == number


def answers(address: str) -> bool:
    try:
        return httpx.get(f"{address}/health/live").is_success
    except httpx.TransportError:
        return False
