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
_WHOLE = ("line.section", "line.climate")
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
    """Return what a line is without its rows at fault, None where that is no line either; and all faults.

    A section or a climate at fault is left out as a whole: their rows mean nothing without one another.
    """
    faults: list[Fault] = []
    left = _Left(dict(document), {})
    for _ in range(_MOST_ATTEMPTS):
        try:
            return preview(left.document, own, units), faults
        except BadInput as error:
            faults += [Fault(left.pointer(fault), fault.code, fault.detail) for fault in error.faults]
            fewer = left.without(error.faults)
        if fewer is None:
            break
        left = fewer
    return None, faults


@dataclass(frozen=True, slots=True)
class _Left:
    """A request without some rows, and the numbers that those which are left had, by the names of their lists."""

    document: dict[str, Any]
    numbers: Mapping[str, Sequence[int]]

    def pointer(self, fault: Fault) -> str:
        """Return the pointer of a fault in the request from which rows were left out."""
        name, number = _row_at(fault.pointer)
        if name not in self.numbers:
            return fault.pointer
        within = fault.pointer.removeprefix(f"/{name.replace('.', '/')}/{number}")
        return f"/{name.replace('.', '/')}/{self.numbers[name][number]}{within}"

    def without(self, faults: Sequence[Fault]) -> "_Left | None":
        """Return the request without the rows that have these faults; None if others are at fault, too."""
        rows: dict[str, set[int]] = {}
        for fault in faults:
            name, number = _row_at(fault.pointer)
            if not name:
                return None
            rows.setdefault(name, set()).add(number)
        document, numbers = deepcopy(self.document), dict(self.numbers)
        for name, wrong in rows.items():
            *path, last = name.split(".")
            part = document
            for token in path:
                part = part.get(token, {})
            if name in _WHOLE:
                part.pop(last, None)
                continue
            numbers[name] = [n for i, n in enumerate(numbers.get(name, range(len(part[last])))) if i not in wrong]
            part[last] = [item for i, item in enumerate(part[last]) if i not in wrong]
        return _Left(document, numbers)


def _row_at(pointer: str) -> tuple[str, int]:
    """Return the list and the number of the row that holds a field; what is left out as a whole as if it were a row."""
    name = pointer.removeprefix("/").replace("/", ".")
    for whole in _WHOLE:
        if f"{name}.".startswith(f"{whole}."):
            return whole, 0
    for known in row_lists():
        number = name.removeprefix(f"{known}.").partition(".")[0]
        if name.startswith(f"{known}.") and number.isdecimal():
            return known, int(number)
    return "", 0


def sag_of(line: Mapping[str, Any]) -> float:
    """Return the sag of an explicit line, for its drawing: that of a level catenary of its tension and weight [m]."""
    span = line["span"]
    if span.get("sag_m"):
        return float(span["sag_m"])
    parameter = span.get("catenary_parameter_m") or span["horizontal_tension_n"] / _weight(line)
    return float(parameter * (cosh(0.5 * span["length_m"] / parameter) - 1.0))


def _weight(line: Mapping[str, Any]) -> float:
    return float(line["conductor"]["mass_kg_per_m"]) * _GRAVITY
