"""Lines from GIS and CIM programs, posted as batches, and their results as features."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.export.formats import GEOJSON, RDF_XML
from app.runtime.settings import Settings
from tests.app import service
from tests.app.service import work_off

EXAMPLES = Path(__file__).parents[3] / "docs" / "examples"
SPANS = json.loads((EXAMPLES / "spans.geojson").read_text())
ICED = {name: SPANS["defaults"][name] for name in ("span", "ice")}
SHORT = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [6.0]}


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    with service.running(settings) as running:
        yield running


def post(client: httpx.Client, body: Any, media_type: str = GEOJSON, **query: str) -> httpx.Response:
    content = body if isinstance(body, bytes) else json.dumps(body).encode()
    return client.post("/v1/batches", params=query, content=content, headers={"Content-Type": media_type})


def features(client: httpx.Client, address: str, **query: str) -> list[dict[str, Any]]:
    answer = client.get(f"{address}/results", params=query, headers={"Accept": GEOJSON})
    assert (answer.status_code, answer.headers["content-type"]) == (200, GEOJSON), answer.text
    found: list[dict[str, Any]] = answer.json()["features"]
    return found


def test_features_run_and_come_back_with_their_coordinates(client: httpx.Client, settings: Settings) -> None:
    answer = post(client, (EXAMPLES / "spans.geojson").read_bytes(), atomic="true")
    assert answer.status_code == 202, answer.text
    address = answer.headers["location"]
    status = work_off(client, settings, address)
    assert (status["status"], status["lines"]["successful"], status["notes"]) == ("successful", 5, [])
    found = features(client, address)
    assert [one["properties"]["reference"] for one in found] == [
        "L204-S017",
        "L204-S018/1",
        "L204-S018/2",
        "L204-S018/3",
        "L204-S021",
    ]
    (alone, several, point) = (one["geometry"] for one in SPANS["features"])
    assert (found[0]["geometry"], found[4]["geometry"]) == (alone, point)
    assert [one["geometry"]["coordinates"] for one in found[1:4]] == [
        several["coordinates"][i : i + 2] for i in range(3)
    ]
    summary = client.get(f"{address}/results?table=summary&format=ndjson").text.splitlines()
    assert [one["properties"] for one in found] == [json.loads(row) for row in summary]
    assert {one["properties"]["gallops"] for one in found} == {"yes"}
    assert features(client, address, format="geojson", table="summary") == found
    refused = client.get(f"{address}/results?format=geojson&table=verdict")
    assert refused.status_code == 400 and "summary" in refused.text


def test_what_follows_from_coordinates_says_so(client: httpx.Client, settings: Settings) -> None:
    answer = post(client, SPANS)
    work_off(client, settings, answer.headers["location"])
    whole = [json.loads(line) for line in client.get(f"{answer.headers['location']}/results").text.splitlines()]
    tables = client.get(f"{answer.headers['location']}/results?table=assumptions&format=ndjson").text.splitlines()
    for number, names in ((1, {"length_m", "line_azimuth_deg", "level_difference_m"}), (5, set())):
        rows = [json.loads(row) for row in tables if json.loads(row)["number"] == number]
        assert rows == [
            {**{name: whole[number - 1][name] for name in ("number", "reference", "asset_id")}, **row}
            for row in whole[number - 1]["assumptions"]
        ]
        computed = {row["path"]: row for row in rows if "coordinates" in row["source"]}
        assert {path.partition(".")[2] for path in computed} == names
        assert {row["origin"] for row in computed.values()} <= {"computed"}
        assert len({row["path"] for row in rows}) == len(rows)
    first = {row["path"]: row["value"] for row in whole[0]["assumptions"]}
    assert first["span.length_m"] == pytest.approx(306.941, abs=1e-3)  # by the radii of curvature at its middle
    assert first["span.level_difference_m"] == 6.5
    assert first["climate.line_azimuth_deg"] == pytest.approx(57.07, abs=0.01)


def test_bad_features_are_told_of_and_the_others_run(client: httpx.Client) -> None:
    good, several, point = SPANS["features"]
    bad = [
        {**good, "geometry": {"type": "Polygon", "coordinates": []}},
        {**good, "properties": {"span.lenght_m": 300.0}},
        {**good, "properties": {"span.elements": 1}},
        {**several, "geometry": {"type": "LineString", "coordinates": [[14.0, 50.0], [14.0, 50.003], [24.0, 50.003]]}},
    ]
    answer = post(client, {**SPANS, "features": [good, *bad, point]})
    assert answer.status_code == 202, answer.text
    found = [(one["number"], one["place"], one["row"], one["pointer"]) for one in answer.json()["errors"]]
    assert found == [
        (2, "feature 2", None, "/geometry/type"),
        (3, "feature 3", None, "/span/lenght_m"),
        (4, "feature 4", None, "/span/elements"),
        (6, "feature 5, span 2", None, "/geometry/coordinates"),
    ]
    assert answer.json()["lines"]["accepted"] == 3
    refused = post(client, {**SPANS, "features": [good, *bad]}, atomic="true")
    assert refused.status_code == 422
    assert refused.json()["errors"][0]["detail"].startswith("feature 2: must be LineString or Point, got 'Polygon'")


def test_a_computed_value_that_is_refused_names_its_origin(client: httpx.Client) -> None:
    steep = {"type": "LineString", "coordinates": [[14.0, 50.0, 0.0], [14.0, 50.0001, 8000.0]]}
    answer = post(client, {**SPANS, "features": [{**SPANS["features"][0], "geometry": steep}]})
    assert answer.status_code == 422
    (error,) = (one for one in answer.json()["errors"] if one["pointer"] == "/lines/0/span/level_difference_m")
    assert error["detail"].endswith("(difference of the heights of its coordinates)")


def test_analysis_and_defaults_stand_in_the_address_or_in_the_body_once(client: httpx.Client) -> None:
    bare = {"type": "FeatureCollection", "features": SPANS["features"][:1]}
    said = {"analysis": json.dumps(SHORT), "defaults": json.dumps(SPANS["defaults"])}
    assert post(client, bare, **said).status_code == 202
    twice = post(client, SPANS, **said)
    assert [error["pointer"] for error in twice.json()["errors"]] == ["/analysis", "/defaults"]
    missing = post(client, bare)
    assert missing.status_code == 422
    assert {"/lines/0/conductor", "/lines/0/ice"} <= {error["pointer"] for error in missing.json()["errors"]}
    wrong = post(client, bare, defaults='{"spam": 1}')
    assert [error["pointer"] for error in wrong.json()["errors"]] == ["/defaults/spam"]
    assert post(client, SPANS, defaults="{").status_code == 400


@pytest.mark.parametrize("media_type", ["application/json", "application/x-ndjson", "text/csv"])
def test_every_body_may_leave_fields_to_defaults(client: httpx.Client, media_type: str) -> None:
    line = {"reference": "a", "span": {"length_m": 300.0}}
    parts = {"analysis": SHORT, "defaults": {name: SPANS["defaults"][name] for name in ("conductor", "ice")}}
    if media_type == "text/csv":
        query = {name: json.dumps(part) for name, part in parts.items()}
        answer = post(client, b"reference,span.length_m\na,300\n", media_type, **query)
    elif media_type == "application/json":
        answer = post(client, {**parts, "lines": [line]}, media_type)
    else:
        answer = post(client, f"{json.dumps(parts)}\n{json.dumps(line)}\n".encode(), media_type)
    assert (answer.status_code, answer.json()["lines"]["accepted"]) == (202, 1), answer.text
    assert post(client, {"lines": [line]}, "application/json", defaults="{}").status_code == 400


def test_too_many_features_are_refused(tmp_path: Path) -> None:
    one = b'{"type":"Feature","geometry":null,"properties":{}},'
    with service.running(service.sqlite_settings(tmp_path, max_batch_lines=100)) as client:
        answer = post(client, b'{"type": "FeatureCollection", "features": [' + one * 600 + b"]}")
    assert (answer.status_code, "at most 100 lines" in answer.text) == (422, True)


def test_segments_of_cim_run_under_defaults(client: httpx.Client, settings: Settings) -> None:
    said = {"analysis": json.dumps(SHORT), "defaults": json.dumps(ICED)}
    answer = post(client, (EXAMPLES / "segments.xml").read_bytes(), RDF_XML, atomic="true", **said)
    assert answer.status_code == 202, answer.text
    assert answer.json()["notes"] == ["Conductor.length was read in metres, as CIM declares it."]
    work_off(client, settings, answer.headers["location"])
    found = features(client, answer.headers["location"])
    assert [one["properties"]["reference"] for one in found] == [
        "7a0e3c52-9a55-4b6b-8d0f-0c6f5d1c0017",
        "_segment-18/1",
        "_segment-18/2",
    ]
    assert [one["geometry"] is None for one in found] == [True, False, False]
    assert {one["properties"]["gallops"] for one in found} == {"yes"}
    assert {one["properties"]["clearance_m"] is None for one in found} == {False}


def test_what_cim_does_not_have_is_told_of_by_segment_and_attribute(client: httpx.Client) -> None:
    body = (EXAMPLES / "segments.xml").read_bytes().replace(b">305.5<", b">30550<")
    answer = post(client, body, RDF_XML)
    assert answer.status_code == 422
    details = {error["pointer"]: error["detail"] for error in answer.json()["errors"]}
    assert details["/lines/0/ice"].startswith("ACLineSegment _segment-17: ")
    assert details["/lines/0/ice"].endswith("(CIM has no ice)")
    assert "from Conductor.length; positions of the towers divide" in details["/lines/0/span/length_m"]
    hostile = b'<!DOCTYPE r [<!ENTITY a "x">]>' + body.partition(b"?>")[2]
    refused = post(client, hostile, RDF_XML)
    assert (refused.status_code, refused.json()["errors"][0]["code"]) == (422, "xml_refused")
    mixed = post(client, body, RDF_XML, defaults=json.dumps(ICED), analysis=json.dumps(SHORT))
    assert (mixed.status_code, mixed.json()["lines"]["accepted"]) == (202, 2)
    (error,) = mixed.json()["errors"]
    assert (error["place"], error["pointer"]) == ("ACLineSegment _segment-17", "/span/length_m")


def test_a_batch_may_be_checked_without_storing_it(client: httpx.Client) -> None:
    good, *_ = SPANS["features"]
    bad = {**good, "geometry": {"type": "Polygon"}}
    answer = post(client, {**SPANS, "features": [good, bad]}, validate_only="true")
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["total"], found["rejected"], found["notes"]) == (2, 1, [])
    assert [(error["place"], error["pointer"]) for error in found["errors"]] == [("feature 2", "/geometry/type")]
    assert post(client, {**SPANS, "features": [bad]}, validate_only="true").status_code == 422
    assert client.get("/v1/batches").json()["batches"] == []
