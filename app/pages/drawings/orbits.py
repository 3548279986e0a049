"""The cross-section of a bundle in motion: orbits, the design ellipse, and the other phases, all to one scale."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any

from markupsafe import Markup

from app.pages.drawings.bundles import positions
from app.pages.drawings.scales import Scale, fitting, ticks
from app.pages.drawings.svg import Point, element, path, picture
from app.pages.measures import Units
from app.pages.motions import Motion
from app.pages.wording import words

SIZE = (420.0, 420.0)
_MARGIN = 34.0
_CORNERS = 72
_LEAST_WIRE = 3.0
_BELOW_NOTES = 48.0  # the words at the top, and the arrow of the wind, end here; a grid line there has no figure


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What surrounds a motion: the line's document, and the design ellipse (major, minor, B) [m] where there is one."""

    line: Mapping[str, Any]
    ellipse: tuple[float, float, float] | None

    @property
    def phases(self) -> list[tuple[str, Point, float | None]]:
        """Return the other phases: name, place (downwind, up) and required clearance [m]."""
        needed = self.line.get("required_clearance_m")
        return [
            (phase["name"], (phase["z_m"], phase["y_m"]), phase.get("required_clearance_m") or needed)
            for phase in self.line.get("phases") or ()
        ]


def wires(motion: Motion, places: Sequence[Point]) -> list[list[Point]]:
    """Return the paths of all sub-conductors (downwind, up) [m]: V - z Theta and W + y Theta from their places."""
    course = list(zip(motion.vertical, motion.horizontal, motion.torsional, strict=True))
    return [[(z + w + y * turn, y + v - z * turn) for v, w, turn in course] for z, y in places]


def ellipse_points(ellipse: tuple[float, float, float]) -> list[Point]:
    """Return the outline of a design ellipse, whose foot lies B below the resting wire (downwind, up) [m]."""
    major, minor, below = ellipse
    centre = 0.5 * major - below
    angles = [2.0 * pi * number / _CORNERS for number in range(_CORNERS)]
    return [(0.5 * minor * sin(angle), centre + 0.5 * major * cos(angle)) for angle in angles]


def orbit_scale(motion: Motion, around: Surroundings) -> Scale:
    """Return the scale that shows the motion and all that surrounds it."""
    places = positions(around.line.get("bundle", {}))
    points = [point for wire in wires(motion, places) for point in wire] + places
    points += ellipse_points(around.ellipse) if around.ellipse else []
    for _, (across, up), needed in around.phases:
        reach = needed or 0.0
        points += [(across - reach, up - reach), (across + reach, up + reach)]
    return fitting(points, SIZE, _MARGIN, least=0.05)


def orbit_picture(motion: Motion, around: Surroundings, units: Units, title: str) -> Markup:
    """Return the drawing; what moves is in a group of the class `moving`, for the script that moves it."""
    scale = orbit_scale(motion, around)
    places = positions(around.line.get("bundle", {}))
    parts = [*_grid(scale, units)]
    if around.ellipse:
        outline = [scale.place(point) for point in ellipse_points(around.ellipse)]
        parts.append(element("path", d=path(outline, closed=True), class_="ellipse"))
    parts += _phases(scale, around)
    parts += _paths(scale, wires(motion, places))
    parts += [element("circle", cx=x, cy=y, r=1.6, class_="rest") for x, y in map(scale.place, places)]
    radius = max(_LEAST_WIRE, 0.5 * scale.per_metre * _diameter(around.line))
    moving = [element("circle", cx=x, cy=y, r=radius, class_="wire") for x, y in map(scale.place, places)]
    x, y = scale.place((0.0, 0.0))
    parts.append(element("g", *moving, class_="moving", data_x=round(x, 3), data_y=round(y, 3)))
    parts += _wind()
    return picture(SIZE, title, parts, "drawing orbit")


def _paths(scale: Scale, paths: Iterable[Sequence[Point]]) -> Iterator[Markup]:
    for points in paths:
        yield element("path", d=path([scale.place(point) for point in points], closed=True), class_="path")


def _phases(scale: Scale, around: Surroundings) -> Iterator[Markup]:
    for name, place, needed in around.phases:
        x, y = scale.place(place)
        if needed:
            yield element("circle", cx=x, cy=y, r=scale.per_metre * needed, class_="clear")
        yield element("circle", cx=x, cy=y, r=4.0, class_="phase")
        yield element("text", name, x=x + 7.0, y=y + 4.0)


def _grid(scale: Scale, units: Units) -> Iterator[Markup]:
    """Yield lines at round distances from the resting bundle, with their figures in the units of the reader."""
    unit = units.unit("m")
    half = [0.5 * size / scale.per_metre for size in SIZE]
    for axis in range(2):
        low, high = scale.middle[axis] - half[axis], scale.middle[axis] + half[axis]
        for tick in ticks(low * unit.factor, high * unit.factor, 8):
            x, y = scale.place((tick / unit.factor, tick / unit.factor))
            text = f"{tick:.4g}"
            if axis == 0:
                yield element("line", x1=x, x2=x, y1=0.0, y2=SIZE[1], class_="grid")
                yield element("text", text, x=x + 2.0, y=SIZE[1] - 3.0, class_="figures")
            elif y < SIZE[1] - 16.0:
                yield element("line", x1=0.0, x2=SIZE[0], y1=y, y2=y, class_="grid")
                if y > _BELOW_NOTES:
                    yield element("text", text, x=2.0, y=y - 2.0, class_="figures")
    said = words().drawings
    yield element("text", said.axes.format(unit=unit.name), x=SIZE[0] - 4.0, y=14.0, class_="note")


def _wind() -> Iterator[Markup]:
    yield element("path", d="M8 26H44M36 20L44 26L36 32", class_="arrow")
    yield element("text", words().drawings.wind, x=8.0, y=16.0)


def _diameter(line: Mapping[str, Any]) -> float:
    return float((line.get("conductor") or {}).get("diameter_m") or 0.0)
