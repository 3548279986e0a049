from typing import Any

import pytest
from pydantic import ValidationError

from app.reference.source_lines import example
from app.schemas import Analysis, Line
from app.schemas.faults import faults_of
from app.schemas.units import WrongUnit, any_unit, in_unit


@pytest.mark.parametrize(
    ("value", "unit", "wanted", "expected"),
    [
        (1000, "ft", "m", 304.8),
        (18.0, "in", "m", 0.4572),
        (12.0, "mm", "m", 0.012),
        (1.0, "lbf", "N", 4.4482216152605),
        (1.0, "kip", "N", 4448.2216152605),
        (1.0, "lb/ft", "kg/m", 0.45359237 / 0.3048),
        (57.0, "lb/ft3", "kg/m3", 57.0 * 0.45359237 / 0.3048**3),
        (10.0, "mph", "m/s", 4.4704),
        (1e6, "psi", "Pa", 6.894757293168e9),
        (32.0, "degF", "degC", 0.0),
        (-40.0, "degF", "degC", -40.0),
        (20.0, "%", "1", 0.2),
        (0.5, "rad", "deg", 28.6478897565),
        (12.8, "1e-6/degF", "1/K", 12.8e-6 * 1.8),
        (18.9, "10^-6/K", "1/K", 18.9e-6),
        (795.0, "kcmil", "m2", 795e3 * 0.785398163397 * 2.54e-5**2),
        (1.0, "kip ft2", "N m2", 4448.2216152605 * 0.3048**2),
    ],
)
def test_a_number_is_converted_to_the_unit_of_its_field(value: float, unit: str, wanted: str, expected: float) -> None:
    assert in_unit({"value": value, "unit": unit}, wanted) == pytest.approx(expected, rel=1e-10, abs=1e-9)


@pytest.mark.parametrize(
    ("given", "wanted", "words"),
    [
        ({"value": 5429, "unit": "lb"}, "N", "lb is a mass, but a force is wanted; say lbf"),
        ({"value": 1.0, "unit": "lbf/ft"}, "kg/m", "say lb/ft"),
        ({"value": 1.0, "unit": "s"}, "m", "but a length is wanted; say m or ft"),
        ({"value": 1.0, "unit": "foo"}, "m", "the unit 'foo' is not known; say m or ft"),
        ({"value": 1.0, "unit": "m**999999"}, "m", "not known"),
        ({"value": 1.0, "unit": "__import__('os')"}, "m", "not known"),
        ({"value": 1.0, "unit": ""}, "m", "not known"),
        ({"value": True, "unit": "m"}, "m", "must be a number"),
        ({"value": "12", "unit": "m"}, "m", "must be a number"),
        ({"value": 1.0, "unit": 3}, "m", "must be a number, or"),
        ({"value": 1.0, "unit": "m", "note": ""}, "m", "nothing else"),
    ],
)
def test_a_unit_that_cannot_be_used_becomes_a_sentence(given: dict[str, Any], wanted: str, words: str) -> None:
    found = in_unit(given, wanted)
    assert isinstance(found, WrongUnit)
    assert words in found.sentence


def test_lists_are_converted_item_by_item() -> None:
    assert in_unit([{"value": 10, "unit": "mph"}, 3.0], "m/s") == [4.4704, 3.0]
    assert in_unit([[{"value": 1, "unit": "ft"}, 0.0]], "m") == [[0.3048, 0.0]]
    assert not any_unit([[1.0, 2.0], {"value": 1.0}, "unit"])


def test_a_line_in_feet_and_pounds_is_the_same_line() -> None:
    line = example("c11-twin")
    said = example("c11-twin")
    said["span"]["length_m"] = {"value": 125.88 / 0.3048, "unit": "ft"}
    said["span"]["horizontal_tension_n"] = {"value": 30.0, "unit": "kN"}
    said["bundle"] = {"positions_m": [[0.0, {"value": 23.55, "unit": "cm"}], [0.0, -0.2355]]}
    line["bundle"] = {"positions_m": [[0.0, 0.2355], [0.0, -0.2355]]}
    assert Line.model_validate(said).model_dump() == Line.model_validate(line).model_dump()
    assert Analysis.model_validate({"wind_speeds_m_per_s": [{"value": 10, "unit": "mph"}]}).speeds() == (4.4704,)


def test_a_wrong_unit_is_a_fault_at_its_field_beside_the_others() -> None:
    said = example("c11-twin")
    said["span"]["length_m"] = {"value": 1000, "unit": "lb"}
    said["span"]["elements"] = 1
    with pytest.raises(ValidationError) as caught:
        Line.model_validate(said)
    found = {fault.pointer: fault for fault in faults_of(caught.value.errors(include_url=False))}
    assert set(found) == {"/span/length_m", "/span/elements"}
    assert (found["/span/length_m"].code, found["/span/length_m"].detail) == (
        "unit",
        "lb is a mass, but a length is wanted; say m or ft",
    )
