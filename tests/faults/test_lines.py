"""Hundreds of whole lines through the API and the engine: no 5xx, no internal failure, and every wind has its rows."""

import json
from collections import Counter
from collections.abc import Iterator
from uuid import UUID

import httpx
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from app.runtime.settings import Settings
from tests.app import service, whole_lines
from tests.app.whole_lines import Json, assert_answers_every_wind, assert_is_named
from tests.faults import figures
from tests.faults.scale import SCALE
from tests.in_process import run_job

JSON = {"Content-Type": "application/json", **service.ANEW}


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Give settings of a service of this file's own."""
    return service.sqlite_settings(tmp_path_factory.mktemp("lines"))


@pytest.fixture(scope="module")
def client(own: Settings) -> Iterator[httpx.Client]:
    """Give a client of that service."""
    with service.running(own) as running:
        yield running


@pytest.mark.parametrize(
    ("kind", "requests", "count"),
    [
        ("usual", whole_lines.REQUESTS, 100),
        ("far off", whole_lines.far_off(), 200),
        ("broken", whole_lines.broken(), 300),
    ],
)
def test_lines_are_answered_or_their_faults_named(
    client: httpx.Client, own: Settings, kind: str, requests: st.SearchStrategy[Json], count: int
) -> None:
    told: Counter[str] = Counter()

    @settings(
        max_examples=max(10, round(SCALE * count)),
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(requests)
    def ask(request: Json) -> None:
        told[outcome(client, own, request)] += 1

    ask()
    figures.note(f"lines, {kind}", {"lines": told.total(), **told})


def outcome(client: httpx.Client, own: Settings, request: Json) -> str:
    """Return in words what became of a request."""
    answer = client.post("/v1/jobs", content=json.dumps(request), headers=JSON)  # httpx would refuse to send NaN
    if answer.status_code == 422:
        for fault in answer.json()["errors"]:
            assert_is_named(fault["pointer"], fault["code"], fault["detail"])
        return "refused, faults named"
    assert answer.status_code == 202, answer.text
    address = f"/v1/jobs/{answer.json()['id']}"
    run_job(own, UUID(answer.json()["id"]))
    job = client.get(address).raise_for_status().json()
    if job["status"] == "failed":
        assert job["failure"]["kind"] == "input", job
        return "failed for what they hold, in a sentence"
    assert_answers_every_wind(request["analysis"], client.get(f"{address}/results").raise_for_status().json())
    return "answered for every wind"
