"""Waiting for an end, streams of events, and answers that the client has already."""

import json
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.jobs.leases import Claim, Failure
from app.runtime.settings import Settings
from app.tables import FailureKind
from tests.app import service
from tests.app.lines import SHORT
from tests.app.service import chunks
from tests.documents import point_result, short_request
from tests.in_process import run_job
from tests.servers import wait_until

TWIN = short_request()["line"]


def claim(sessions: sessionmaker[Session], job_id: str) -> Claim:
    with sessions.begin() as session:
        held = leases.claim(session, UUID(job_id), "machine:1", 30.0)
    assert held is not None
    return held


def finish(sessions: sessionmaker[Session], held: Claim) -> None:
    with sessions.begin() as session:
        assert leases.finish(session, held, [point_result()])


def batch_address(client: httpx.Client) -> str:
    answer = client.post("/v1/batches", json={"lines": [TWIN, TWIN], "analysis": SHORT})
    return str(answer.headers["location"])


def events(lines: Iterator[str]) -> Iterator[dict[str, Any]]:
    """Yield the events of a stream, with their data read."""
    event: dict[str, Any] = {}
    for line in lines:
        if line:
            name, _, value = line.partition(": ")
            event[name or "comment"] = json.loads(value) if name == "data" else value
        elif event:
            yield event
            event = {}


def stream(client: httpx.Client, address: str, last: str | None = None) -> list[dict[str, Any]]:
    headers = {"Last-Event-ID": last} if last is not None else {}
    with client.stream("GET", f"{address}/events", headers=headers) as answer:
        assert answer.headers["content-type"].startswith("text/event-stream")
        return list(events(answer.iter_lines()))


