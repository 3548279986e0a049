"""Phases and interphase spacers in requests: what arrives in the engine, and what is refused, by field, value, rule."""

import copy
from typing import Any

import pytest

from app import schemas
from app.convert.check import read, request_faults
from app.convert.run import specification
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from engine import spec
from engine.spec.physics import with_section

TWIN = example("c11-twin")
SPACER = {"type": "interphase_spacer", "position_m": 62.94, "mass_kg": 30.0, "between": ["this", "top"]}
WIRE: dict[str, Any] = {
    "name": "ground wire",
    "y_m": 14.0,
    "z_m": 1.0,
    "required_clearance_m": 1.2,
    "line": {"bundle": {"subconductors": 1}, "span": {"length_m": 125.88, "sag_m": 1.0}},
}
LINE: dict[str, Any] = {
    **TWIN,
    "phases": [{"name": "top", "y_m": 7.0, "ice": {**TWIN["ice"], "eccentricity_y_m": 1e-3}}, WIRE],
    "required_clearance_m": 1.5,
    "devices": [SPACER],
}


def with_value(path: str, value: object) -> dict[str, Any]:
    line = copy.deepcopy(LINE)
    *way, last = path.split(".")
    node: Any = line
    for token in way:
        node = node[int(token)] if isinstance(node, list) else node[token]
    node[int(last) if isinstance(node, list) else last] = value
    return line


def faults(line: dict[str, Any], **analysis: object) -> dict[str, str]:
    request = schemas.JobRequest.model_validate({"line": line, "analysis": analysis})
    return {fault.pointer: fault.detail for fault in request_faults(request)}


def test_every_field_arrives_in_the_engine() -> None:
    request = schemas.JobRequest.model_validate({"line": with_value("devices.0", {**SPACER, "stiffness_n_per_m": 1e5})})
    line, _ = specification(request, {})
    assert line.devices == (spec.InterphaseSpacer(62.94, 30.0, ("this", "top"), 1e5),)
    assert line.required_clearance == 1.5
    top, wire = line.phases
    assert (top.name, top.y, top.z, top.required_clearance, top.line) == ("top", 7.0, 0.0, None, None)
    assert top.ice is not None
    assert top.ice.eccentricity_y == 1e-3
    assert (wire.name, wire.y, wire.z, wire.required_clearance, wire.ice) == ("ground wire", 14.0, 1.0, 1.2, None)
    assert wire.line is not None
    assert (wire.line.span.sag, wire.line.bundle.positions) == (1.0, ((0.0, 0.0),))
    assert wire.line.conductor == line.conductor
    assert wire.line.devices == ()


@pytest.mark.parametrize(
    ("path", "value", "pointer", "detail"),
    [
        ("phases.0.y_m", 0.0, "/line/phases/0/y_m", 'must be 0.5 m or more away from "this"'),
        ("phases.1.name", "top", "/line/phases/1/name", "must be the name of one phase only, got top"),
        ("devices.0.position_m", 130.0, "/line/devices/0/position_m", "must lie on the span (its length is 125.88)"),
        ("devices.0.between", ["this", "low"], "/line/devices/0/between", "must be one of the phases that are given"),
        ("devices.0.between", ["top", "top"], "/line/devices/0/between", "must name two different phases"),
        ("devices.0.between", ["this", "ground wire"], "/line/phases/1/line/bundle", "as many sub-conductors"),
        ("phases.1.line.span.sag_m", 400.0, "/line/phases/1/line/span/sag_m", "must give a sag smaller"),
        ("phases.0.ice.eccentricity_y_m", 0.1, "/line/phases/0/ice/eccentricity_y_m", "polar inertia"),
    ],
)
def test_what_does_not_fit_is_named(path: str, value: object, pointer: str, detail: str) -> None:
    found = faults(with_value(path, value))
    assert detail in found[pointer]
    others = {"/line/phases/1/line/bundle"} if value == "top" else set()  # by name, the spacer ties the wire as well
    assert set(found) == {pointer} | others


def test_a_line_with_faulty_phases_is_checked_for_the_rest() -> None:
    line = with_value("phases.0.y_m", "high")
    line["devices"].append({"type": "spacer", "position_m": 200.0, "mass_kg": 1.0, "polar_inertia_kg_m2": 0.1})
    with pytest.raises(BadInput) as caught:
        read({"line": line})
    assert sorted(fault.pointer for fault in caught.value.faults) == [
        "/line/devices/1/position_m",
        "/line/phases/0/y_m",
    ]


def test_what_an_analysis_of_tied_phases_has_not_is_named() -> None:
    assert faults(LINE) == {}
    found = faults(LINE, models=["hybrid"], device_effect="reported")
    assert "must hold finite_element" in found["/analysis/models"]
    assert "must not be reported" in found["/analysis/device_effect"]


def test_full_physics_needs_coefficients_at_rest_of_every_tied_phase() -> None:
    rest = {"vertical": 0.0, "horizontal": 1.0, "torsional": 0.0}
    line = with_value("ice", {**TWIN["ice"], "aerodynamics_at_rest": rest})
    assert list(faults(line, physics="full")) == ["/line/phases/0/ice/aerodynamics_at_rest"]
    _, analysis = specification(schemas.JobRequest.model_validate({"line": line}), {})
    assert (analysis.physics, analysis.lacks) == ("source", "phases.0.ice.aerodynamics_at_rest")


def test_a_phase_with_a_line_of_its_own_has_the_section_of_the_physics() -> None:
    side = {"name": "side", "y_m": 0.0, "z_m": 9.0, "line": {"span": {"length_m": 125.88, "sag_m": 1.5}}}
    request = schemas.JobRequest.model_validate({"line": {**TWIN, "phases": [side]}})
    line, _ = specification(request, {})
    assert line.phases[0].line is not None
    assert line.phases[0].line.bundle.section is spec.CrossSection.RIGID
    assert with_section(line, spec.Physics.FULL).phases == line.phases  # said already


def test_a_study_may_vary_a_place_of_a_phase() -> None:
    study = {"axes": [{"parameter": "phases.0.y_m", "values": [6.0, 8.0]}]}
    request = schemas.JobRequest.model_validate({"line": LINE, "study": study})
    assert list(request_faults(request)) == []
    line, _ = specification(request, {"phases.0.y_m": 8.0})
    assert line.phases[0].y == 8.0
