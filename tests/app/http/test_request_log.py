import logging
from uuid import UUID

import httpx
import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.routes import jobs
from app.runtime.settings import Settings
from tests.app import service
from tests.documents import look, short_request
from tests.servers import wait_until

PARENT = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"


def statuses(caplog: pytest.LogCaptureFixture) -> list[int]:
    """Return the statuses of the requests that were logged so far."""
    return [vars(record)["status"] for record in caplog.records if record.name == "app.http.request_log"]


def test_the_id_of_a_request_comes_back_and_goes_into_its_job(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    with service.running(settings) as client:
        client.headers.update({"X-Request-ID": "scada-17", "traceparent": PARENT})
        job = service.submit(client)
        batch = client.post("/v1/batches", json={"lines": [short_request()["line"]]})
        answers = [client.get("/v1/jobs/none"), client.head("/health/live"), batch]
        chunks = client.get("/v1/jobs", params={"batch_id": batch.json()["id"]}).json()["jobs"]
    assert [answer.headers["X-Request-ID"] for answer in answers] == ["scada-17"] * 3
    for made in (job, *chunks):
        kept = look(sessions, UUID(made["id"]))
        assert (kept.request_id, kept.trace_parent) == ("scada-17", PARENT)
    assert len(chunks) == 1


def test_every_request_has_an_id_of_its_own(shared_client: httpx.Client) -> None:
    ids = {shared_client.get("/health/live").headers["x-request-id"] for _ in range(3)}
    assert len(ids) == 3 and all(UUID(found) for found in ids)


def test_the_log_names_the_route_of_what_goes_wrong(
    shared_client: httpx.Client, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO, "app.http.request_log")
    path = "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"
    shared_client.get("/health/live")
    shared_client.get(path)
    shared_client.get("/nowhere")
    wait_until(lambda: len(statuses(caplog)) == 2, what="two lines")
    known, unknown = (vars(record) for record in caplog.records if record.name == "app.http.request_log")
    assert (known["method"], known["path"], known["route"], known["status"]) == (
        "GET",
        path,
        "/v1/jobs/{job_id}",
        404,
    )
    assert (unknown["route"], unknown["status"]) == ("", 404)
    assert 0.0 < known["milliseconds"] < 60_000.0


def test_the_answer_to_a_defect_carries_the_id(
    own_client: httpx.Client, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(jobs, "signing_key", lambda _: int("signing-secret"))  # a defect that nobody foresaw
    caplog.set_level(logging.INFO, "app.http.request_log")
    answer = own_client.get("/v1/jobs", headers={"X-Request-ID": "d1"})
    assert (answer.status_code, answer.headers["x-request-id"]) == (500, "d1")
    # The line is written when the whole answer is out.
    wait_until(lambda: 500 in statuses(caplog), what="its line")
