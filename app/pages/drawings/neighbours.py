"""The spans on both sides of a line's span from the side: those of its section, or the next ones, which are at rest."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from math import cosh
from typing import Any

from markupsafe import Markup

from app.pages.drawings.svg import Point, element, path, picture
from app.pages.measures import Units
from app.pages.wording import words

SIZE = (560.0, 150.0)
_SIDE, _TOP, _BOTTOM = 12.0, 26.0, 30.0
_POINTS = 25
_ROOM_FOR_LENGTH = 46.0
_ROOM_FOR_NUMBER = 16.0
_LEAST_HEIGHT_M = 1.0


@dataclass(frozen=True, slots=True)
class DrawnSpan:
    """A span: length, height of its right end above the left one [m], and whether it is the line's own or moves."""

    length: float
    rise: float
    own: bool
    moves: bool


@dataclass(frozen=True, slots=True)
class _Run:
    """Spans in a row, with the strings at all supports [m] (0 for none), and their place on the drawing."""

    spans: Sequence[DrawnSpan]
    strings: Sequence[float]
    parameter: float
    along: float
    per_metre: float
    top: float

    @property
    def feet(self) -> list[Point]:
        """Return the ends of the spans (along the line, up) [m]."""
        lengths = accumulate((span.length for span in self.spans), initial=0.0)
        return list(zip(lengths, accumulate((span.rise for span in self.spans), initial=0.0), strict=True))

    def place(self, point: Point) -> Point:
        """Return where a point [m] lies on the drawing."""
        return _SIDE + self.along * point[0], _TOP + self.per_metre * (self.top - point[1])


def neighbours(line: Mapping[str, Any], parameter: float, units: Units) -> Markup | None:
    """Return the drawing of an explicit line with this catenary parameter [m], None where it has no neighbours.

    Every span has the horizontal tension of the line's own, and strings hang straight down.
    """
    spans, strings = _of_section(line) if line.get("section") else _next_ones(line)
    if len(spans) < 2:
        return None
    run = _fitted(spans, strings, parameter)
    said = words().drawings
    parts = [part for number in range(len(spans)) for part in _span(run, number, units)]
    parts += [part for number in range(len(strings)) for part in _support(run, number)]
    note = said.exaggerated.format(factor=f"{run.per_metre / run.along:.2g}")
    parts.append(element("text", note, x=SIZE[0] - 4.0, y=14.0, class_="note"))
    return picture(SIZE, said.neighbours.format(count=len(spans)), parts, "drawing neighbours")


def _of_section(line: Mapping[str, Any]) -> tuple[list[DrawnSpan], list[float]]:
    section = line["section"]
    own = int(section.get("span_of_interest") or 1) - 1
    spans = [
        DrawnSpan(float(span["length_m"]), float(span.get("level_difference_m") or 0.0), number == own, moves=True)
        for number, span in enumerate(section["spans"])
    ]
    return spans, [0.0, *(float(string["length_m"]) for string in section["strings"]), 0.0]


def _next_ones(line: Mapping[str, Any]) -> tuple[list[DrawnSpan], list[float]]:
    span = line["span"]
    own = DrawnSpan(float(span["length_m"]), float(span.get("level_difference_m") or 0.0), own=True, moves=True)
    spans, strings = [own], []
    for name, first in (("left", True), ("right", False)):
        end = (line.get("supports") or {}).get(name) or {}
        strings.append(float(end.get("insulator_length_m") or 0.0))
        if end.get("adjacent_span_m") and not end.get("dead_end"):
            next_one = DrawnSpan(float(end["adjacent_span_m"]), 0.0, own=False, moves=False)
            spans = [next_one, *spans] if first else [*spans, next_one]
            strings = [0.0, *strings] if first else [*strings, 0.0]
    return spans, strings


def _fitted(spans: Sequence[DrawnSpan], strings: Sequence[float], parameter: float) -> _Run:
    """Return the run at the largest scales at which it fits, which differ along the line and upward."""
    plain = _Run(spans, strings, parameter, 1.0, 1.0, 0.0)
    heights = [y for number in range(len(spans)) for _, y in _curve(plain, number)]
    heights += [foot[1] + string for foot, string in zip(plain.feet, strings, strict=True)]
    room = SIZE[1] - _TOP - _BOTTOM
    per_metre = room / max(max(heights) - min(heights), _LEAST_HEIGHT_M)
    along = (SIZE[0] - 2.0 * _SIDE) / sum(span.length for span in spans)
    return _Run(spans, strings, parameter, along, per_metre, max(heights))


def _curve(run: _Run, number: int) -> list[Point]:
    """Return the curve of a span: a parabola whose sag below the chord is that of a level catenary of its length."""
    span, (left, foot) = run.spans[number], run.feet[number]
    sag = run.parameter * (cosh(0.5 * span.length / run.parameter) - 1.0)
    shares = [point / (_POINTS - 1) for point in range(_POINTS)]
    return [(left + span.length * t, foot + span.rise * t - 4.0 * sag * t * (1.0 - t)) for t in shares]


def _span(run: _Run, number: int, units: Units) -> Iterator[Markup]:
    span = run.spans[number]
    kind = "moving-side" if span.own else "neighbour" if span.moves else "still"
    yield element("path", d=path([run.place(point) for point in _curve(run, number)]), class_=kind)
    left, _ = run.place(run.feet[number])
    wide = run.along * span.length
    length = units.shown(span.length, "m")
    text = length if wide >= _ROOM_FOR_LENGTH else str(number + 1) if wide >= _ROOM_FOR_NUMBER else ""
    if text:
        kind = "mid" if span.own else "figures mid"
        yield element("text", text, x=left + 0.5 * wide, y=SIZE[1] - 4.0, class_=kind)


def _support(run: _Run, number: int) -> Iterator[Markup]:
    """Yield a support from the ground up, with the string that hangs from it, if any."""
    foot, string = run.feet[number], run.strings[number]
    x, y = run.place(foot)
    _, top = run.place((foot[0], foot[1] + string))
    yield element("path", d=path([(x, y if not string else top), (x, SIZE[1] - 18.0)]), class_="support faint")
    if string:
        yield element("path", d=path([(x - 4.0, top), (x + 4.0, top)]), class_="support")
        yield element("path", d=path([(x, top), (x, y)]), class_="string")
