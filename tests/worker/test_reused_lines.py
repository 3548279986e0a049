"""Lines of batches whose results are stored already, through the API and a worker's execution, on either database."""

import json
from collections.abc import Iterator
from typing import Any
from uuid import UUID

import httpx
import pytest
from sqlalchemy import update
from sqlalchemy.orm import Session, sessionmaker

from app import keys
from app.auth import LOCAL, Scope
from app.examples import example
from app.settings import Settings
from app.tables import PointRow
from tests.app import service
from tests.app.lines import SHORT, changed
from tests.documents import STRANGER
from tests.servers import wait_until
from worker.execute import run_job

TWIN = example("c11-twin")
LINES = [{**changed("span.length_m", 100.0 + number, TWIN), "reference": f"r{number}"} for number in range(4)]


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service on either kind of database."""
    with service.running(settings) as running:
        yield running


def finished(client: httpx.Client, settings: Settings, lines: list[dict[str, Any]], **changes: Any) -> dict[str, Any]:
    """Post a batch, work it off in this process, and return its status document."""
    headers = {"Cache-Control": "no-cache"} if changes.pop("anew", False) else {}
    body = {"lines": lines, "analysis": {**SHORT, **changes}}
    address = client.post("/v1/batches", json=body, headers=headers).headers["location"]
    for chunk in client.get("/v1/jobs", params={"batch_id": address[-36:]}).json()["jobs"]:
        run_job(settings, UUID(chunk["id"]), "test")
    found: dict[str, Any] = client.get(address).json()
    assert found["status"] == "successful"
    return found


def told(client: httpx.Client, batch: dict[str, Any]) -> list[dict[str, Any]]:
    """Return everything that is told of the lines, without what is theirs alone."""
    text = client.get(f"/v1/batches/{batch['id']}/results?format=ndjson").text
    return [json.loads(line) for line in text.splitlines()]


def test_equal_lines_are_not_computed_again(client: httpx.Client, settings: Settings) -> None:
    first = finished(client, settings, LINES)
    assert (first["lines"]["successful"], first["lines"]["reused"]) == (4, 0)
    labelled = [{**line, "name": "other", "asset_id": f"A{n}", "tags": {"a": "b"}} for n, line in enumerate(LINES)]
    again = finished(client, settings, [*labelled[::-1], changed("span.length_m", 90.0, TWIN)])
    assert (again["lines"]["successful"], again["lines"]["reused"]) == (5, 4)
    before, after = told(client, first), told(client, again)
    own = {"number", "reference", "asset_id"}
    for one, other in zip(before, after[3::-1], strict=True):
        assert {k: v for k, v in one.items() if k not in own} == {k: v for k, v in other.items() if k not in own}
    assert [(line["number"], line["reference"]) for line in after[:2]] == [(1, "r3"), (2, "r2")]


def test_another_analysis_is_computed_and_so_is_what_is_asked_anew(client: httpx.Client, settings: Settings) -> None:
    finished(client, settings, LINES)
    assert finished(client, settings, LINES, loops=[2])["lines"]["reused"] == 0
    assert finished(client, settings, LINES, anew=True)["lines"]["reused"] == 0


def test_another_version_is_computed(client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]) -> None:
    finished(client, settings, LINES)
    with sessions.begin() as session:
        session.execute(update(PointRow).where(PointRow.point <= 3).values(engine_version="0.0.1"))
    assert finished(client, settings, LINES)["lines"]["reused"] == 1


def test_another_owner_is_told_nothing(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    finished(client, settings, LINES)
    with sessions.begin() as session:
        headers = [
            {"Authorization": f"Bearer {keys.create(session, name, tuple(Scope), None, None)[1]}"}
            for name in (LOCAL.owner, STRANGER.owner)
        ]
    for header, reused in zip(headers, (4, 0), strict=True):
        client.headers.update(header)
        wait_until(lambda: client.get("/v1/jobs").status_code == 200, what="the key")
        assert finished(client, settings, LINES)["lines"]["reused"] == reused


def test_reused_lines_outlive_the_batch_that_they_come_from(client: httpx.Client, settings: Settings) -> None:
    first = finished(client, settings, LINES)
    second = finished(client, settings, LINES)
    assert client.delete(f"/v1/batches/{first['id']}").status_code == 204
    assert second["lines"]["reused"] == 4
    assert [line["status"] for line in told(client, second)] == ["successful"] * 4
    third = finished(client, settings, LINES)
    assert third["lines"]["reused"] == 4
