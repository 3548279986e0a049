"""The rules of phases, and of the spacers that tie them."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from engine.outcome import InvalidSpec
from engine.spec import BlowOut, InterphaseSpacer, Line, Phase, own_line
from tests.builders import phases_line, section_line, source_line

SPACER = InterphaseSpacer(62.94, 20.0, ("this", "top"))
LINE = phases_line(SPACER)
OWN = source_line(2)


def beside(*phases: Phase) -> Callable[[], Line]:
    return lambda: replace(LINE, phases=phases)


def with_line(**changes: object) -> Callable[[], Line]:
    return beside(Phase("top", 7.0, 0.0, line=replace(OWN, **changes)))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("make", "field", "value", "word"),
    [
        (lambda: Phase("this", 7.0, 0.0), "name", "this", "must not be empty or"),
        (lambda: Phase("top", math.nan, 0.0), "y", math.nan, "finite"),
        (lambda: Phase("top", 7.0, 0.0, required_clearance=0.0), "required_clearance", 0.0, "greater than zero"),
        (lambda: Phase("top", 7.0, 0.0, ice=OWN.ice, line=OWN), "ice", None, "must be absent"),
        (lambda: Phase("top", 7.0, 0.0, line=LINE), "line.phases", 1, "must be absent"),
        (lambda: Phase("top", 7.0, 0.0, line=section_line()), "line.section", None, "must be absent"),
        (lambda: replace(SPACER, between=("top", "top")), "between", ("top", "top"), "two different phases"),
        (lambda: replace(SPACER, axial_stiffness=0.0), "axial_stiffness", 0.0, "greater than zero"),
        (lambda: replace(SPACER, mass=-1.0), "mass", -1.0, "at least zero"),
        (beside(Phase("top", 0.0, 0.0)), "phases.0.y", (0.0, 0.0), "must be 0.5 m or more away from"),
        (
            beside(Phase("top", 7.0, 0.0), Phase("low", 7.0, 0.1)),
            "phases.1.y",
            (7.0, 0.1),
            'must be 0.5 m or more away from "top"',
        ),
        (beside(Phase("top", 7.0, 0.0), Phase("top", -7.0, 0.0)), "phases.1.name", "top", "one phase only"),
        (beside(), "devices.0.between", "top", 'must be one of the phases that are given: "this"'),
        (
            lambda: phases_line(replace(SPACER, position=130.0)),
            "devices.0.position",
            130.0,
            "must lie on the span",
        ),
        (with_line(span=replace(OWN.span, length=130.0)), "phases.0.line.span.length", 130.0, "that of the line"),
        (with_line(span=replace(OWN.span, elements=20)), "phases.0.line.span.elements", 20, "that of the line"),
        (with_line(bundle=source_line(1).bundle), "phases.0.line.bundle", 1, "as many sub-conductors"),
        (
            with_line(wind=replace(OWN.wind, blow_out=BlowOut(10.0, 1.0))),
            "phases.0.line.wind.blow_out",
            None,
            "must be absent",
        ),
        (
            lambda: replace(LINE, wind=replace(OWN.wind, blow_out=BlowOut(10.0, 1.0))),
            "wind.blow_out",
            None,
            "as they hang in still air",
        ),
    ],
)
def test_a_broken_rule_names_field_and_value(make: Callable[[], object], field: str, value: object, word: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        make()
    faults = {fault.field: fault for fault in caught.value.faults}
    assert word in faults[field].rule
    assert repr(faults[field].value) == repr(value)  # nan is not equal to itself


def test_a_section_has_no_tied_phases() -> None:
    section = section_line()
    place = replace(SPACER, position=100.0)
    with pytest.raises(InvalidSpec, match="they tie single spans"):
        replace(section, phases=LINE.phases, devices=(place,))


def test_phases_for_clearances_only_may_be_anything() -> None:
    wire = replace(source_line(1), span=replace(OWN.span, length=130.0, elements=4))
    line = replace(OWN, phases=(Phase("ground wire", 14.0, 1.0, 1.2, line=wire),))
    assert line.interphase_spacers == ()
    assert own_line(line, line.phases[0]) == wire


def test_a_phase_is_a_copy_with_its_own_ice() -> None:
    ice = replace(OWN.ice, eccentricity_y=-1e-3)
    phase = Phase("top", 7.0, 0.0, ice=ice)
    assert own_line(LINE, phase) == replace(OWN, ice=ice)
