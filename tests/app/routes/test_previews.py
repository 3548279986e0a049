from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from app.reference.source_lines import example
from app.routes.own_documentation import KNOWN_LINE
from tests.app import service

ADDRESS = "/v1/previews"
ANALYSIS: dict[str, Any] = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with service.running(service.sqlite_settings(tmp_path_factory.mktemp("service"), preview_seconds=60.0)) as client:
        yield client


def test_a_line_is_computed_at_once_and_nothing_is_stored(client: httpx.Client) -> None:
    for line in (example("c11-twin"), KNOWN_LINE):
        answer = client.post(ADDRESS, json={"line": line, "analysis": ANALYSIS}, timeout=60.0)
        assert answer.status_code == 200, answer.text
        found = answer.json()
        assert found["verdict"][0]["gallops"] in {"yes", "no", "undecided"}
        assert len(found["critical_wind_speeds"]) > 0
        assert found["input"]["analysis"]["uncertainty"]["samples"] == 0
    assert [row["origin"] for row in found["assumptions"] if row["path"] == "conductor.diameter_m"] == ["catalogue"]
    assert client.get("/v1/jobs").json()["jobs"] == []


def test_what_only_jobs_take_is_refused_by_its_name(client: httpx.Client) -> None:
    study = {"axes": [{"parameter": "span.horizontal_tension_n", "values": [24000, 30000]}]}
    answer = client.post(ADDRESS, json={"line": example("c11-twin"), "analysis": ANALYSIS, "study": study})
    assert answer.status_code == 422
    assert [fault["pointer"] for fault in answer.json()["errors"]] == ["/study"]
