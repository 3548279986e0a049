import csv
import io
from typing import Any

import httpx
import pytest

from app import convert
from app.answers.clearance import Clearance
from app.runtime.settings import Settings
from tests.app import service
from tests.documents import short_request


@pytest.fixture(scope="module")
def address(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished job of the twin line, one loop at 4, 5 and 6 m/s."""
    return service.finished(shared_client, shared_settings)


def clearance(client: httpx.Client, address: str, **query: Any) -> dict[str, Any]:
    answer = client.get(f"{address}/clearance", params=query)
    assert answer.status_code == 200, answer.text
    Clearance.model_validate_json(answer.content)
    found: dict[str, Any] = answer.json()
    return found


def test_phases_above_each_other_keep_their_spacing_less_the_height(shared_client: httpx.Client, address: str) -> None:
    motions = clearance(shared_client, address, vertical_spacing_m=4.0)["motions"]
    assert [row["wind_speed_m_per_s"] for row in motions] == [4.0, 5.0, 6.0]
    for row in motions:
        assert row["clearance_m"] == pytest.approx(4.0 - row["height_m"], abs=0.02)
    # Theory section 10: 0.2884 m of amplitude, and the bundle turns by 0.0041 rad.
    assert motions[-1]["height_m"] == pytest.approx(2.0 * 0.2884, rel=0.02)
    assert motions[-1]["width_m"] == pytest.approx(2.0 * (0.2355 + 0.0275), rel=0.02)


def test_phases_beside_each_other_keep_their_spacing_less_the_width(shared_client: httpx.Client, address: str) -> None:
    motions = clearance(shared_client, address, horizontal_spacing_m=-5.0)["motions"]
    found = [row["clearance_m"] for row in motions]
    assert len(found) == 3
    assert found == pytest.approx([5.0 - row["width_m"] for row in motions], abs=0.02)


def test_envelopes_overlap_where_phases_are_too_near(shared_client: httpx.Client, address: str) -> None:
    assert clearance(shared_client, address, vertical_spacing_m=0.1)["motions"][-1]["clearance_m"] < 0.0


def test_the_ellipse_is_that_of_the_command_line(shared_client: httpx.Client, address: str) -> None:
    sag = shared_client.get(f"{address}/results").json()["static"]["sag_m"]
    found = clearance(shared_client, address, vertical_spacing_m=4.0, method="davison")["ellipse"]
    expected = convert.ellipse("davison", sag, None, None, 1)
    assert {name: found[name] for name in expected} == pytest.approx(expected)
    assert found["clearance_m"] == pytest.approx(4.0 - found["major_axis_m"], abs=1e-3)
    bundle = clearance(shared_client, address, vertical_spacing_m=4.0)["ellipse"]
    assert bundle["major_axis_m"] is None  # CIGRE sees no galloping of a bundle that sags by 54 diameters


@pytest.mark.parametrize("query", ["", "vertical_spacing_m=x", "vertical_spacing_m=3&method=mine", "colour=1"])
def test_queries_that_make_no_sense_are_refused(shared_client: httpx.Client, address: str, query: str) -> None:
    assert shared_client.get(f"{address}/clearance?{query}").status_code == 400


def test_a_point_that_there_is_not_is_404_and_a_waiting_job_409(shared_client: httpx.Client, address: str) -> None:
    assert shared_client.get(f"{address}/clearance?vertical_spacing_m=3&point=1").status_code == 404
    other = short_request()
    other["line"]["span"]["length_m"] = 99.0  # what was asked before is answered at once
    waiting = service.submit(shared_client, other)
    assert shared_client.get(f"/v1/jobs/{waiting['id']}/clearance").status_code == 409


def test_the_report_has_the_rows_of_the_table_under_the_names_of_reports(
    shared_client: httpx.Client, shared_settings: Settings
) -> None:
    request = short_request()
    request["line"] |= {"phases": [{"name": "top", "y_m": 4.0}], "tags": {"structure": "T17"}}
    job = service.finished(shared_client, shared_settings, request)
    rows = shared_client.get(f"{job}/results/clearances").json()["clearances"]
    answer = shared_client.get(f"{job}/clearance-report")
    assert answer.headers["content-type"].startswith("text/csv")
    report = list(csv.DictReader(io.StringIO(answer.text)))
    assert len(report) == len(rows) > 4
    for made, row in zip(report, rows, strict=True):
        assert (made["structure"], made["phase"], made["galloping_ellipse_method"]) == ("T17", "this", row["method"])
        for name, column in (("distance", "distance_m"), ("major_axis_length", "major_axis_m")):
            assert made[name] == ("" if row[column] is None else str(row[column]))
    missing = shared_client.get(f"{job}/clearance-report", params={"point": 7})
    assert (missing.status_code, missing.json()["detail"]) == (404, "The job has no results at point 7.")
