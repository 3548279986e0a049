"""What a picture says about the line besides its tables: name, footer, bundle, design ellipse and other phases."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app import convert
from app.plots.parts.paths import words_of
from app.schemas.faults import BadInput

Row = Mapping[str, Any]
Found = Mapping[str, Sequence[Row]]


@dataclass(frozen=True, slots=True)
class Phase:
    """Another phase or wire: its place relative to the line, upward and downwind, and the required distance [m]."""

    name: str
    up: float
    downwind: float
    required: float | None


@dataclass(frozen=True, slots=True)
class Ellipse:
    """The ellipse of design practice at mid-loop (CIGRE TB 322): axes peak to peak, and its foot below the wire [m]."""

    major: float
    minor: float
    below: float


@dataclass(frozen=True, slots=True)
class Facts:
    """The facts of a line that pictures show beside the tables.

    title is the line's name. bundle holds y and z of the sub-conductors [m]. axes are the names of the fields that a
    study varies. footer has the sentences below every picture.
    """

    title: str
    length: float | None = None
    sag: float | None = None
    level_difference: float = 0.0
    tension: float | None = None
    bundle: tuple[tuple[float, float], ...] = ()
    phases: tuple[Phase, ...] = ()
    ellipse: Ellipse | None = None
    of_section: bool = False
    axes: tuple[str, ...] = ()
    footer: tuple[str, ...] = ()


def facts_of(title: str, request: Row, static: Row | None, found: Found, engine_version: str | None) -> Facts:
    """Gather the facts of a request's line at one point.

    Parameters
    ----------
    title : str
        Heading of the picture; the name of the line, usually.
    request : mapping
        A request document with its defaults; without a line (a chunk of a batch) little is known.
    static : mapping, optional
        The row of the point's static state.
    found : mapping
        Rows of the tables that the picture shows.
    engine_version : str, optional
    """
    line: Row = request.get("line") or {}
    span: Row = line.get("span") or {}
    positions = _positions(line.get("bundle") or {})
    axes = tuple(axis["parameter"] for axis in (request.get("study") or {"axes": ()})["axes"])
    return Facts(
        title=title,
        length=span.get("length_m"),
        sag=static["sag_m"] if static else None,
        level_difference=span.get("level_difference_m") or 0.0,
        tension=static["horizontal_tension_n"] if static else None,
        bundle=positions,
        phases=_phases(line),
        ellipse=_ellipse(line, static, len(positions)),
        of_section=line.get("section") is not None,
        axes=axes,
        footer=(_line_in_words(line, static, len(positions), axes), _analysis_in_words(request, found, engine_version)),
    )


def _positions(bundle: Row) -> tuple[tuple[float, float], ...]:
    """Return y, z of the sub-conductors [m]; angles count clockwise from straight up."""
    if bundle.get("positions_m"):
        return tuple((float(y), float(z)) for y, z in bundle["positions_m"])
    count, radius = bundle.get("subconductors") or 1, bundle.get("radius_m") or 0.0
    start = math.radians(bundle.get("orientation_deg") or 0.0)
    angles = [start + 2.0 * math.pi * i / count for i in range(count)]
    return tuple((radius * math.cos(angle), radius * math.sin(angle)) for angle in angles)


def _phases(line: Row) -> tuple[Phase, ...]:
    usual = line.get("required_clearance_m")
    return tuple(
        Phase(phase["name"], phase["y_m"], phase["z_m"], phase.get("required_clearance_m") or usual)
        for phase in line.get("phases") or ()
    )


def _ellipse(line: Row, static: Row | None, subconductors: int) -> Ellipse | None:
    diameter = (line.get("conductor") or {}).get("diameter_m")
    if not static or not static["sag_m"] or not diameter:
        return None
    try:
        found = convert.ellipse("cigre", static["sag_m"], None, diameter, subconductors)
    except BadInput:
        return None
    major, minor, below = found["major_axis_m"], found["minor_axis_m"], found["b_m"]
    return Ellipse(major, minor, below) if major and minor and below is not None else None


def _line_in_words(line: Row, static: Row | None, subconductors: int, axes: Sequence[str]) -> str:
    span: Row = line.get("span") or {}
    diameter = (line.get("conductor") or {}).get("diameter_m")
    parts = [
        "single conductor" if subconductors == 1 else f"{subconductors} sub-conductors",
        f"diameter {1e3 * diameter:.1f} mm" if diameter else "",
        f"span {span['length_m']:.4g} m" if span.get("length_m") and (static or "span.length_m" not in axes) else "",
        f"sag {static['sag_m']:.3g} m" if static and static["sag_m"] else "",
        f"horizontal tension {1e-3 * static['horizontal_tension_n']:.3g} kN a conductor" if static else "",
        f"section of {len(line['section']['spans'])} spans" if line.get("section") else "",
        f"varied: {', '.join(map(words_of, axes))}" if axes and not static else "",
    ]
    return ", ".join(part for part in parts if part) if line else ""


def _analysis_in_words(request: Row, found: Found, engine_version: str | None) -> str:
    models = {"hybrid": "hybrid model", "finite_element": "finite element model"}
    asked: Row = request.get("analysis") or {}
    physics = next(iter(found.get("physics", ())), None)
    parts = [
        _winds_in_words(asked.get("wind_speeds_m_per_s")),
        " and ".join(models[name] for name in asked.get("models", ()) if name in models),
        f"{physics['physics']} physics" if physics else "",
        f"engine {engine_version}" if engine_version else "",
    ]
    return ", ".join(part for part in parts if part)


def _winds_in_words(winds: Any) -> str:
    if isinstance(winds, Mapping):
        count, first, last = winds["count"], winds["start"], winds["stop"]
    elif winds:
        count, first, last = len(winds), min(winds), max(winds)
    else:
        return ""
    return f"wind {first:g} m/s" if count == 1 else f"wind {first:g} to {last:g} m/s ({count} speeds)"
