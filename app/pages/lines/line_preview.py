"""What a line becomes while it is described: drawings to scale, and every assumption that it would rest on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cosh
from typing import Any

from fastapi import Request
from markupsafe import Markup

from app import convert
from app.owned import records
from app.pages.drawings.iced_bundles import iced_bundle
from app.pages.drawings.phase_places import phase_places
from app.pages.drawings.spans import span_drawing
from app.pages.frame import caller_of
from app.pages.measures import Units
from app.schemas.faults import BadInput, Fault

_GRAVITY = 9.80665  # m/s2


@dataclass(frozen=True, slots=True)
class Preview:
    """The drawings, the assumptions, and the doubts about the coefficients."""

    bundle: Markup
    span: Markup
    phases: Markup | None
    assumptions: Sequence[Mapping[str, Any]]
    doubts: Sequence[str]
    tension: float
    sag: float


def preview(request: Request, document: Mapping[str, Any], units: Units) -> Preview:
    """Return what the line of a request is, without an analysis.

    Raises
    ------
    BadInput
        With every fault of the line, with pointers from the root of the request.
    """
    with request.app.state.readers() as session:
        own = records.own_rows(session, caller_of(request).owner)
    try:
        found = convert.resolve_document(document.get("line"), own)
    except BadInput as error:
        raise BadInput([Fault(f"/line{f.pointer}", f.code, f.detail) for f in error.faults]) from error
    line, values = found["line"], {row["path"]: row["value"] for row in found["assumptions"]}
    tension = line["span"].get("horizontal_tension_n")
    iced = (found["states"] or {}).get("iced") or {}
    sag = iced.get("sag_m") or sag_of(line)
    accretion = ((document.get("line") or {}).get("ice") or {}).get("accretion")
    thickness = float(values.get("ice.accretion.thickness_m") or 0.0)
    said = {**accretion, "angle_deg": values.get("ice.accretion.angle_deg")} if isinstance(accretion, dict) else None
    return Preview(
        bundle=iced_bundle(line, said, thickness, units),
        span=span_drawing(line, sag, 0.0, units).picture,
        phases=phase_places(line, units),
        assumptions=found["assumptions"],
        doubts=[str(doubt) for doubt in found["doubts"]],
        tension=tension or _weight(line) * line["span"]["length_m"] ** 2 / (8.0 * sag),
        sag=sag,
    )


def sag_of(line: Mapping[str, Any]) -> float:
    """Return the sag of an explicit line, for its drawing: that of a level catenary of its tension and weight [m]."""
    span = line["span"]
    if span.get("sag_m"):
        return float(span["sag_m"])
    parameter = span.get("catenary_parameter_m") or span["horizontal_tension_n"] / _weight(line)
    return float(parameter * (cosh(0.5 * span["length_m"] / parameter) - 1.0))


def _weight(line: Mapping[str, Any]) -> float:
    return float(line["conductor"]["mass_kg_per_m"]) * _GRAVITY
