import json
from typing import Any

import pytest

from app.exchange.features import FeatureLines, read_features
from app.schemas.faults import BadInput
from app.sheets.columns import PlacedLine

SPAN = {"type": "LineString", "coordinates": [[14.0, 50.0], [14.0, 50.003]]}


def feature(properties: Any = None, geometry: Any = None, **others: Any) -> dict[str, Any]:
    return {"type": "Feature", "properties": properties, "geometry": geometry, **others}


def read(*features: Any, **members: Any) -> FeatureLines:
    body = json.dumps({"type": "FeatureCollection", **members, "features": features}).encode()
    return read_features([body], 10_000)


def lines(*features: Any, **members: Any) -> list[PlacedLine]:
    return list(read(*features, **members).lines)


def refused(body: dict[str, Any]) -> tuple[str, str]:
    with pytest.raises(BadInput) as caught:
        list(read_features([json.dumps(body).encode()], 10_000).lines)
    fault = caught.value.faults[0]
    return fault.pointer, fault.detail


def pointers(line: PlacedLine) -> list[str]:
    found = line.document.faults if isinstance(line.document, BadInput) else line.faults
    return [fault.pointer for fault in found]


def test_properties_are_columns_paths_or_objects() -> None:
    properties = {
        "name": 17,
        "span.elements": "12",
        "ice": {"aerodynamics": {"catalogue": "c11-40"}},
        "devices.0.type": "spacer",
        "bundle.spacing_m": "0,4",
        "tags": {"region": "north"},
        "design_wind_m_per_s": None,
    }
    (line,) = lines(feature(properties, id="a"))
    assert line.document == {
        "name": "17",
        "span": {"elements": 12},
        "ice": {"aerodynamics": {"catalogue": "c11-40"}},
        "devices": [{"type": "spacer"}],
        "bundle": {"spacing_m": 0.4},
        "tags": {"region": "north"},
        "reference": "a",
    }
    assert (line.place, line.geometry, line.computed) == ("feature 1", None, ())
    (named,) = lines(feature({"reference": "own"}, id=5))
    assert named.document == {"reference": "own"}


def test_two_positions_are_a_span_with_its_length() -> None:
    (line,) = lines(feature({"name": "x"}, SPAN | {"bbox": [1, 2]}))
    assert (line.document, line.geometry) == ({"name": "x"}, SPAN)
    assert {value.name: value.value for value in line.computed} == {
        "span.length_m": pytest.approx(333.687, abs=1e-3),
        "climate.line_azimuth_deg": 0.0,
    }


def test_each_segment_of_a_longer_line_is_a_span_of_its_own() -> None:
    course = {"type": "LineString", "coordinates": [[14.0, 50.0, 1.0], [14.0, 50.003, 3.0], [14.004, 50.003, 9.0]]}
    first, second = lines(feature({"name": "L"}, course, id="r"))
    assert (first.place, second.place) == ("feature 1, span 1", "feature 1, span 2")
    assert second.document == {"name": "L, span 2", "reference": "r/2"}
    assert second.geometry == {"type": "LineString", "coordinates": [[14.0, 50.003, 3.0], [14.004, 50.003, 9.0]]}
    found = {value.name: value.value for value in second.computed}
    assert found == {
        "span.length_m": pytest.approx(286.765, abs=1e-3),
        "climate.line_azimuth_deg": pytest.approx(90.0, abs=0.01),
        "span.level_difference_m": 6.0,
    }
    for line in lines(feature({"span.length_m": 600.0}, course)):
        assert pointers(line) == ["/span/length_m"] and "2 spans" in line.faults[0].detail


def test_a_given_length_wins_and_a_different_one_is_noted() -> None:
    found = read(
        *(feature({"span": {"length_m": length}}, SPAN) for length in (333.0, 300.0, 30.0)),
        feature({"span.length_m": 10**400}, SPAN),
    )
    assert [pointers(line) for line in found.lines] == [[], [], [], []]
    assert found.notes.sentences() == [
        "A given length differs from that of the coordinates by more than 5 %: feature 2, feature 3."
    ]


def test_a_bad_feature_is_told_of_in_its_place() -> None:
    found = lines(
        7,
        {"type": "Point", "coordinates": [0, 0]},
        feature([]),
        feature({"a": 1}, {"type": "Polygon", "coordinates": []}),
        feature({"span.length_m": 1.0, "span": {}}),
        feature({"span.length_m": "1.234,5"}),
        feature({}, {"type": "LineString", "coordinates": [[14.0, 50.0], [15.0, 50.0]]}),
        feature({"name": "good"}),
    )
    assert [pointers(line) for line in found] == [
        ["/type"],
        ["/type"],
        ["/properties"],
        ["/geometry/type"],
        ["/properties/span"],
        ["/span/length_m"],
        ["/geometry/coordinates"],
        [],
    ]
    body = b'{"type": "FeatureCollection", "features": [{"a": 1.2.3}, {"a": 1, "a": 2}, {"type": "Feature"}]}'
    assert [isinstance(line.document, BadInput) for line in read_features([body], 100).lines] == [True, True, False]


def test_a_feature_by_itself_is_a_line() -> None:
    found = read_features([json.dumps(feature({"name": "x"}, SPAN, analysis={"loops": [1]})).encode()], 1000)
    (line,) = found.lines
    assert (line.document, found.members["analysis"]) == ({"name": "x"}, {"loops": [1]})


def test_other_documents_and_reference_systems_are_refused() -> None:
    assert refused({"type": "Topology"}) == (
        "/type",
        "must be a FeatureCollection with a list of features, or a Feature",
    )
    assert refused({"type": "FeatureCollection"})[0] == "/type"
    assert refused({"features": []})[0] == "/type"
    assert refused({"type": "FeatureCollection", "features": [], "defaults": {}})[0] == "/defaults"
    projected = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::5514"}}
    for document in (
        {"type": "FeatureCollection", "crs": projected, "features": []},
        {"type": "FeatureCollection", "features": [], "crs": projected},
        {**feature({}), "crs": projected},
    ):
        pointer, detail = refused(document)
        assert pointer == "/crs" and "EPSG::5514" in detail


@pytest.mark.parametrize("name", ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4979"])
def test_the_reference_system_of_geojson_may_be_named(name: str) -> None:
    assert len(lines(feature({}), crs={"type": "name", "properties": {"name": name}})) == 1
