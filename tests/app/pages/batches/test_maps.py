import re
from typing import Any

from app.pages.batches.maps import batch_map, tracks
from app.pages.measures import SI


def feature(number: int, gallops: str | None, coordinates: list[Any], kind: str = "LineString") -> dict[str, Any]:
    line = {"number": number, "name": "<b>", "reference": None, "gallops": gallops}
    return {"geometry": {"type": kind, "coordinates": coordinates}, "properties": line}


def test_every_kind_of_geometry_has_courses() -> None:
    assert list(tracks(None)) == []
    assert list(tracks({"type": "Point", "coordinates": [10, 60, 5]})) == [[(10.0, 60.0)]]
    several = {"type": "MultiLineString", "coordinates": [[[1, 2], [3, 4]], [[5, 6], [7, 8]]]}
    assert list(tracks(several)) == [[(1.0, 2.0), (3.0, 4.0)], [(5.0, 6.0), (7.0, 8.0)]]
    assert len(list(tracks({"type": "GeometryCollection", "geometries": [several, several]}))) == 4


def test_the_map_is_to_scale_at_its_latitude() -> None:
    # At 60 degrees a degree of longitude is half as long as one of latitude.
    drawn = batch_map([feature(1, "yes", [[10, 60], [10.02, 60]]), feature(2, "no", [[10, 60], [10, 60.01]])], SI, str)
    first, second = (
        [[float(value) for value in point.split(" ")] for point in text.split("L")]
        for text in re.findall(r'd="M([\d. L]+)"', drawn)[:2]
    )
    across, up = abs(second[1][0] - second[0][0]), abs(first[1][1] - first[0][1])
    assert abs(across / up - 1.0) < 1e-3
    assert 'class="place yes"' in drawn
    assert "&lt;b&gt;: It does not gallop" in drawn


def test_lines_without_places_have_no_map() -> None:
    assert batch_map([{"geometry": None, "properties": {"number": 1}}], SI, str) == ""
    assert "<circle" in batch_map([feature(3, None, [10, 60], "Point")], SI, str)
