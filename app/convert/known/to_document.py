"""Resolve a line as an engineer knows it: the explicit line document, and the origin of every value."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from app import schemas
from app.convert.check import request_faults
from app.convert.fit import doubts_of
from app.convert.known.own_rows import OwnRows
from app.convert.known.to_engine import known_line, to_pointer
from app.schemas import known as said
from app.schemas.faults import BadInput, Fault, faults_of
from engine import spec
from engine.known import description as known
from engine.known.provenance import Assumption
from engine.known.resolve import Resolved, end_stiffnesses, resolve
from engine.outcome import InvalidSpec
from engine.result import AssumptionRow

Made = TypeVar("Made")

_DIRECTIONS = ("vertical", "horizontal", "torsional")
_AS_SAID = {"name", "asset_id", "tags", "devices", "climate", "phases", "required_clearance", "section", "design_wind"}
_DOCUMENT_UNITS: Mapping[str, str] = {"rad": "deg", "": "1"}
# What the document calls otherwise than the engine, and what only the engine has, with its unit.
_OTHER_NAMES: Mapping[str, str] = {
    "conductor.modulus": "conductor.youngs_modulus_pa",
    "ice.outer_diameter": "ice.outer_diameter_m",
    "supports.left.longitudinal_stiffness": "supports.left.longitudinal_stiffness_n_per_m",
    "supports.right.longitudinal_stiffness": "supports.right.longitudinal_stiffness_n_per_m",
}


def resolved_document(line: said.KnownLine, own: OwnRows) -> dict[str, Any]:
    """Return the explicit line of what is known, with its assumptions.

    Parameters
    ----------
    line : KnownLine
        A line in any of its forms.
    own : OwnRows
        The owner's conductors and tables.

    Returns
    -------
    dict
        `line`: the explicit document, of which an analysis gives the same results; `assumptions`: a row for each value;
        `states`: the span every day and under ice, null where its iced tension is given; `doubts`: slips that the
        coefficients show.

    Raises
    ------
    BadInput
        With every fault of the parts, or of the line as a whole.
    """
    resolved = _resolved(line, own)
    explicit = _explicit(line, resolved)
    ends = _faulty(line, lambda: end_stiffnesses([resolved.line])[0])
    faults = _faults_of_whole(explicit)
    if faults:
        raise BadInput(faults)
    return {
        "line": explicit,
        "assumptions": [_row(row) for row in (*resolved.assumptions, *ends)],
        "states": _states(resolved),
        "doubts": doubts_of(resolved.line.ice.aerodynamics),
    }


def explicit_document(line: said.KnownLine, own: OwnRows) -> dict[str, Any]:
    """Return the explicit line of what is known, whose rules as a whole are not checked yet.

    Raises
    ------
    BadInput
        With every fault of the parts.
    """
    return _explicit(line, _resolved(line, own))


def _resolved(line: said.KnownLine, own: OwnRows) -> Resolved:
    return _faulty(line, lambda: resolve(known_line(line, own)))


def _faulty(line: said.KnownLine, make: Callable[[], Made]) -> Made:
    """Return what is made, or raise its faults with the pointers of the document."""
    try:
        return make()
    except InvalidSpec as error:
        raise BadInput([to_pointer(fault, line) for fault in error.faults]) from error


def _faults_of_whole(explicit: Mapping[str, Any]) -> list[Fault]:
    try:
        request = schemas.JobRequest.model_validate({"line": explicit})
    except ValidationError as error:
        found = faults_of(error.errors(include_url=False))
    else:
        found = request_faults(request)
    return [Fault(fault.pointer.removeprefix("/line"), fault.code, fault.detail) for fault in found]


def _explicit(said_line: said.KnownLine, resolved: Resolved) -> dict[str, Any]:
    """Return the document of the resolved line; what was said in its own form stays as it was said."""
    line = resolved.line
    document = said_line.model_dump(mode="json", by_alias=True, include=_AS_SAID)
    kept = {name: value for name, value in document.items() if value is not None}
    return kept | {
        "conductor": _conductor(line.conductor),
        "bundle": _bundle(line.bundle),
        "span": _span(line.span),
        "supports": _supports(said_line, line.supports),
        "ice": _ice(said_line, line.ice),
        "wind": _wind(said_line, line.wind),
        "damping": {f"{name}_ratio": getattr(line.damping, f"{name}_ratio") for name in _DIRECTIONS}
        | {"model": line.damping.model.value},
    }


def _conductor(part: spec.Conductor) -> dict[str, Any]:
    return {
        "diameter_m": part.diameter,
        "axial_rigidity_n": part.axial_rigidity,
        "torsional_rigidity_n_m2": part.torsional_rigidity,
        "axial_torsional_coupling_n_m": part.axial_torsional_coupling,
        "mass_kg_per_m": part.mass,
        "polar_inertia_kg_m": part.polar_inertia,
        "rated_strength_n": part.rated_strength,
    }


def _bundle(part: spec.Bundle) -> dict[str, Any]:
    section = part.section.value if part.section else None
    return {"positions_m": [list(position) for position in part.positions], "section": section}


def _span(part: spec.Span) -> dict[str, Any]:
    return {
        "length_m": part.length,
        "horizontal_tension_n": part.horizontal_tension,
        "catenary_parameter_m": part.catenary_parameter,
        "sag_m": part.sag,
        "level_difference_m": part.level_difference,
        "elements": part.elements,
    }


def _supports(line: said.KnownLine, part: spec.Supports) -> dict[str, Any]:
    document: dict[str, Any] = line.supports.model_dump(mode="json", by_alias=True)
    for name in ("left", "right"):
        document[name]["adjacent_span_m"] = getattr(part, name).adjacent_span
    return document


def _ice(line: said.KnownLine, part: spec.Ice) -> dict[str, Any]:
    document: dict[str, Any] = line.ice.model_dump(mode="json", by_alias=True, include={"segments"})
    document |= {"eccentricity_y_m": part.eccentricity_y, "eccentricity_z_m": part.eccentricity_z}
    made = part.aerodynamics
    if made.measured is not None:
        return document | {"aerodynamics": _measured(made.measured)}
    cubics: dict[str, Any] = {name: list(getattr(made, name)) for name in _DIRECTIONS}
    if made.fitted_range is not None:
        cubics["fitted_range_deg"] = math.degrees(made.fitted_range)
    rest = None if made.at_rest is None else dict(zip(_DIRECTIONS, made.at_rest, strict=True))
    return document | {"aerodynamics": cubics, "aerodynamics_at_rest": rest}


def _measured(table: spec.MeasuredCoefficients) -> dict[str, Any]:
    rows = zip(table.angle, table.lift, table.drag, table.moment, strict=True)
    return {
        "table": [
            {"angle_deg": math.degrees(angle), "lift": lift, "drag": drag, "moment": moment}
            for angle, lift, drag, moment in rows
        ],
        "static_angle_deg": math.degrees(table.static_angle),
        "half_range_deg": math.degrees(table.half_range),
    }


def _wind(line: said.KnownLine, part: spec.Wind) -> dict[str, Any]:
    document: dict[str, Any] = (line.wind or schemas.Wind()).model_dump(mode="json", by_alias=True)
    return document | {"air_density_kg_per_m3": part.air_density}


def _states(resolved: Resolved) -> dict[str, Any]:
    named = {"everyday": resolved.everyday, "iced": resolved.iced}
    return {
        name: None
        if state is None
        else {
            "horizontal_tension_n": state.horizontal_tension,
            "largest_tension_n": state.largest_tension,
            "sag_m": state.sag,
        }
        for name, state in named.items()
    }


def _row(row: Assumption) -> dict[str, Any]:
    """Return a row of the assumptions; angles in degrees."""
    lowest, highest, unit = row.lowest, row.highest, row.unit
    return {
        "path": document_path(row.path),
        "value": document_number(row.value, unit),
        "unit": _DOCUMENT_UNITS.get(unit, unit),
        "origin": row.origin.value,
        "source": row.source,
        "lowest": None if lowest is None else document_number(lowest, unit),
        "highest": None if highest is None else document_number(highest, unit),
    }


def assumption_rows(line: known.KnownLine) -> tuple[AssumptionRow, ...]:
    """Return the rows of a result about where the values of a line came from."""
    resolved = resolve(line)
    return result_rows((*resolved.assumptions, *end_stiffnesses([resolved.line])[0]))


def result_rows(assumptions: Iterable[Assumption]) -> tuple[AssumptionRow, ...]:
    """Return assumptions of the engine as rows of a result, in the names and units of documents."""
    return tuple(AssumptionRow(**_row(row)) for row in assumptions)


def document_number(value: float, unit: str) -> float:
    """Return a number of the engine in the unit of documents."""
    return math.degrees(value) if unit == "rad" else float(value)


def document_path(path: str) -> str:
    """Return the dotted name of a field in documents from its dotted name in the engine."""
    return _OTHER_NAMES.get(path) or _document_names().get(path, path)


@cache
def _document_names() -> dict[str, str]:
    return dict(_names(said.KnownLine, "", "", 0))


def _names(model: type[BaseModel], engine: str, document: str, depth: int) -> Iterator[tuple[str, str]]:
    for name, info in reversed(model.model_fields.items()):
        paths = engine + name, document + (info.alias or name)
        yield paths
        for inner in _models(info.annotation) if depth < 3 else ():
            yield from _names(inner, f"{paths[0]}.", f"{paths[1]}.", depth + 1)


def _models(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type):
        return [annotation] if issubclass(annotation, BaseModel) else []
    return [model for part in get_args(annotation) for model in _models(part)]
