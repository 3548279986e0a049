"""A span from the side, and from above where it moves: its curve at rest, supports, devices, and both scales."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from app.pages.drawings.device_marks import legend, marks
from app.pages.drawings.scales import ticks
from app.pages.drawings.svg import Point, element, path, picture
from app.pages.measures import Units
from app.pages.wording import words

WIDTH = 560.0
HEIGHT = 190.0
_SIDE, _TOP, _BOTTOM = 26.0, 26.0, 36.0
_PLAN = 90.0  # height of the view from above
_POINTS = 81


@dataclass(frozen=True, slots=True)
class SpanDrawing:
    """The drawing of a span, what a script needs to move it in units of the drawing, and its legend."""

    picture: Markup
    across: Sequence[float]
    rest: Sequence[float]
    per_metre: float
    plan: float
    exaggeration: float
    legend: Sequence[tuple[Markup, str]] = ()


def positions_along(length: float) -> list[float]:
    """Return evenly spaced positions from the left support [m]."""
    return [length * number / (_POINTS - 1) for number in range(_POINTS)]


def heights(length: float, sag: float, rise: float, positions: Sequence[float]) -> list[float]:
    """Return the height of the span over its left support [m]: a parabola of this sag below the chord."""
    return [rise * x / length - 4.0 * sag * x * (length - x) / length**2 for x in positions]


def span_drawing(line: Mapping[str, Any], sag: float, amplitude: float, units: Units) -> SpanDrawing:
    """Return a span with room for a motion of this amplitude [m]; amplitude 0 leaves out the view from above."""
    span = line["span"]
    length, rise = float(span["length_m"]), float(span.get("level_difference_m") or 0.0)
    positions = positions_along(length)
    found = heights(length, sag, rise, positions)
    low, high = min(found) - amplitude, max(found) + amplitude
    along = (WIDTH - 2.0 * _SIDE) / length
    per_metre = (HEIGHT - _TOP - _BOTTOM) / max(high - low, 1e-6)
    across = [_SIDE + along * x for x in positions]
    rest = [_TOP + per_metre * (high - y) for y in found]
    plan = HEIGHT + 0.5 * _PLAN
    tall = HEIGHT + (_PLAN if amplitude > 0.0 else 0.0)
    said = words().drawings
    exaggeration = per_metre / along
    parts = [*_frame(length, across, rest, units)]
    parts.append(element("path", d=path(list(zip(across, rest, strict=True))), class_="still"))
    parts.append(element("path", d=path(list(zip(across, rest, strict=True))), class_="moving-side"))
    parts += marks(line, _on_wire(across, rest, length))
    if amplitude > 0.0:
        parts.append(element("path", d=f"M{across[0]} {plan}H{across[-1]}", class_="still"))
        parts.append(element("path", d=f"M{across[0]} {plan}H{across[-1]}", class_="moving-plan"))
        parts.append(element("text", said.from_above, x=_SIDE, y=HEIGHT + 14.0))
    note = said.side.format(sag=units.shown(sag, "m"), factor=f"{exaggeration:.2g}")
    parts.append(element("text", note, x=WIDTH - 4.0, y=14.0, class_="note"))
    title = said.span.format(length=units.shown(length, "m"), sag=units.shown(sag, "m"))
    drawn = picture((WIDTH, tall), title, parts, "drawing span")
    return SpanDrawing(drawn, across, rest, per_metre, plan, exaggeration, legend(line))


def _frame(length: float, across: Sequence[float], rest: Sequence[float], units: Units) -> Iterator[Markup]:
    unit = units.unit("m")
    for tick in ticks(0.0, length * unit.factor, 6):
        x = across[0] + (across[-1] - across[0]) * tick / (length * unit.factor)
        yield element("line", x1=x, x2=x, y1=20.0, y2=HEIGHT - 14.0, class_="grid")
        last = x > WIDTH - 3.0 * _SIDE
        kind = "figures note" if last else "figures"
        yield element("text", f"{tick:.4g} {unit.name}", x=x + 2.0 * (1 - last), y=HEIGHT - 4.0, class_=kind)
    for x, y in ((across[0], rest[0]), (across[-1], rest[-1])):
        yield element("path", d=f"M{x} {y - 8.0}V{HEIGHT - 14.0}", class_="support")


def _on_wire(across: Sequence[float], rest: Sequence[float], length: float) -> Callable[[float], Point]:
    """Return the function that gives the point of the drawn wire at a position [m]."""

    def place(position: float) -> Point:
        whole = position / length * (_POINTS - 1)
        number = min(max(int(whole), 0), _POINTS - 2)
        part = whole - number
        x, y = ((1.0 - part) * values[number] + part * values[number + 1] for values in (across, rest))
        return x, y

    return place
