"""The cross-section of a line: this phase, the other phases and wires, and the clearances that they need."""

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from app.pages.drawings.bundles import positions
from app.pages.drawings.scales import fitting
from app.pages.drawings.svg import Point, element, picture
from app.pages.measures import Units
from app.pages.wording import words

SIZE = (420.0, 260.0)
_MARGIN = 30.0


def phase_places(line: Mapping[str, Any], units: Units) -> Markup | None:
    """Return the drawing of an explicit line among its other phases, to scale; None where it says none."""
    phases = line.get("phases") or ()
    if not phases:
        return None
    own = positions(line["bundle"])
    usual = line.get("required_clearance_m")
    needed: dict[str, float] = {p["name"]: p.get("required_clearance_m") or usual or 0.0 for p in phases}
    places: dict[str, Point] = {phase["name"]: (phase["z_m"], phase["y_m"]) for phase in phases}
    corners = [
        (x + dx, y + dy)
        for name, (x, y) in places.items()
        for dx in (-needed[name], needed[name])
        for dy in (-needed[name], needed[name])
    ]
    scale = fitting([*corners, *own], SIZE, _MARGIN, least=1.0)
    parts = [element("circle", cx=x, cy=y, r=3.0, class_="wire") for x, y in map(scale.place, own)]
    for name, place in places.items():
        x, y = scale.place(place)
        if needed[name]:
            parts.append(element("circle", cx=x, cy=y, r=scale.per_metre * needed[name], class_="clear"))
        parts.append(element("circle", cx=x, cy=y, r=4.0, class_="phase"))
        parts.append(element("text", f"{name}, {_distance(place, units)}", x=x + 7.0, y=y + 4.0))
    x, y = scale.place((0.0, 0.0))
    parts.append(element("text", words().drawings.this_phase, x=x + 7.0, y=y + 16.0))
    return picture(SIZE, words().drawings.phases.format(count=len(places)), parts, "drawing phases")


def _distance(place: Point, units: Units) -> str:
    return units.shown((place[0] ** 2 + place[1] ** 2) ** 0.5, "m")
