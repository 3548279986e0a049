"""Read coordinates, and compute what they say of a line: lengths, directions and differences of height.

Lengths and directions are geodesics of the ellipsoid of WGS 84 by the algorithms of C. F. F. Karney, J. Geodesy 87
(2013), 43-55, in the library geographiclib: a sphere is up to 0.5 % wrong, 1.5 m in a span of 300 m.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from geographiclib.geodesic import Geodesic

from app.schemas.faults import Fault, json_pointer
from app.schemas.fields import LENGTH_LIMIT_M
from app.sheets.columns import Computed

_WITHIN = (("longitude", -180.0, 180.0), ("latitude", -90.0, 90.0), ("height", -1000.0, 9000.0))
_KINDS = ("Point", "LineString")
_WGS84 = frozenset({"CRS84", "CRS84H", "4326", "4979"})
_SHOWN = 60
_HUGE = 1e18

LENGTH = ("span", "length_m")
_SOURCE = "of its coordinates, geodesic on the ellipsoid of WGS 84"

Position = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Course:
    """Positions along a line: longitude and latitude [deg], and all or none with a height [m]; one is a point."""

    positions: tuple[Position, ...]

    def length(self) -> float:
        """Return the length of all spans together [m]."""
        return sum(distance(*ends)[0] for ends in self.spans())

    def spans(self) -> Iterator[tuple[Position, Position]]:
        """Yield the two ends of each span."""
        yield from zip(self.positions, self.positions[1:], strict=False)


def distance(start: Position, end: Position) -> tuple[float, float]:
    """Return the length of the geodesic [m] and its azimuth at the start [deg], clockwise from north, 0 to 360."""
    found = Geodesic.WGS84.Inverse(start[1], start[0], end[1], end[0], Geodesic.DISTANCE | Geodesic.AZIMUTH)
    return float(found["s12"]), float(found["azi1"]) % 360.0


def is_wgs84(name: str) -> bool:
    """Tell whether a name of a reference system, such as `urn:ogc:def:crs:EPSG::4326`, is that of WGS 84."""
    return name.upper().rpartition(":")[2] in _WGS84


def computed_of(start: Position, end: Position) -> tuple[Computed, ...]:
    """Return length, direction and, if there are heights, level difference of a span."""
    length, azimuth = distance(start, end)
    values = [
        Computed(LENGTH, length, "m", f"distance {_SOURCE}"),
        Computed(("climate", "line_azimuth_deg"), azimuth, "deg", f"azimuth at the first {_SOURCE}"),
    ]
    if len(start) > 2:
        source = "difference of the heights of its coordinates"
        values.append(Computed(("span", "level_difference_m"), end[2] - start[2], "m", source))
    return tuple(values)


def length_fault(pointer: str, start: Position, end: Position) -> Fault | None:
    """Return a fault if two positions are no span apart."""
    length, _ = distance(start, end)
    if 1.0 <= length <= LENGTH_LIMIT_M:
        return None
    detail = f"the two points are {length:.4g} m apart; a span is 1 to {LENGTH_LIMIT_M:g} m long"
    return Fault(pointer, "no_span", detail)


def read_geometry(geometry: object) -> tuple[Course | None, list[Fault]]:
    """Read a geometry of GeoJSON (RFC 7946): a point, a line, several lines of which there is one, or null.

    Returns
    -------
    course : Course or None
        None for null, or if there are faults.
    faults : list of Fault
        Pointers from the root of the feature.
    """
    if geometry is None:
        return None, []
    if not isinstance(geometry, dict):
        return None, [Fault("/geometry", "not_an_object", "must be an object or null")]
    kind, given, path = geometry.get("type"), geometry.get("coordinates"), ["geometry", "coordinates"]
    if kind == "MultiLineString" and isinstance(given, list) and len(given) == 1:  # as many programs write one line
        kind, given, path = "LineString", given[0], [*path, "0"]
    if kind not in _KINDS:
        return None, [Fault("/geometry/type", "geometry", _unsupported(kind))]
    positions = [given] if kind == "Point" else given
    if not isinstance(positions, list) or (kind == "LineString" and len(positions) < 2):
        return None, [Fault(json_pointer(path), "geometry", "must be a list of two or more positions")]
    places = [path] if kind == "Point" else [[*path, str(i)] for i in range(len(positions))]
    faults = [fault for place, each in zip(places, positions, strict=True) for fault in position_faults(place, each)]
    if not faults and len({len(position) for position in positions}) > 1:
        faults = [Fault(json_pointer(path), "geometry", "must have heights at all positions or at none")]
    if faults:
        return None, faults
    return Course(tuple(tuple(map(float, position)) for position in positions)), []


def position_faults(path: Sequence[object], position: object) -> Iterator[Fault]:
    """Yield the faults of one position: two or three finite numbers within the globe."""
    if not isinstance(position, list) or len(position) not in {2, 3}:
        detail = "must be longitude and latitude, optionally with a height"
        yield Fault(json_pointer(path), "position", detail)
        return
    for i, (value, (name, least, most)) in enumerate(zip(position, _WITHIN, strict=False)):
        if isinstance(value, bool) or not isinstance(value, int | float) or value != value:  # noqa: PLR0124 - NaN
            detail = f"{name} must be a number, got {str(value)[:_SHOWN]}"
        elif least <= value <= most:
            continue
        else:
            slip = "" if name == "height" else "; convert coordinates of a map projection to WGS 84"
            got = f"{value:.10g}" if abs(value) < _HUGE else "a huge one"
            detail = f"{name} must lie between {least:g} and {most:g}, got {got}{slip}"
        yield Fault(json_pointer([*path, i]), "position", detail)


def kept_geometry(geometry: Any) -> Mapping[str, Any] | None:
    """Return a geometry that `read_geometry` accepted as it came, without foreign members."""
    return None if geometry is None else {name: geometry[name] for name in ("type", "coordinates")}


def as_geometry(start: Position, end: Position) -> Mapping[str, Any]:
    """Return two positions as a line of GeoJSON."""
    return {"type": "LineString", "coordinates": [list(start), list(end)]}


def _unsupported(kind: object) -> str:
    if kind == "MultiLineString":
        return "a MultiLineString must have exactly one line; split it, so that each line is a feature"
    return f"must be LineString or Point, got {str(kind)[:_SHOWN]!r}"
