"""Read the features of GeoJSON (RFC 7946) as lines: a LineString is a span, or one for each of its segments."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from app.exchange.coordinates import is_wgs84, kept_geometry, read_geometry
from app.exchange.feature_texts import FeatureTexts, cut_features
from app.exchange.spans import SpanNotes, lines_along
from app.schemas.faults import BadInput, Fault, json_pointer, parse_json
from app.sheets.columns import Columns, PlacedLine
from app.sheets.delimited import SheetRow

_BATCH = ("analysis", "defaults", "webhook_url")
_HUGE = 10**18


@dataclass(frozen=True, slots=True)
class FeatureLines:
    """The members of a batch that stand beside the features, the lines, and notes."""

    members: Mapping[str, Any]
    lines: Iterator[PlacedLine]
    notes: SpanNotes


def read_features(pieces: Iterable[bytes], most_bytes: int) -> FeatureLines:
    """Read a FeatureCollection, or a single Feature, feature by feature.

    Analysis, defaults and webhook_url may stand in front of the features, as foreign members.

    Parameters
    ----------
    pieces : iterable of bytes
        The text in UTF-8, without a byte order mark.
    most_bytes : int
        Longest feature.

    Raises
    ------
    BadInput
        If it is no GeoJSON, or has another reference system; also while the lines are read.
    BodyTooLarge
        If a feature is too long; also while the lines are read.
    """
    cut = cut_features(pieces, most_bytes)
    head = _parsed(cut.members)
    notes = SpanNotes()
    if cut.whole:
        if head.get("type") != "Feature":
            detail = "must be a FeatureCollection with a list of features, or a Feature"
            raise BadInput([Fault("/type", "not_geojson", detail)])
        _check(head)
        feature = {name: value for name, value in head.items() if name not in _BATCH}
        return FeatureLines(head, _lines(1, feature, notes), notes)
    _check(head)
    return FeatureLines(head, _all_lines(cut, notes), notes)


def _all_lines(cut: FeatureTexts, notes: SpanNotes) -> Iterator[PlacedLine]:
    before = set(cut.members)
    for number, text in enumerate(cut.texts, 1):
        try:
            feature = parse_json(text)
        except BadInput as error:
            yield PlacedLine(f"feature {number}", error)
        else:
            yield from _lines(number, feature, notes)
    late = [name for name in _BATCH if name in cut.members and name not in before]
    if late:
        raise BadInput([Fault(f"/{name}", "too_late", "must stand before the features") for name in late])
    whole = _parsed(cut.members)
    if whole.get("type") != "FeatureCollection":
        raise BadInput([Fault("/type", "not_geojson", "must be FeatureCollection, where there are features")])
    _check(whole)


def _parsed(members: Mapping[str, bytes]) -> dict[str, Any]:
    return {name: parse_json(text) for name, text in members.items()}


def _check(members: Mapping[str, Any]) -> None:
    """Refuse another reference system than WGS 84, as older GeoJSON may name it."""
    crs = members.get("crs")
    if crs is None:
        return
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = str(properties.get("name") if isinstance(properties, dict) else crs)
    if not is_wgs84(name):
        detail = f"must be WGS 84 (EPSG:4326 or CRS84), got {name[:80]!r}; convert the coordinates"
        raise BadInput([Fault("/crs", "crs", detail)])


def _lines(number: int, feature: object, notes: SpanNotes) -> Iterator[PlacedLine]:
    place = f"feature {number}"
    if not isinstance(feature, dict) or feature.get("type") != "Feature":
        yield PlacedLine(place, BadInput([Fault("/type", "not_geojson", "must be an object of the type Feature")]))
        return
    line = _of_properties(place, feature)
    course, faults = read_geometry(feature.get("geometry"))
    if not isinstance(line.document, dict) or faults:
        yield PlacedLine(place, line.document, (*line.faults, *faults))
    else:
        yield from lines_along(line, course, kept_geometry(feature.get("geometry")), notes)


def _of_properties(place: str, feature: Mapping[str, Any]) -> PlacedLine:
    """Return the line that the properties of a feature say; its id is the reference if they name none."""
    properties = feature.get("properties")
    if properties is None:
        properties = {}
    if not isinstance(properties, dict):
        return PlacedLine(place, BadInput([Fault("/properties", "not_an_object", "must be an object or null")]))
    names = tuple(properties)
    try:
        columns = _columns(names) if names else None
    except BadInput as error:
        return PlacedLine(place, BadInput([_of_property(names, fault) for fault in error.faults]))
    line = columns.line(SheetRow(0, tuple(properties.values()), comma=True)) if columns else PlacedLine("", {})
    document, identity = line.document, feature.get("id")
    is_name = isinstance(identity, str) or (isinstance(identity, int) and abs(identity) < _HUGE)
    if isinstance(document, dict) and document.get("reference") is None and is_name:
        document = {**document, "reference": str(identity)}
    return PlacedLine(place, document, line.faults)


@lru_cache(maxsize=16)
def _columns(names: tuple[str, ...]) -> Columns:
    return Columns.of(names)


def _of_property(names: Sequence[str], fault: Fault) -> Fault:
    """Return a fault of the names as a fault of the property; there it is called a column."""
    number = fault.pointer.removeprefix("/header").removeprefix("/")
    pointer = json_pointer(["properties", names[int(number)]]) if number else "/properties"
    return Fault(pointer, "property_name", fault.detail.replace("column", "property", 1).replace("the header", "it", 1))
