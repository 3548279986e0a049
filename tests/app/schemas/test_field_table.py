from typing import Any

import pytest

from app.reference.source_lines import example
from app.schemas import JobRequest, Line
from app.schemas.field_table import all_fields, fields_of, input_fields
from tests.app.lines import FULL_LINE

ROWS = {row["name"]: row for row in input_fields()}


def leaves(document: Any, prefix: str) -> set[str]:
    """Return the dotted names of everything in a document, with lists and devices named as the table does."""
    found = set()
    for name, value in document.items():
        path = f"{prefix}{name}"
        found.add(path)
        if isinstance(value, dict) and name != "tags":
            found |= leaves(value, f"{path}.")
        for item in value if isinstance(value, list) else ():
            if isinstance(item, dict):
                found |= leaves(item, f"{path}[{item.get('type', '')}].")
    return found


def test_every_field_that_a_document_can_have_is_in_the_table() -> None:
    study = {"axes": [{"parameter": "span.length_m", "values": [1.0]}]}
    analysis = {"wind_speeds_m_per_s": {"start": 1.0, "stop": 2.0, "count": 3}}
    request = JobRequest.model_validate({"line": FULL_LINE, "analysis": analysis, "study": study})
    dumped = request.model_dump(mode="json", by_alias=True)
    assert leaves(dumped, "") <= ROWS.keys()
    assert len(ROWS) == len(input_fields())


def test_a_number_has_its_unit_bounds_and_default() -> None:
    assert ROWS["line.wind.air_density_kg_per_m3"] == {
        "name": "line.wind.air_density_kg_per_m3",
        "type": "number",
        "unit": "kg/m3",
        "required": False,
        "nullable": False,
        "default": 1.2929,
        "minimum": 0.3,
        "maximum": 2.0,
        "fewest_items": None,
        "most_items": None,
        "choices": None,
        "description": "Density of the air [kg/m3]",
        "example": 1.2929,
    }


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("line.span.length_m", {"required": True, "nullable": False}),
        ("line.span.sag_m", {"required": False, "nullable": True, "default": None, "minimum": 1e-3}),
        ("line.ice.aerodynamics.vertical", {"type": "array", "fewest_items": 3, "most_items": 3, "maximum": 1e4}),
        ("line.bundle.positions_m", {"unit": "m", "minimum": -5.0, "most_items": 32}),
        ("line.damping.model", {"choices": ["constant_coefficient", "constant_ratio"]}),
        ("line.devices[spacer].type", {"choices": ["spacer"]}),
        ("analysis.wind_speeds_m_per_s", {"type": "array or object", "default": [4.0, 5.0, 6.0], "maximum": 100.0}),
        ("study.axes", {"fewest_items": 1, "most_items": 2}),
    ],
)
def test_lists_choices_and_alternatives_are_told(name: str, expected: dict[str, Any]) -> None:
    assert {key: ROWS[name][key] for key in expected} == expected


def test_the_defaults_of_the_table_are_those_that_the_service_takes() -> None:
    taken = JobRequest.model_validate({"line": example("c11-twin")}).model_dump(mode="json", by_alias=True)
    for name in ("analysis.harmonics", "line.supports", "line.ice.segments", "line.devices", "analysis.loops"):
        value: Any = taken
        for token in name.split("."):
            value = value[token]
        assert ROWS[name]["default"] == value


def test_of_a_field_with_several_forms_the_first_one_can_be_had_alone() -> None:
    names, first = ({row["name"] for row in fields_of(Line, first_form=only)} for only in (False, True))
    assert names - first >= {"ice.aerodynamics.table", "ice.aerodynamics.static_angle_deg"}
    assert {"ice.aerodynamics.vertical", "devices[spacer].mass_kg", "devices[airflow_spoiler].from_m"} <= first < names


def test_fields_of_engineers_forms_are_listed_too() -> None:
    rows = {row["name"]: row for row in all_fields()}
    assert len(rows) == len(all_fields())
    assert rows["line.span.everyday.temperature_c"]["unit"] == "degC"
    assert rows["line.conductor.catalogue"]["type"] == "string"
    assert set(ROWS) <= set(rows)
