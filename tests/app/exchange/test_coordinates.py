"""Geodesics against published values, and what is no position."""

import math
from typing import Any

import pytest

from app.exchange.coordinates import Position, computed_of, distance, length_fault, read_geometry


def radii(latitude: float) -> tuple[float, float]:
    """Return the radii of curvature of WGS 84 along the meridian and across it [m], from its two constants."""
    axis, flattening = 6378137.0, 1.0 / 298.257223563
    eccentricity = flattening * (2.0 - flattening)
    root = 1.0 - eccentricity * math.sin(math.radians(latitude)) ** 2
    return axis * (1.0 - eccentricity) / root**1.5, axis / math.sqrt(root)


def degrees(whole: int, minutes: int, seconds: float) -> float:
    return math.copysign(abs(whole) + minutes / 60.0 + seconds / 3600.0, whole)


FLINDERS_PEAK = (degrees(144, 25, 29.52440), degrees(-37, 57, 3.72030))
BUNINYONG = (degrees(143, 55, 35.38390), degrees(-37, 39, 10.15610))


@pytest.mark.parametrize(
    ("start", "end", "length", "azimuth", "close"),
    [
        # Geocentric Datum of Australia, technical manual: the test line of Vincenty's formulae, to 1 mm and 0.01".
        (FLINDERS_PEAK, BUNINYONG, 54972.271, degrees(306, 52, 5.37), (1e-3, 5e-6)),
        # Karney's documentation of geographiclib: Wellington to Salamanca, near the antipode.
        ((174.81, -41.32), (-5.50, 40.96), 19959679.267, 161.067669986, (1e-3, 1e-8)),
        # Karney (2010), the test set of geodesics, its line in the tests of GeographicLib.
        ((-139.44815, 35.60777), (-69.95921, -11.17491), 8935244.5604818, 111.098748429560, (1e-6, 1e-11)),
        # Half a degree of the equator and of nothing else: the radius of WGS 84 is 6,378,137 m.
        ((0.0, 0.0), (0.5, 0.0), 6378137.0 * math.radians(0.5), 90.0, (1e-6, 1e-9)),
        ((0.5, 0.0), (0.0, 0.0), 6378137.0 * math.radians(0.5), 270.0, (1e-6, 1e-9)),
    ],
)
def test_lengths_and_directions_are_the_published_ones(
    start: Position, end: Position, length: float, azimuth: float, close: tuple[float, float]
) -> None:
    found = distance(start, end)
    assert found[0] == pytest.approx(length, abs=close[0])
    assert found[1] == pytest.approx(azimuth, abs=close[1])


def test_a_span_is_not_that_of_a_sphere() -> None:
    """From south to north at the equator the earth is curved by 6,335 km, not by its mean radius of 6,371 km."""
    length, azimuth = distance((10.0, 0.0), (10.0, 0.0027))
    assert length == pytest.approx(math.radians(0.0027) * 6335439.327, abs=1e-4)
    assert azimuth == 0.0
    assert math.radians(0.0027) * 6371008.8 - length > 1.6


def test_a_span_says_length_direction_and_level_difference() -> None:
    found = {value.name: (value.value, value.unit) for value in computed_of((14.0, 50.0, 312.0), (14.0, 50.003, 320.5))}
    assert found == {
        "span.length_m": (pytest.approx(math.radians(0.003) * radii(50.0015)[0], abs=1e-4), "m"),
        "climate.line_azimuth_deg": (0.0, "deg"),
        "span.level_difference_m": (8.5, "m"),
    }
    east = computed_of((14.0, 50.0), (14.004, 50.0))[0].value
    assert east == pytest.approx(math.radians(0.004) * radii(50.0)[1] * math.cos(math.radians(50.0)), abs=1e-4)
    flat = [value.name for value in computed_of((14.0, 50.0), (14.0, 50.003))]
    assert flat == ["span.length_m", "climate.line_azimuth_deg"]


def test_positions_that_are_no_span_apart_are_told_of() -> None:
    assert length_fault("/x", (14.0, 50.0), (14.0, 50.003)) is None
    for end in ((14.0, 50.0), (15.0, 50.0)):
        fault = length_fault("/x", (14.0, 50.0), end)
        assert fault is not None and (fault.code, "1 to 5000 m" in fault.detail) == ("no_span", True)


@pytest.mark.parametrize(
    ("geometry", "pointer", "words"),
    [
        ([], "/geometry", "object or null"),
        ({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}, "/geometry/type", "'Polygon'"),
        ({"type": "GeometryCollection", "geometries": []}, "/geometry/type", "LineString or Point"),
        ({"type": "MultiLineString", "coordinates": [[[0, 0], [0, 1]], [[1, 1], [2, 2]]]}, "/geometry/type", "split"),
        ({"type": "LineString", "coordinates": [[0, 0]]}, "/geometry/coordinates", "two or more"),
        ({"type": "LineString", "coordinates": "x"}, "/geometry/coordinates", "two or more"),
        ({"type": "LineString", "coordinates": [[0, 0], [1]]}, "/geometry/coordinates/1", "longitude and latitude"),
        ({"type": "LineString", "coordinates": [[0, 0], [1, 2, 3, 4]]}, "/geometry/coordinates/1", "with a height"),
        ({"type": "LineString", "coordinates": [[0, 0], [1, math.nan]]}, "/geometry/coordinates/1/1", "got nan"),
        ({"type": "LineString", "coordinates": [[0, 0], [1, True]]}, "/geometry/coordinates/1/1", "got True"),
        ({"type": "LineString", "coordinates": [[0, 0], ["1", 2]]}, "/geometry/coordinates/1/0", "must be a number"),
        ({"type": "Point", "coordinates": [math.inf, 2]}, "/geometry/coordinates/0", "a huge one"),
        ({"type": "Point", "coordinates": [10**5000, 2]}, "/geometry/coordinates/0", "a huge one"),
        ({"type": "Point", "coordinates": [458000.5, 5548000.0]}, "/geometry/coordinates/0", "map projection"),
        ({"type": "LineString", "coordinates": [[0, 0, 1], [1, 2]]}, "/geometry/coordinates", "at all positions or"),
        ({"type": "MultiLineString", "coordinates": [[[0, 0], [0, 91]]]}, "/geometry/coordinates/0/1/1", "latitude"),
    ],
)
def test_other_geometries_are_refused_in_words(geometry: Any, pointer: str, words: str) -> None:
    course, faults = read_geometry(geometry)
    assert course is None
    assert faults[0].pointer == pointer
    assert words in faults[0].detail


def test_a_single_line_of_several_is_a_line() -> None:
    several = {"type": "MultiLineString", "coordinates": [[[14, 50], [14, 51], [15, 51]]]}
    course, faults = read_geometry(several)
    assert course is not None and not faults
    assert list(course.spans()) == [((14.0, 50.0), (14.0, 51.0)), ((14.0, 51.0), (15.0, 51.0))]