def test_waiting_ends_with_the_job(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    job = service.submit(client)
    held = claim(sessions, job["id"])
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(client.get, f"/v1/jobs/{job['id']}", headers={"Prefer": "respond-async, wait=25"})
        assert client.get(f"/v1/jobs/{job['id']}").json()["status"] == "running"
        assert not waiting.done()
        finish(sessions, held)
        answer = waiting.result()
    assert answer.json()["status"] == "successful"
    assert answer.headers["preference-applied"] == "wait=25"


def test_waiting_ends_after_the_time(client: httpx.Client) -> None:
    address = f"/v1/jobs/{service.submit(client)['id']}"
    answer = client.get(address, headers={"Prefer": "wait=1"})
    assert (answer.status_code, answer.json()["status"]) == (200, "accepted")
    assert answer.headers["preference-applied"] == "wait=1"
    assert "preference-applied" not in client.get(address, headers={"Prefer": "wait=soon"}).headers


def test_no_wait_is_longer_than_the_operator_allows(own_settings: Settings) -> None:
    with service.running(own_settings.model_copy(update={"longest_wait_seconds": 1.0})) as client:
        answer = client.get(f"/v1/jobs/{service.submit(client)['id']}", headers={"Prefer": "wait=999999999"})
        assert (answer.json()["status"], answer.headers["preference-applied"]) == ("accepted", "wait=1")


def test_waiting_for_a_batch_ends_with_it(client: httpx.Client, settings: Settings) -> None:
    address = batch_address(client)
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(client.get, address, headers={"Prefer": "wait=25"})
        for chunk in chunks(client, address):
            run_job(settings, chunk)
        assert waiting.result().json()["status"] == "successful"


def test_a_stream_tells_what_happens_and_ends(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    job = service.submit(client)
    with ThreadPoolExecutor(1) as pool:
        following = pool.submit(stream, client, f"/v1/jobs/{job['id']}")
        held = claim(sessions, job["id"])
        with sessions.begin() as session:
            leases.heartbeat(session, held, 30.0, 0.5, "limit cycles")
        finish(sessions, held)
        seen = following.result()
    told = [event for event in seen if "id" in event]
    assert [event["event"] for event in told] == ["accepted", "running", "successful"]
    assert [event["data"]["attempt"] for event in told] == [0, 1, 1]
    assert "machine" not in json.dumps(seen)  # who works on it concerns the operator
    numbers = [int(event["id"]) for event in told]
    assert numbers == sorted(set(numbers))
    assert {event["event"] for event in seen if "id" not in event} <= {"progress"}


def test_progress_is_told_between(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    job = service.submit(client)
    held = claim(sessions, job["id"])
    with sessions.begin() as session:
        leases.heartbeat(session, held, 30.0, 0.5, "limit cycles")
    with client.stream("GET", f"/v1/jobs/{job['id']}/events") as answer:
        for event in events(answer.iter_lines()):
            if event["event"] == "progress":
                assert event["data"] == {"progress": 0.5, "step": "limit cycles"}
                finish(sessions, held)
    assert event["event"] == "successful"


def test_a_comment_shows_that_an_idle_connection_lives(
    client: httpx.Client, sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fastapi.routing._PING_INTERVAL", 0.1)  # else 15 s
    job = service.submit(client)
    with client.stream("GET", f"/v1/jobs/{job['id']}/events") as answer:
        following = events(answer.iter_lines())
        next(event for event in following if "comment" in event)
        finish(sessions, claim(sessions, job["id"]))
        *_, end = following
    assert end["event"] == "successful"


def test_who_comes_back_gets_what_was_missed(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    job = service.submit(client)
    address = f"/v1/jobs/{job['id']}"
    held = claim(sessions, job["id"])
    with sessions.begin() as session:
        leases.fail(session, held, Failure(FailureKind.TIME_LIMIT, "too long"))
    whole = stream(client, address)
    assert [event["event"] for event in whole] == ["accepted", "running", "failed"]
    assert whole[-1]["data"]["detail"] == "too long"
    assert stream(client, address, whole[0]["id"]) == whole[1:]
    for nonsense in ("", "x", "-1", "9" * 40):
        assert stream(client, address, nonsense) == whole
    finished = client.get(f"{address}/events", headers={"Last-Event-ID": whole[-1]["id"]})
    assert (finished.status_code, finished.content) == (204, b"")


def test_there_are_no_events_of_what_there_is_not(shared_client: httpx.Client) -> None:
    missing = "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"
    for kind in ("jobs", "batches"):
        assert shared_client.get(f"/v1/{kind}/{missing}/events").status_code == 404
        assert shared_client.get(f"/v1/{kind}/{missing}", headers={"Prefer": "wait=20"}).status_code == 404


def test_a_batch_tells_its_counts_until_it_ends(client: httpx.Client, settings: Settings) -> None:
    address = batch_address(client)
    with ThreadPoolExecutor(1) as pool:
        following = pool.submit(stream, client, address)
        for chunk in chunks(client, address):
            run_job(settings, chunk)
        seen = following.result()
    assert seen[-1]["event"] == "successful"
    assert (seen[-1]["data"]["progress"], seen[-1]["data"]["lines"]["successful"]) == (1.0, 2)
    assert len({event["id"] for event in seen}) == len(seen)
    assert stream(client, address, "other")[-1] == seen[-1]
    assert client.get(f"{address}/events", headers={"Last-Event-ID": seen[-1]["id"]}).status_code == 204


def test_a_stream_ends_in_time_and_is_gone_on_with(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, stream_seconds=0.5)
    with service.running(settings) as client:
        job, batch = service.submit(client), batch_address(client)
        address = f"/v1/jobs/{job['id']}"
        first = stream(client, address)  # reading raises if it does not end as a whole answer
        assert [event["event"] for event in first] == ["accepted"]
        assert stream(client, address, first[-1]["id"]) == []
        waiting = stream(client, batch)
        assert [event["event"] for event in waiting] == ["accepted"]
        assert stream(client, batch, waiting[-1]["id"]) == []
        run_job(settings, UUID(job["id"]))
        rest = stream(client, address, first[-1]["id"])
        assert [event["event"] for event in rest if "id" in event] == ["running", "successful"]


def test_the_head_of_a_stream_ends_at_once(client: httpx.Client) -> None:
    answer = client.head(f"/v1/jobs/{service.submit(client)['id']}/events")
    assert (answer.status_code, answer.headers["content-type"]) == (200, "text/event-stream; charset=utf-8")


def test_many_idle_streams_hold_up_nobody(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    """More streams than the server has threads or connections to the database stay open while others are served."""
    job = service.submit(client)
    held, count = claim(sessions, job["id"]), 120
    opened = threading.Semaphore(0)

    def follow(_: int) -> str:
        with many.stream("GET", f"/v1/jobs/{job['id']}/events") as answer:
            seen: list[str] = []
            for event in events(answer.iter_lines()):
                seen.append(event["event"])
                if event["event"] == "running":
                    opened.release()
        return seen[-1]

    limits = httpx.Limits(max_connections=count)
    with httpx.Client(base_url=client.base_url, timeout=60.0, limits=limits) as many, ThreadPoolExecutor(count) as pool:
        following = [pool.submit(follow, number) for number in range(count)]
        for _ in range(count):
            assert opened.acquire(timeout=60.0)
        assert client.get("/v1/jobs").status_code == 200
        assert service.submit(client)["status"] == "accepted"
        finish(sessions, held)
        assert {task.result() for task in following} == {"successful"}


@pytest.mark.parametrize("path", ["results", "results/frequencies", "results/frequencies?format=csv"])
def test_results_that_the_client_has_are_not_sent(client: httpx.Client, settings: Settings, path: str) -> None:
    address = f"{service.finished(client, settings)}/{path}"
    first = client.get(address)
    tag = first.headers["etag"]
    again = client.get(address, headers={"If-None-Match": f'"other", {tag}'})
    assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", tag)
    assert client.get(address, headers={"If-None-Match": '"other"'}).content == first.content
    assert client.head(address).headers["etag"] == tag


def test_forms_and_documents_have_tags_of_their_own(client: httpx.Client, settings: Settings) -> None:
    address = service.finished(client, settings)
    other = service.finished(client, settings, {**short_request(), "analysis": {**SHORT, "loops": [1, 2]}})

    def tag(of: str, path: str, **headers: str) -> str:
        return str(client.get(f"{of}/{path}", headers=headers).headers["etag"])

    table = "results/frequencies"
    tags = [tag(address, table), tag(address, table, accept="text/csv"), tag(other, table)]
    assert len(set(tags)) == 3


def test_a_picture_that_the_client_has_is_not_drawn(client: httpx.Client, settings: Settings) -> None:
    address = f"{service.finished(client, settings)}/plots/amplitude.svg"
    tag = client.get(address).headers["etag"]
    assert client.get(address, headers={"If-None-Match": tag}).status_code == 304


def test_a_batch_has_a_new_tag_when_lines_were_run_again(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    address = batch_address(client)
    assert "etag" not in client.get(f"{address}/results?partial=true").headers
    held = claim(sessions, str(chunks(client, address)[0]))
    with sessions.begin() as session:
        leases.fail(session, held, Failure(FailureKind.TIME_LIMIT, "too long"))
    tag = client.get(f"{address}/results").headers["etag"]
    known = {"If-None-Match": tag}
    assert client.get(f"{address}/results", headers=known).status_code == 304
    assert client.get(f"{address}/results?format=csv", headers=known).status_code == 200
    client.post(f"{address}/resubmit")
    for chunk in chunks(client, address):
        run_job(settings, chunk)
    wait_until(lambda: client.get(address).json()["status"] == "successful", what="the end")
    answer = client.get(f"{address}/results", headers=known)
    assert answer.status_code == 200
    assert answer.headers["etag"] != tag
