import csv
import io
from typing import Any

import httpx
import pytest

from app.answers.batches import RankingPage
from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests.app.lines import SHORT, changed
from tests.app.service import work_off

TWIN = example("c11-twin")
SECTOR = {"direction_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}


def climate(hours: float | None) -> dict[str, Any] | None:
    icing = [{"kind": "glaze", "hours_a_year": hours}]
    return None if hours is None else {"line_azimuth_deg": 90.0, "sectors": [SECTOR], "icing": icing}


LINES = [
    {
        **changed("span.length_m", length, TWIN),
        "reference": f"L{length:g}",
        "asset_id": f"A{length:g}",
        "climate": climate(hours),
    }
    for length, hours in ((100.0, 20.0), (150.0, 80.0), (125.0, None))
]


@pytest.fixture(scope="module")
def address(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished batch of three spans, of which the longer gallop further."""
    answer = shared_client.post("/v1/batches", json={"lines": LINES, "analysis": SHORT})
    assert answer.status_code == 202, answer.text
    work_off(shared_client, shared_settings, answer.headers["location"])
    return str(answer.headers["location"])


def ranked(client: httpx.Client, address: str, **query: Any) -> list[dict[str, Any]]:
    """Return all lines of a ranking by following its pages."""
    lines: list[dict[str, Any]] = []
    url: str | None = str(httpx.URL(f"{address}/ranking", params=query))
    while url:
        answer = client.get(url)
        assert answer.status_code == 200, answer.text
        RankingPage.model_validate_json(answer.content)
        lines += answer.json()["lines"]
        url = answer.json()["next"]
    return lines


@pytest.mark.parametrize("limit", [1, 2, 50])
def test_the_largest_amplitude_comes_first(shared_client: httpx.Client, address: str, limit: int) -> None:
    lines = ranked(shared_client, address, by="amplitude", limit=limit)
    assert [line["rank"] for line in lines] == [1, 2, 3]
    assert [line["reference"] for line in lines] == ["L150", "L125", "L100"]
    amplitudes = [line["largest_vertical_m"] for line in lines]
    assert amplitudes == sorted(amplitudes, reverse=True)
    assert lines[0]["margin_m_per_s"] is lines[0]["clearance_m"] is None


def test_the_least_margin_of_the_critical_wind_speed_comes_first(shared_client: httpx.Client, address: str) -> None:
    lines = ranked(shared_client, address, by="critical-wind-margin", design_wind_speed_m_per_s=2.5, limit=2)
    margins = [line["margin_m_per_s"] for line in lines]
    assert margins == sorted(margins)
    for line in lines:
        assert line["margin_m_per_s"] == pytest.approx(line["lowest_critical_wind_speed_m_per_s"] - 2.5)


def test_the_most_hours_of_galloping_come_first(shared_client: httpx.Client, address: str) -> None:
    lines = ranked(shared_client, address, by="risk", limit=1)
    assert [line["reference"] for line in lines] == ["L150", "L100"]  # iced for 80 and 20 hours; the third: no climate
    hours = [line["galloping_hours_a_year"] for line in lines]
    assert hours[0] > 2.0 * hours[1] > 0.0
    summary = shared_client.get(f"{address}/results", params={"table": "summary"}, headers={"accept": "text/csv"})
    assert "galloping_hours_a_year" in summary.text.splitlines()[0]


@pytest.mark.parametrize(("spacing", "extent"), [("vertical_spacing_m", "height"), ("horizontal_spacing_m", "width")])
def test_the_least_clearance_comes_first(shared_client: httpx.Client, address: str, spacing: str, extent: str) -> None:
    lines = ranked(shared_client, address, by="clearance", **{spacing: 3.0})
    clearances = [line["clearance_m"] for line in lines]
    assert clearances == sorted(clearances)
    for line in lines:
        assert line["clearance_m"] == pytest.approx(3.0 - line[f"largest_{extent}_m"])


@pytest.mark.parametrize(
    "query",
    [
        "by=weight",
        "vertical_spacing_m=3",
        "by=amplitude&design_wind_speed_m_per_s=3",
        "by=critical-wind-margin",
        "by=clearance",
        "by=clearance&vertical_spacing_m=3&horizontal_spacing_m=3",
        "by=amplitude&vertical_spacing_m=3",
        "by=clearance&vertical_spacing_m=-1",
        "by=amplitude&limit=0",
        "by=amplitude&cursor=AAAA",
        "by=amplitude&colour=red",
    ],
)
def test_queries_that_make_no_sense_are_refused(shared_client: httpx.Client, address: str, query: str) -> None:
    answer = shared_client.get(f"{address}/ranking?{query}")
    assert answer.status_code == 400
    assert answer.json()["errors"]


def test_a_ranking_waits_for_the_end_unless_a_partial_one_is_asked_for(shared_client: httpx.Client) -> None:
    address = shared_client.post("/v1/batches", json={"lines": LINES, "analysis": SHORT}).headers["location"]
    assert shared_client.get(f"{address}/ranking?by=amplitude").status_code == 409
    assert ranked(shared_client, address, by="amplitude", partial=True) == []


def test_there_is_no_ranking_of_no_batch(shared_client: httpx.Client, address: str) -> None:
    other = address[:-1] + ("0" if address[-1] != "0" else "1")
    assert shared_client.get(f"{other}/ranking?by=amplitude").status_code == 404


def test_a_line_whose_motion_is_unknown_ranks_before_the_others(
    shared_client: httpx.Client, shared_settings: Settings
) -> None:
    """At 4 m/s nothing in the equations bounds the motion of the second line; at 1 m/s both rest."""
    unbounded = changed("ice.aerodynamics.vertical", [-0.1667, -4.0547, -8.3581], TWIN)
    lines = [{**TWIN, "reference": "known"}, {**unbounded, "reference": "unknown"}]
    analysis = {**SHORT, "wind_speeds_m_per_s": [1.0, 4.0]}
    answer = shared_client.post("/v1/batches", json={"lines": lines, "analysis": analysis})
    assert answer.status_code == 202, answer.text
    work_off(shared_client, shared_settings, answer.headers["location"])
    for query in ({"by": "amplitude"}, {"by": "clearance", "vertical_spacing_m": 3.0}):
        first, second = ranked(shared_client, answer.headers["location"], **query)
        assert (first["reference"], first["unknown_motions"]) == ("unknown", True)
        assert first["largest_vertical_m"] is first["largest_height_m"] is first["clearance_m"] is None
        assert (second["reference"], second["unknown_motions"]) == ("known", False)
        assert second["largest_vertical_m"] > 0.1
    text = shared_client.get(f"{answer.headers['location']}/results", params={"format": "csv"}).text
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [(row["unknown_motions"], bool(row["largest_vertical_m"])) for row in rows] == [
        ("False", True),
        ("True", False),
    ]
