"""The cross-section of a line: this phase, the other phases and wires, and the clearances that they need."""

from collections.abc import Iterator, Mapping
from math import hypot
from typing import Any

from markupsafe import Markup

from app.pages.drawings.bundles import positions
from app.pages.drawings.scales import Scale, fitting, scale_bar
from app.pages.drawings.svg import Point, element, path, picture
from app.pages.measures import Units
from app.pages.wording import words

SIZE = (420.0, 260.0)
THIS = "this"
"""The name by which interphase spacers call the line itself."""

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
    unit = units.unit("m")
    parts = [*_ties(line, {THIS: (0.0, 0.0), **places}, scale), *scale_bar(scale, unit.name, unit.factor)]
    parts += [element("circle", cx=x, cy=y, r=3.0, class_="wire") for x, y in map(scale.place, own)]
    for name, place in places.items():
        parts += _phase(name, place, needed[name], scale, units)
    x, y = scale.place((0.0, 0.0))
    parts.append(element("text", words().drawings.this_phase, x=x + 7.0, y=y + 16.0))
    return picture(SIZE, words().drawings.phases.format(count=len(places)), parts, "drawing phases")


def _ties(line: Mapping[str, Any], places: Mapping[str, Point], scale: Scale) -> Iterator[Markup]:
    """Yield a line for each interphase spacer between the phases that it ties."""
    for device in line.get("devices") or ():
        ends = [places[name] for name in device.get("between") or () if name in places]
        if len(ends) == 2:
            yield element(
                "path", element("title", words().drawings.tie), d=path([*map(scale.place, ends)]), class_="tie"
            )


def _phase(name: str, place: Point, needed: float, scale: Scale, units: Units) -> Iterator[Markup]:
    """Yield a phase with its name and distance, and with the circle that must be clear of this one."""
    x, y = scale.place(place)
    if needed:
        yield element("circle", cx=x, cy=y, r=scale.per_metre * needed, class_="clear")
    yield element("circle", cx=x, cy=y, r=4.0, class_="phase")
    distance = hypot(*place)
    said = f"{name}, {units.shown(distance, 'm')}"
    near = words().drawings.too_near.format(text=said) if distance < needed else said
    left = x > 0.6 * scale.size[0]
    kind = " ".join(["too-near"] * (distance < needed) + ["note"] * left) or None
    yield element("text", near, x=x - 7.0 if left else x + 7.0, y=y + 4.0, class_=kind)
