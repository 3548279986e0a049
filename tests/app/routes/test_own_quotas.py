"""Quotas over HTTP: every way by which work enters, what a refusal says, and what an owner is told of them."""

import json
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.jobs.owner_quotas import Bounded, OverQuota
from app.pages.wording import words
from app.routes.own_quotas import problem
from tests.app import service
from tests.app.lines import SHORT
from tests.app.pages.reading import read, send
from tests.documents import short_request

ROOM = 60_000  # of a few short jobs, and of no study of thousands
EXECUTION = "/ogc/processes/galloping/execution"
AT_ONCE = {"Prefer": "respond-async"}


def study(points: int) -> dict[str, Any]:
    axis = {"parameter": "span.horizontal_tension_n", "values": [25e3 + number for number in range(points)]}
    return {**short_request(), "study": {"axes": [axis]}}


def batch(lines: int) -> dict[str, Any]:
    return {"lines": [short_request()["line"]] * lines, "analysis": SHORT}


def used(client: httpx.Client, name: str) -> int:
    found: int = client.get("/v1/quotas").json()[name]["used"]
    return found


Way = Callable[[httpx.Client], httpx.Response]
WAYS: dict[str, Way] = {
    "job": lambda client: client.post("/v1/jobs", json=short_request(), headers=service.ANEW),
    "remedies": lambda client: client.post("/v1/remedies", json={"line": short_request()["line"]}),
    "batch": lambda client: client.post("/v1/batches", json=batch(1)),
    "execution": lambda client: client.post(EXECUTION, json={"inputs": short_request()}, headers=AT_ONCE),
    "form": lambda client: send(client, "/pages/examples/c11-twin", {}),
}


@pytest.mark.parametrize("way", WAYS)
def test_too_many_that_wait_are_refused_by_every_way(tmp_path: Path, way: str) -> None:
    with service.running(service.sqlite_settings(tmp_path, waiting_jobs_per_owner=2)) as client:
        jobs = [service.submit(client)["id"] for _ in range(2)]
        answer = WAYS[way](client)
        assert (answer.status_code, answer.headers["retry-after"]) == (429, "30")
        if way == "form":
            assert "2 jobs and chunks of one owner may wait, and with this 3 would." in answer.text
        else:
            assert answer.json()["type"] == "/problems/too-many-waiting"
            assert answer.json()["links"] == [{"rel": "quotas", "href": "/v1/quotas"}]
        assert used(client, "waiting_jobs") == 2
        client.post(f"/v1/jobs/{jobs[0]}/cancel").raise_for_status()
        assert WAYS[way](client).status_code < 400, "there is a place again"


@pytest.mark.parametrize("way", WAYS)
def test_what_has_no_room_is_refused_by_every_way_until_something_is_removed(tmp_path: Path, way: str) -> None:
    settings = service.sqlite_settings(tmp_path, stored_bytes_per_owner=ROOM)
    with service.running(settings) as client:
        made = [service.finished(client, settings)]
        while (answer := client.post("/v1/jobs", json=short_request())).status_code == 202:
            made.append(answer.headers["location"])
        assert answer.json()["type"] == "/problems/storage-full", "copies of stored results count, too"
        refused = WAYS[way](client)
        assert refused.status_code == 507
        assert "DELETE ended jobs and batches" in refused.text
        assert ROOM - 20_000 < used(client, "stored_bytes") <= ROOM
        for address in made:
            client.delete(address).raise_for_status()
        assert WAYS[way](client).status_code < 400


def test_studies_posted_at_once_do_not_fill_the_disk(tmp_path: Path) -> None:
    """Each of them is expected to leave 5.3 MB; before there were quotas all were accepted."""
    with service.running(service.sqlite_settings(tmp_path, stored_bytes_per_owner=30_000_000)) as client:
        answers = [client.post("/v1/jobs", json=study(1000), headers=service.ANEW).status_code for _ in range(8)]
        assert answers == [202] * 5 + [507] * 3
        document = client.get("/v1/quotas").json()
        assert 25_000_000 < document["stored_bytes"]["used"] <= 30_000_000
        assert document["expected_bytes"] > 0.99 * document["stored_bytes"]["used"]
        assert client.post("/v1/jobs", json=short_request()).status_code == 202, "a line still has room"


