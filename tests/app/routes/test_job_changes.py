from uuid import UUID

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app import service
from tests.documents import short_request
from tests.in_process import run_job


def labelled(client: httpx.Client) -> str:
    line = {**short_request()["line"], "name": "span", "asset_id": "L1", "tags": {"region": "north", "season": "2025"}}
    return f"/v1/jobs/{service.submit(client, {**short_request(), 'line': line})['id']}"


def test_labels_change_as_a_merge_patch_says(client: httpx.Client) -> None:
    job = labelled(client)
    changed = client.patch(job, json={"name": None, "tags": {"region": "south", "season": None, "crew": "7"}})
    assert changed.status_code == 200, changed.text
    status = client.get(job).json()
    assert changed.json() == status
    assert (status["name"], status["asset_id"], status["tags"]) == (None, "L1", {"crew": "7", "region": "south"})
    assert [found["id"] for found in client.get("/v1/jobs?tag=crew:7").json()["jobs"]] == [status["id"]]
    assert client.get("/v1/jobs?tag=season:2025").json()["jobs"] == []
    assert client.patch(job, json={}).json() == status
    assert client.patch(job, json={"tags": None}).json()["tags"] == {}


@pytest.mark.parametrize(
    ("labels", "pointer"),
    [({"colour": "red"}, "/colour"), ({"tags": {"a:b": "c"}}, "/tags/a:b"), ({"name": ""}, "/name"), ([], "")],
)
def test_what_is_no_label_is_refused(client: httpx.Client, labels: object, pointer: str) -> None:
    answer = client.patch(labelled(client), json=labels)
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["pointer"].startswith(pointer)


def test_an_ended_job_runs_again_as_a_new_one_with_its_labels(client: httpx.Client, settings: Settings) -> None:
    job = labelled(client)
    waiting = client.post(f"{job}/retry")
    assert (waiting.status_code, waiting.json()["type"]) == (409, "/problems/not-ready")
    client.post(f"{job}/cancel")
    key = {"Idempotency-Key": "again"}
    again = client.post(f"{job}/retry", headers=key)
    assert again.status_code == 202, again.text
    new = again.json()
    assert again.headers["Location"] == f"/v1/jobs/{new['id']}" != job
    assert (new["name"], new["tags"]) == ("span", {"region": "north", "season": "2025"})
    replayed = client.post(f"{job}/retry", headers=key)
    assert (replayed.json(), replayed.headers["Idempotency-Replayed"]) == (new, "true")
    run_job(settings, UUID(new["id"]))
    assert client.get(f"/v1/jobs/{new['id']}").json()["status"] == "successful"
    assert client.get(job).json()["status"] == "dismissed"


def test_a_chunk_is_resubmitted_with_its_batch(client: httpx.Client) -> None:
    address = client.post("/v1/batches", json={"lines": [short_request()["line"]]}).headers["Location"]
    (chunk,) = service.chunks(client, address)
    refused = client.post(f"/v1/jobs/{chunk}/retry")
    assert refused.status_code == 404
    assert "resubmit" in refused.json()["detail"]
