import httpx
import pytest

from tests.documents import short_request


@pytest.fixture
def batch(client: httpx.Client) -> str:
    return str(client.post("/v1/batches", json={"lines": [short_request()["line"]]}).headers["Location"])


def test_a_batch_gets_labels_after_it_was_submitted(client: httpx.Client, batch: str) -> None:
    assert (client.get(batch).json()["name"], client.get(batch).json()["tags"]) == (None, {})
    named = client.patch(batch, json={"name": "Winter check", "tags": {"region": "north", "season": "2026"}})
    assert named.status_code == 200, named.text
    changed = client.patch(batch, json={"tags": {"season": None, "crew": "7"}}).json()
    assert (changed["name"], changed["tags"]) == ("Winter check", {"crew": "7", "region": "north"})
    assert client.get(batch).json() == changed
    (listed,) = client.get("/v1/batches").json()["batches"]
    assert (listed["name"], listed["tags"]) == ("Winter check", {"crew": "7", "region": "north"})
    assert client.patch(batch, json={"name": None, "tags": None}).json()["tags"] == {}
    assert client.get(batch).json()["name"] is None


def test_what_is_no_label_of_a_batch_is_refused(client: httpx.Client, batch: str) -> None:
    answer = client.patch(batch, json={"asset_id": "L1"})
    assert (answer.status_code, answer.json()["errors"][0]["pointer"]) == (422, "/asset_id")
    assert client.patch(f"{batch[:-1]}{'0' if batch[-1] != '0' else '1'}", json={}).status_code == 404
