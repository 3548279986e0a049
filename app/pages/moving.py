"""The animation of a motion: drawings at rest, and what a script needs to move them over one period."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sin
from typing import Any

from markupsafe import Markup

from app import convert
from app.pages.charts.curves import label
from app.pages.drawings.bundles import positions
from app.pages.drawings.orbits import Surroundings, orbit_picture, orbit_scale
from app.pages.drawings.spans import positions_along, span_drawing
from app.pages.findings import Findings
from app.pages.measures import Units
from app.pages.motions import Motion
from app.pages.wording import words
from app.schemas.faults import BadInput
from app.tables import Job


@dataclass(frozen=True, slots=True)
class Moving:
    """A motion as its part of a page shows it: the drawings, what moves them, and whether the shape is computed."""

    motion: Motion
    name: str
    orbit: Markup
    span: Markup | None
    legend: Sequence[tuple[Markup, str]]
    exaggeration: str
    data: str
    computed_shape: bool


def name_of(motion: Motion, units: Units) -> str:
    """Return which motion it is: wind speed, model, loops and stability."""
    return f"{units.shown(motion.row['wind_speed_m_per_s'], 'm/s')}, {label(motion.row)}"


def surroundings(found: Findings) -> Surroundings:
    """Return the line of a point with the design ellipse of CIGRE TB 322, where that gives one."""
    line, static = found.line_here, found.here["static"] or {}
    sag, diameter = static.get("sag_m"), (line.get("conductor") or {}).get("diameter_m")
    if not sag or not diameter:
        return Surroundings(line, None)
    count = len(positions(line.get("bundle") or {}))
    try:
        made = convert.ellipse("cigre", sag, None, diameter, count)
    except BadInput:
        return Surroundings(line, None)
    axes = made["major_axis_m"], made["minor_axis_m"], made["b_m"]
    return Surroundings(line, None if None in axes else axes)  # type: ignore[arg-type]


def moving(job: Job, found: Findings, motion: Motion, units: Units) -> Moving:
    """Return the drawings of a motion, with the mode shape of its model along the span where there is one."""
    around, name = surroundings(found), name_of(motion, units)
    title = words().motion.orbit_title.format(name=name)
    data: dict[str, Any] = {
        "period": motion.period,
        "v": [round(value, 5) for value in motion.vertical],
        "w": [round(value, 5) for value in motion.horizontal],
        "theta": [round(value, 6) for value in motion.torsional],
        "cross": orbit_scale(motion, around).per_metre,
    }
    drawn, computed = None, False
    if found.line.get("section") is None and found.here["static"]:
        amplitude = max(map(abs, [*motion.vertical, *motion.horizontal]))
        drawn = span_drawing(found.line_here, found.here["static"]["sag_m"], amplitude, units)
        shapes, computed = _shapes(job, found, motion)
        data["span"] = {
            "x": [round(x, 1) for x in drawn.across],
            "y": [round(y, 1) for y in drawn.rest],
            "scale": drawn.per_metre,
            "plan": drawn.plan,
            **{key: [round(value, 4) for value in shape] for key, shape in shapes.items()},
        }
    return Moving(
        motion=motion,
        name=name,
        orbit=orbit_picture(motion, around, units, title),
        span=drawn.picture if drawn else None,
        legend=drawn.legend if drawn else (),
        exaggeration=f"{drawn.exaggeration:.2g}" if drawn else "",
        data=json.dumps(data, separators=(",", ":")),
        computed_shape=computed,
    )


def _shapes(job: Job, found: Findings, motion: Motion) -> tuple[dict[str, Sequence[float]], bool]:
    """Return how far each place moves up and across, over the place of observation; and whether that is computed."""
    length, row = float(found.line_here["span"]["length_m"]), motion.row
    places = positions_along(length)
    try:
        rows = convert.mode_shapes(job.document, found.point)
    except (ArithmeticError, ValueError, LookupError):
        rows = []
    made = {}
    for key, direction in (("f", "vertical"), ("g", "horizontal")):
        own = [r for r in rows if (r["model"], r["direction"], r["loops"]) == (row["model"], direction, row["loops"])]
        if own:
            at = float(row["observed_at_m"])
            whole = [_between(own[0]["position_m"], own[0][direction], x) for x in (*places, at)]
            if abs(whole[-1]) > 1e-3 * max(map(abs, whole)):
                made[key] = [value / whole[-1] for value in whole[:-1]]
    computed = len(made) == 2
    waves = [sin(row["loops"] * pi * x / length) for x in places]
    return {"f": made.get("f", waves), "g": made.get("g", waves)}, computed


def _between(places: Sequence[float], values: Sequence[float], x: float) -> float:
    for number in range(1, len(places)):
        if x <= places[number] or number == len(places) - 1:
            part = (x - places[number - 1]) / (places[number] - places[number - 1])
            return values[number - 1] + part * (values[number] - values[number - 1])
    return values[0]
