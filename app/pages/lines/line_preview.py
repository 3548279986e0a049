"""What a line becomes while it is described: drawings to scale, and every assumption that it would rest on."""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from math import cosh
from typing import Any

from markupsafe import Markup

from app import convert
from app.convert.known import OwnRows
from app.pages.drawings.iced_bundles import iced_bundle
from app.pages.drawings.neighbours import neighbours
from app.pages.drawings.phase_places import phase_places
from app.pages.drawings.spans import SpanDrawing, span_drawing
from app.pages.drawings.wind_profiles import wind_profile
from app.pages.lines.row_lists import row_lists
from app.pages.measures import Units
from app.schemas.faults import BadInput, Fault

_GRAVITY = 9.80665  # m/s2
_SECTION = "section"
_MOST_ATTEMPTS = 3


@dataclass(frozen=True, slots=True)
class Preview:
    """The drawings, the assumptions, and the doubts about the coefficients."""

    bundle: Markup
    span: SpanDrawing
    neighbours: Markup | None
    wind: Markup | None
    phases: Markup | None
    assumptions: Sequence[Mapping[str, Any]]
    doubts: Sequence[str]
    tension: float
    sag: float


def preview(document: Mapping[str, Any], own: OwnRows, units: Units) -> Preview:
    """Return what the line of a request is, without an analysis; it may name the owner's rows.

    Raises
    ------
    BadInput
        With every fault of the line, with pointers from the root of the request.
    """
    try:
        found = convert.resolve_document(document.get("line"), own)
    except BadInput as error:
        raise BadInput([Fault(f"/line{f.pointer}", f.code, f.detail) for f in error.faults]) from error
    line, values = found["line"], {row["path"]: row["value"] for row in found["assumptions"]}
    iced = (found["states"] or {}).get("iced") or {}
    sag = iced.get("sag_m") or sag_of(line)
    tension = line["span"].get("horizontal_tension_n") or _weight(line) * line["span"]["length_m"] ** 2 / (8.0 * sag)
    accretion = ((document.get("line") or {}).get("ice") or {}).get("accretion")
    thickness = float(values.get("ice.accretion.thickness_m") or 0.0)
    said = {**accretion, "angle_deg": values.get("ice.accretion.angle_deg")} if isinstance(accretion, dict) else None
    return Preview(
        bundle=iced_bundle(line, said, thickness, units),
        span=span_drawing(line, sag, 0.0, units),
        neighbours=neighbours(line, tension / _weight(line), units),
        wind=wind_profile(line, units),
        phases=phase_places(line, units),
        assumptions=found["assumptions"],
        doubts=[str(doubt) for doubt in found["doubts"]],
        tension=tension,
        sag=sag,
    )


def preview_of_sound_rows(
    document: Mapping[str, Any], own: OwnRows, units: Units
) -> tuple[Preview | None, list[Fault]]:
    """Return what a line is without its rows at fault, None where that is no line either; and the faults of the whole.

    A section at fault is left out as a whole: its spans and strings mean nothing without one another.
    """
    faults: list[Fault] = []
    for _ in range(_MOST_ATTEMPTS):
        try:
            return preview(document, own, units), faults
        except BadInput as error:
            faults = faults or list(error.faults)
            sound = _without_rows(document, error.faults)
        if sound is None:
            break
        document = sound
    return None, faults


def _without_rows(document: Mapping[str, Any], faults: Sequence[Fault]) -> dict[str, Any] | None:
    """Return a request without the rows that have these faults; None if others are at fault, too."""
    left = deepcopy(dict(document))
    rows: dict[str, set[int]] = {}
    for fault in faults:
        name, number = _row_at(fault.pointer)
        if name is None:
            return None
        rows.setdefault(name, set()).add(number)
    for name, numbers in rows.items():
        *path, last = name.split(".")
        part = left
        for token in path:
            part = part.get(token, {})
        if isinstance(part.get(last), list) and last != _SECTION:
            part[last] = [item for number, item in enumerate(part[last]) if number not in numbers]
        else:
            part.pop(last, None)
    return left


def _row_at(pointer: str) -> tuple[str | None, int]:
    """Return the list and the number of the row that holds a field; the section as if it were a list."""
    name = pointer.removeprefix("/").replace("/", ".")
    if name.startswith(f"line.{_SECTION}"):
        return f"line.{_SECTION}", 0
    for known in row_lists():
        number = name.removeprefix(f"{known}.").partition(".")[0]
        if name.startswith(f"{known}.") and number.isdecimal():
            return known, int(number)
    return None, 0


def sag_of(line: Mapping[str, Any]) -> float:
    """Return the sag of an explicit line, for its drawing: that of a level catenary of its tension and weight [m]."""
    span = line["span"]
    if span.get("sag_m"):
        return float(span["sag_m"])
    parameter = span.get("catenary_parameter_m") or span["horizontal_tension_n"] / _weight(line)
    return float(parameter * (cosh(0.5 * span["length_m"] / parameter) - 1.0))


def _weight(line: Mapping[str, Any]) -> float:
    return float(line["conductor"]["mass_kg_per_m"]) * _GRAVITY
