"""Cross-sections of bundles: where the sub-conductors are."""

import math
from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from app.pages.drawings.svg import Point, element, picture
from app.pages.wording import words

_ICON = 100.0


def positions(bundle: Mapping[str, Any]) -> list[Point]:
    """Return the sub-conductors of a bundle in either form, as (downwind, up) about its centre [m]."""
    if bundle.get("positions_m"):
        return [(z, y) for y, z in bundle["positions_m"]]
    count = int(bundle.get("subconductors") or 1)
    if count == 1:
        return [(0.0, 0.0)]
    first = _first_angle_deg(bundle, count)
    radius = _radius(bundle, count)
    angles = [math.radians(first + 360.0 * number / count) for number in range(count)]
    return [(radius * math.sin(angle), radius * math.cos(angle)) for angle in angles]


def icon(line: Mapping[str, Any]) -> Markup:
    """Return a small picture of the bundle of a line, with its conductors drawn larger than they are."""
    places = positions(line.get("bundle", {}))
    reach = max(max(abs(x), abs(y)) for x, y in places) or 1.0
    scale, size = 0.3 * _ICON / reach, 0.1 * _ICON
    parts = [element("circle", cx=x, cy=y, r=size, class_="ice") for x, y in _placed(places, scale, -0.02)]
    parts += [element("circle", cx=x, cy=y, r=0.7 * size, class_="wire") for x, y in _placed(places, scale, 0.0)]
    name = words().drawings.bundle.format(count=len(places))
    return picture((_ICON, _ICON), name, parts, "drawing icon")


def _placed(places: list[Point], scale: float, shift: float) -> list[Point]:
    return [((0.5 + shift) * _ICON + scale * x, 0.5 * _ICON - scale * y) for x, y in places]


def _first_angle_deg(bundle: Mapping[str, Any], count: int) -> float:
    """Return the angle of the first sub-conductor, clockwise from straight up [deg]."""
    if bundle.get("orientation_deg") is not None:
        return float(bundle["orientation_deg"])
    level = {2: 90.0, 3: 180.0, 4: 45.0}.get(count, 0.0)  # spacers lie level; a triple stands on its point
    return {"vertical": 0.0, "horizontal": level}.get(str(bundle.get("arrangement")), level)


def _radius(bundle: Mapping[str, Any], count: int) -> float:
    if bundle.get("radius_m"):
        return float(bundle["radius_m"])
    spacing = bundle.get("spacing_m")
    return float(spacing) / (2.0 * math.sin(math.pi / count)) if isinstance(spacing, int | float) else 0.2
