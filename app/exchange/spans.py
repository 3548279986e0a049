"""Make a line of each span between two positions, and say where lengths are not those of the coordinates."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from app.exchange.coordinates import Course, Position, as_geometry, computed_of, distance, length_fault
from app.schemas.faults import Fault
from app.sheets.columns import PlacedLine

_ALIKE = 0.05
_NAMED = 5
_HUGE = 10**18


@dataclass(slots=True)
class SpanNotes:
    """What the coordinates of a body show; complete when the last one is taken."""

    unlike: list[str] = field(default_factory=list)
    others: list[str] = field(default_factory=list)

    def compare(self, place: str, given: float, length: float) -> None:
        """Note a place whose given length [m] is not that of its coordinates."""
        if abs(length - given) > _ALIKE * length:
            self.unlike.append(place)

    def sentences(self) -> list[str]:
        """Return a sentence for everything that deserves a look."""
        if not self.unlike:
            return self.others
        more = f" and {len(self.unlike) - _NAMED} more" if len(self.unlike) > _NAMED else ""
        differs = "A given length differs from that of the coordinates by more than 5 %"
        return [*self.others, f"{differs}: {', '.join(self.unlike[:_NAMED])}{more}."]


def lines_along(line: PlacedLine, course: Course | None, geometry: Any, notes: SpanNotes) -> Iterator[PlacedLine]:
    """Yield a line for each span between two positions; without two positions, the line as it is.

    Parameters
    ----------
    line : PlacedLine
        Its document is an object.
    course : Course or None
        The positions.
    geometry : mapping or None
        The geometry as it came, which a single span or point keeps.
    notes : SpanNotes
        Takes what deserves a look.
    """
    ends = [] if course is None else list(course.spans())
    document: dict[str, Any] = dict(line.document)  # type: ignore[call-overload]
    given = _given_length(document)
    if not ends:
        yield replace(line, geometry=geometry)
    elif len(ends) == 1:
        if isinstance(given, int | float) and abs(given) < _HUGE:
            notes.compare(line.place, given, distance(*ends[0])[0])
        yield _between(line, *ends[0], geometry, needs_length=given is None)
    else:
        detail = f"must be absent, because the line has {len(ends)} spans, each of its own length"
        faults = () if given is None else (Fault("/span/length_m", "several_spans", detail),)
        for i, (start, end) in enumerate(ends, 1):
            named = replace(line, place=f"{line.place}, span {i}", document=_numbered(document, i))
            whole = replace(named, faults=(*line.faults, *faults))
            yield _between(whole, start, end, as_geometry(start, end), needs_length=given is None)


def _given_length(document: Mapping[str, Any]) -> object:
    span = document.get("span")
    return span.get("length_m") if isinstance(span, dict) else None


def _between(line: PlacedLine, start: Position, end: Position, geometry: Any, *, needs_length: bool) -> PlacedLine:
    """Return a line between two positions; if its length is not given, it is their distance."""
    fault = length_fault("/geometry/coordinates", start, end) if needs_length else None
    faults = (*line.faults, *([fault] if fault else ()))
    return replace(line, faults=faults, geometry=geometry, computed=computed_of(start, end))


def _numbered(document: Mapping[str, Any], number: int) -> dict[str, Any]:
    """Return a document with the number of a span in its labels."""
    named = dict(document)
    if isinstance(document.get("name"), str):
        named["name"] = f"{document['name']}, span {number}"
    if isinstance(document.get("reference"), str):
        named["reference"] = f"{document['reference']}/{number}"
    return named