def test_a_batch_over_a_quota_is_refused_before_its_body_is_read(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path, waiting_jobs_per_owner=1)) as client:
        service.submit(client)
        head = b"POST /v1/batches HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        with socket.create_connection((client.base_url.host, client.base_url.port or 80), 20.0) as connection:
            connection.sendall(head + b"Content-Length: 1000000\r\n\r\n{")
            answered = b"".join(iter(lambda: connection.recv(65_536), b""))
        assert answered.startswith(b"HTTP/1.1 429 ")
        assert b"/problems/too-many-waiting" in answered


def test_a_batch_whose_results_have_no_room_is_refused_and_leaves_nothing(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path, stored_bytes_per_owner=200_000)) as client:
        lines = [short_request()["line"]] * 1200
        body = "\n".join(json.dumps(item) for item in ({"analysis": SHORT}, *lines))
        answer = client.post("/v1/batches", content=body, headers={"Content-Type": "application/x-ndjson"})
        assert answer.status_code == 507
        assert used(client, "stored_bytes") == used(client, "waiting_jobs") == 0
        assert client.get("/v1/batches").json()["batches"] == []
        assert client.post("/v1/batches", json=batch(3)).status_code == 202


def test_a_batch_of_more_chunks_than_may_wait_is_refused(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, waiting_jobs_per_owner=2, most_chunk_lines=1)
    with service.running(settings) as client:
        assert client.post("/v1/batches", json=batch(3)).json()["type"] == "/problems/too-many-waiting"
        assert client.post("/v1/batches", json=batch(2)).status_code == 202
        assert client.post("/v1/batches/estimate", json=batch(3)).status_code == 200, "nothing is stored"


def test_a_retry_is_another_job(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, waiting_jobs_per_owner=1)
    with service.running(settings) as client:
        address = service.finished(client, settings)
        assert client.post(f"{address}/retry").status_code == 202
        assert client.post(f"{address}/retry").status_code == 429


def test_a_post_that_was_answered_is_answered_again_whatever_the_quota(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path, waiting_jobs_per_owner=1)) as client:
        first, second = ({"Idempotency-Key": value, **service.ANEW} for value in ("a", "b"))
        made = client.post("/v1/jobs", json=short_request(), headers=first)
        assert client.post("/v1/jobs", json=short_request(), headers=second).status_code == 429
        again = client.post("/v1/jobs", json=short_request(), headers=first)
        assert (again.status_code, again.json()["id"]) == (202, made.json()["id"])
        client.post(f"/v1/jobs/{made.json()['id']}/cancel").raise_for_status()
        assert client.post("/v1/jobs", json=short_request(), headers=second).status_code == 202


def test_an_owner_sees_what_is_used_and_allowed(tmp_path: Path) -> None:
    settings = service.sqlite_settings(
        tmp_path, running_jobs_per_owner=3, waiting_jobs_per_owner=0, stored_bytes_per_owner=5_000_000
    )
    with service.running(settings) as client:
        nothing = client.get("/v1/quotas").json()
        assert nothing == {
            "running_jobs": {"used": 0, "most": 3},
            "waiting_jobs": {"used": 0, "most": None},
            "stored_bytes": {"used": 0, "most": 5_000_000},
            "expected_bytes": 0,
        }
        service.submit(client)
        found = client.get("/v1/quotas").json()
        assert found["waiting_jobs"]["used"] == 1
        assert 0 < found["expected_bytes"] < found["stored_bytes"]["used"] < 20_000
        said = words().jobs.stored.format(running=0, waiting=1, stored="0.0", most="5")
        assert said in read(client, "/pages/jobs").text


def test_a_problem_says_how_much_there_is_and_how_much_is_asked_for() -> None:
    full = problem(OverQuota(Bounded.BYTES, 900, 200, 1000))
    assert "may take 1000 bytes. They take 900, and this needs 200 more." in full.detail
    assert full.headers is None
    waiting = problem(OverQuota(Bounded.WAITING, 9, 3, 10), {"Connection": "close"})
    assert waiting.headers == {"Retry-After": "30", "Connection": "close"}
