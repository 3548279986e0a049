"""The cross-section of an iced bundle in the wind, to scale: conductors, the outline of their ice, the other phases."""

from collections.abc import Iterator, Mapping
from math import cos, pi, radians, sin
from typing import Any

from markupsafe import Markup

from app.pages.drawings.bundles import positions
from app.pages.drawings.scales import Scale, fitting, scale_bar
from app.pages.drawings.svg import Point, element, path, picture
from app.pages.measures import Units
from app.pages.wording import words

SIZE = (420.0, 260.0)
_MARGIN = 36.0
_CORNERS = 48
_WINDWARD_DEG = 270.0


def ice_outline(accretion: Mapping[str, Any] | None, radius: float, thickness: float) -> list[Point]:
    """Return the outline of the ice about the centre of a conductor (downwind, up) [m], as the engine takes it.

    Uniform ice is a ring, a crescent a circle that touches the conductor opposite to its thickest point, a D half a
    ring, a profile its own points. There is none without an accretion.
    """
    if not accretion:
        return []
    given = accretion.get("angle_deg")
    shape = accretion.get("shape")
    if shape == "profile":
        turn = radians(given or 0.0)
        points = accretion.get("points_m") or ()
        return [(y * sin(turn) + z * cos(turn), y * cos(turn) - z * sin(turn)) for y, z in points]
    direction = radians(_WINDWARD_DEG if given is None else given)
    towards = (sin(direction), cos(direction))
    if shape == "d_shape":
        angles = [direction - 0.5 * pi + pi * number / _CORNERS for number in range(_CORNERS + 1)]
        back = [direction + 0.5 * pi + pi * number / _CORNERS for number in range(_CORNERS + 1)]
        return [_at(radius + thickness, angle) for angle in angles] + [_at(radius, angle) for angle in back]
    off = 0.5 * thickness if shape == "crescent" else 0.0
    size = radius + thickness - off
    angles = [2.0 * pi * number / _CORNERS for number in range(_CORNERS)]
    return [(off * towards[0] + size * sin(angle), off * towards[1] + size * cos(angle)) for angle in angles]


def iced_bundle(
    explicit: Mapping[str, Any], accretion: Mapping[str, Any] | None, thickness: float, units: Units
) -> Markup:
    """Return the drawing of an explicit line, with the ice of this accretion and largest thickness [m]."""
    places = positions(explicit["bundle"])
    radius = 0.5 * float(explicit["conductor"]["diameter_m"])
    outline = ice_outline(accretion, radius, thickness)
    reach = radius + thickness
    corners = [(x + dx, y + dy) for x, y in places for dx in (-reach, reach) for dy in (-reach, reach)]
    scale = fitting(corners, SIZE, _MARGIN, least=6.0 * radius)
    unit = units.unit("mm")
    parts = [*scale_bar(scale, unit.name, 1e3 * unit.factor)]
    for x, y in places:
        if outline:
            parts.append(
                element("path", d=path([scale.place((x + a, y + b)) for a, b in outline], closed=True), class_="ice")
            )
        left, top = scale.place((x, y))
        parts.append(element("circle", cx=left, cy=top, r=scale.per_metre * radius, class_="wire"))
    parts += _mass_centres(explicit, places, scale)
    said = words().drawings
    parts.append(element("path", d="M8 26H44M36 20L44 26L36 32", class_="arrow"))
    parts.append(element("text", said.wind, x=8.0, y=16.0))
    return picture(SIZE, said.bundle.format(count=len(places)), parts, "drawing bundle")


def _mass_centres(explicit: Mapping[str, Any], places: list[Point], scale: Scale) -> Iterator[Markup]:
    ice = explicit.get("ice") or {}
    up, downwind = float(ice.get("eccentricity_y_m") or 0.0), float(ice.get("eccentricity_z_m") or 0.0)
    if up or downwind:
        name = element("title", words().drawings.mass_centre)
        for x, y in places:
            left, top = scale.place((x + downwind, y + up))
            yield element("circle", name, cx=left, cy=top, r=2.0, class_="mass")


def _at(distance: float, angle: float) -> Point:
    return distance * sin(angle), distance * cos(angle)
