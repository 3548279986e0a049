import math
from collections.abc import Iterator
from typing import Annotated, Any, cast

import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from app import schemas
from app.answers import aerodynamics, batches, clearance, health, jobs, problem_pages, reference, results
from app.answers.rows import row_schema
from app.convert import TABLES
from app.reference.source_lines import EXAMPLE_NAMES, example
from app.schemas.fields import Answer

MODELS = [
    model
    for model in (getattr(schemas, name) for name in schemas.__all__)
    if isinstance(model, type) and issubclass(model, BaseModel)
]
ANSWERS = [
    model
    for module in (jobs, results, problem_pages, health, batches, aerodynamics, clearance, reference)
    for model in vars(module).values()
    if isinstance(model, type) and issubclass(model, Answer)
] + [row_schema(table.row) for table in TABLES.values()]
FIELDS = [(model, name, field) for model in (*MODELS, *ANSWERS) for name, field in model.model_fields.items()]


def numbers(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        if schema.get("type") in {"number", "integer"}:
            yield schema
        for value in schema.values():
            yield from numbers(value)
    if isinstance(schema, list):
        for value in schema:
            yield from numbers(value)


@pytest.mark.parametrize(("model", "name", "field"), FIELDS)
def test_every_field_says_what_it_is(model: type[BaseModel], name: str, field: FieldInfo) -> None:
    assert field.description, f"{model.__name__}.{name}"


@pytest.mark.parametrize("model", MODELS)
def test_every_number_of_a_document_has_bounds_and_a_unit(model: type[BaseModel]) -> None:
    for name, schema in model.model_json_schema(by_alias=True)["properties"].items():
        if name == "values":
            continue  # of a study: they have the unit and the bounds of the field that they vary
        found = list(numbers(schema))
        assert all("minimum" in number and "maximum" in number for number in found), name
        if found:
            assert schema["unit"]
            assert "[" in schema["description"]


@pytest.mark.parametrize(("model", "name", "field"), FIELDS)
def test_every_example_of_a_field_is_valid(model: type[BaseModel], name: str, field: FieldInfo) -> None:
    adapter: TypeAdapter[Any] = TypeAdapter(cast("Any", Annotated[field.annotation, name, *field.metadata]))
    for value in field.examples or []:
        adapter.validate_python(value)


@pytest.mark.parametrize("name", EXAMPLE_NAMES)
def test_the_source_lines_are_valid_and_keep_their_figures(name: str) -> None:
    line = schemas.Line.model_validate(example(name))
    assert line.conductor.axial_rigidity == pytest.approx(28418105.784)
    assert line.span.length == 125.88
    assert line.model_dump(mode="json", by_alias=True)["bundle"]["subconductors"] == EXAMPLE_NAMES.index(name) + 1


def test_a_line_survives_the_way_through_json() -> None:
    line = schemas.Line.model_validate(example("c11-twin"))
    assert schemas.Line.model_validate(line.model_dump(mode="json", by_alias=True)) == line


def test_a_range_of_wind_speeds_meets_both_ends() -> None:
    analysis = schemas.Analysis.model_validate({"wind_speeds_m_per_s": {"start": 4.0, "stop": 6.1, "count": 22}})
    speeds = analysis.speeds()
    assert len(speeds) == 22
    assert (speeds[0], speeds[-1]) == (4.0, 6.1)
    assert speeds[1] == pytest.approx(4.1)


def test_a_list_of_wind_speeds_is_taken_as_it_is() -> None:
    assert schemas.Analysis.model_validate({"wind_speeds_m_per_s": [5, 4.5]}).speeds() == (5.0, 4.5)


@pytest.mark.parametrize("value", ["1.0", True, None, math.nan, math.inf, -math.inf, 10**400, [], {}])
def test_a_number_is_a_finite_number(value: object) -> None:
    with pytest.raises(ValidationError):
        schemas.ProfilePoint.model_validate({"position_m": value, "factor": 1.0})


@pytest.mark.parametrize(
    ("change", "sound"),
    [
        ({"axial_rigidity_n": 1e7}, True),
        ({"area_m2": 4e-4, "youngs_modulus_pa": 5e10}, True),
        ({}, False),
        ({"area_m2": 4e-4}, False),
        ({"youngs_modulus_pa": 5e10}, False),
        ({"axial_rigidity_n": 1e7, "area_m2": 4e-4}, False),
        ({"axial_rigidity_n": 1e7, "area_m2": 4e-4, "youngs_modulus_pa": 5e10}, False),
    ],
)
def test_the_axial_rigidity_is_given_in_exactly_one_way(change: dict[str, float], sound: bool) -> None:
    conductor = {key: value for key, value in example("c11-twin")["conductor"].items() if key != "axial_rigidity_n"}
    if sound:
        assert schemas.Conductor.model_validate(conductor | change).diameter == 0.0286
    else:
        with pytest.raises(ValidationError, match="exactly one"):
            schemas.Conductor.model_validate(conductor | change)


@pytest.mark.parametrize(
    "bundle",
    [
        {},
        {"radius_m": 0.2},
        {"subconductors": 2, "radius_m": 0.2, "positions_m": [[0.0, 0.0]]},
        {"positions_m": []},
        {"positions_m": [[0.0]]},
        {"subconductors": 13, "radius_m": 0.2},
        {"subconductors": 2.0, "radius_m": 0.2},
    ],
)
def test_a_bundle_is_a_circle_or_positions(bundle: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        schemas.Bundle.model_validate(bundle)


@pytest.mark.parametrize(
    "axes",
    [
        [],
        [{"parameter": "span.length_m", "values": []}],
        [{"parameter": "span.length_m", "values": [1]}, {"parameter": "span.length_m", "values": [2]}],
        [{"parameter": f"span.{name}", "values": [1]} for name in ("length_m", "sag_m", "elements")],
        [
            {"parameter": "span.length_m", "values": [100.0] * 101},
            {"parameter": "span.horizontal_tension_n", "values": [3e4] * 100},
        ],
        [{"parameter": "span.length_m", "values": [True]}],
        [{"parameter": "span.length_m", "values": [math.nan]}],
        [{"parameter": "span.length_m", "values": [10**400]}],
        [{"parameter": "span..length_m", "values": [1]}],
        [{"parameter": "__class__.x", "values": [1]}],
        [{"parameter": "span.length_m", "also": ["span.length_m"], "values": [1]}],
        [{"parameter": "span.length_m", "also": ["__class__.x"], "values": [1]}],
    ],
)
def test_a_study_has_one_or_two_axes_of_different_fields_and_at_most_ten_thousand_points(axes: list[Any]) -> None:
    with pytest.raises(ValidationError):
        schemas.Study.model_validate({"axes": axes})


def test_documents_that_leave_a_field_out_share_its_default_which_nobody_can_change() -> None:
    first, second = (schemas.JobRequest.model_validate({"line": example("c11-twin")}) for _ in range(2))
    assert first.analysis is second.analysis
    with pytest.raises(ValidationError, match="frozen"):
        first.analysis.harmonics = 7  # type: ignore[misc]
    given = schemas.JobRequest.model_validate({"line": example("c11-twin"), "analysis": {"harmonics": 7}})
    assert (given.analysis.harmonics, second.analysis.harmonics) == (7, 5)
