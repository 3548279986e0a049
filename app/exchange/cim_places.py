"""Where a line segment of CIM stands: the positions of its location, in WGS 84."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from app.exchange.coordinates import Course, is_wgs84, position_faults
from app.exchange.rdf import CimModel, CimObject, bare
from app.exchange.spans import SpanNotes

_POINT = ("sequenceNumber", "xPosition", "yPosition", "zPosition")


class Places:
    """Locations of a model, ready to be looked up."""

    WANTED: ClassVar[Mapping[str, frozenset[str]]] = {
        "Location": frozenset({"Location.PowerSystemResources", "Location.CoordinateSystem"}),
        "PositionPoint": frozenset({"PositionPoint.Location", *(f"PositionPoint.{name}" for name in _POINT)}),
        "CoordinateSystem": frozenset({"CoordinateSystem.crsUrn"}),
    }
    """The classes that are read here, and their attributes."""

    def __init__(self, model: CimModel, notes: SpanNotes) -> None:
        """Take a model, and notes for locations that cannot be read."""
        self._model = model
        self._notes = notes
        self._locations: dict[str, list[CimObject]] = defaultdict(list)
        self._points: dict[str, list[CimObject]] = defaultdict(list)
        for location in model.all_of(frozenset({"Location"})):
            for link in location.links.get("Location.PowerSystemResources", ()):
                self._locations[bare(link)].append(location)
        for point in model.all_of(frozenset({"PositionPoint"})):
            for link in point.links.get("PositionPoint.Location", ()):
                self._points[bare(link)].append(point)

    def of(self, segment: CimObject, assets: Sequence[CimObject]) -> tuple[Course | None, Mapping[str, Any] | None]:
        """Return the positions of a segment, or of an asset of it, and its geometry; None where none can be read."""
        links = [
            *segment.links.get("PowerSystemResource.Location", ()),
            *(link for asset in assets for link in asset.links.get("Asset.Location", ())),
        ]
        linked = (self._model.objects.get(bare(link)) for link in links)
        found = (*linked, *self._locations.get(bare(segment.identity), ()))
        location = next((each for each in found if each is not None and self._points.get(bare(each.identity))), None)
        if location is None or not self._is_readable(location):
            return None, None
        positions = self._positions(location)
        if positions is None:
            self._note(f"Positions of {location.identity[:80]} are no longitudes and latitudes, so they were not read.")
            return None, None
        kind, given = ("Point", positions[0]) if len(positions) == 1 else ("LineString", positions)
        return Course(tuple(map(tuple, positions))), {"type": kind, "coordinates": given}

    def _is_readable(self, location: CimObject) -> bool:
        systems = [self._model.objects.get(bare(link)) for link in location.links.get("Location.CoordinateSystem", ())]
        names = [system.texts.get("CoordinateSystem.crsUrn", "") for system in systems if system is not None]
        if names and is_wgs84(names[0]):
            return True
        named = f"in {names[0][:80]!r}" if names and names[0] else "without a CoordinateSystem"
        self._note(f"Locations {named} were not read; WGS 84 (EPSG::4326) is.")
        return False

    def _positions(self, location: CimObject) -> list[list[float]] | None:
        points = sorted(self._points[bare(location.identity)], key=_order)
        found = []
        for point in points:
            texts = [point.texts.get(f"PositionPoint.{name}") for name in _POINT[1:]]
            try:
                position = [float(text) for text in texts if text is not None]
            except ValueError:
                return None
            if None in texts[:2] or any(position_faults([], position)):
                return None
            found.append(position)
        return found if len({len(position) for position in found}) == 1 else [position[:2] for position in found]

    def _note(self, sentence: str) -> None:
        if sentence not in self._notes.others and len(self._notes.others) < 20:
            self._notes.others.append(sentence)


def _order(point: CimObject) -> float:
    try:
        return float(point.texts.get("PositionPoint.sequenceNumber", "0"))
    except ValueError:
        return 0.0
