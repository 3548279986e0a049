import math
from collections.abc import Iterator
from typing import Annotated, Any, cast

import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from app import schemas
from app.answers.rows import row_schema
from app.convert import TABLES
from app.schemas.fields import Answer
from tests.app.answer_modules import ANSWER_MODULES

MODELS = [
    model
    for model in (getattr(schemas, name) for name in schemas.__all__)
    if isinstance(model, type) and issubclass(model, BaseModel)
]
ANSWERS = [
    model
    for module in ANSWER_MODULES
    for model in vars(module).values()
    if isinstance(model, type) and issubclass(model, Answer) and model.model_fields
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
            assert schema["x-unit"]
            assert "[" in schema["description"]


@pytest.mark.parametrize(("model", "name", "field"), FIELDS)
def test_every_example_of_a_field_is_valid(model: type[BaseModel], name: str, field: FieldInfo) -> None:
    adapter: TypeAdapter[Any] = TypeAdapter(cast("Any", Annotated[field.annotation, name, *field.metadata]))
    for value in field.examples or []:
        adapter.validate_python(value)


@pytest.mark.parametrize("value", ["1.0", True, None, math.nan, math.inf, -math.inf, 10**400, [], {}])
def test_a_number_is_a_finite_number(value: object) -> None:
    with pytest.raises(ValidationError):
        schemas.ProfilePoint.model_validate({"position_m": value, "factor": 1.0})
