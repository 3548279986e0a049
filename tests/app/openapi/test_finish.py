import re
from collections.abc import Iterator
from typing import Any

import pytest
from openapi_schema_validator import OAS31Validator
from openapi_spec_validator import OpenAPIV31SpecValidator
from referencing import Registry
from referencing.jsonschema import DRAFT202012

from app.main import create_app
from app.openapi.finish import operations
from tests.app import service

JSON = re.compile(r"application/(.*\+)?json")
OPEN = {"/health/live", "/health/ready", "/problems/{slug}"}


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Give the OpenAPI document."""
    made: dict[str, Any] = create_app(service.sqlite_settings(tmp_path_factory.mktemp("openapi"))).openapi()
    return made


def contents(operation: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield media type and content of the body and of every answer of an operation."""
    for body in (operation.get("requestBody", {}), *operation["responses"].values()):
        yield from body.get("content", {}).items()


def test_the_validator_of_openapi_3_1_finds_nothing(document: dict[str, Any]) -> None:
    assert [error.message for error in OpenAPIV31SpecValidator(document).iter_errors()] == []


def test_every_example_is_valid_by_the_schema_that_generators_read(document: dict[str, Any]) -> None:
    registry: Registry[Any] = Registry().with_resource("urn:document", DRAFT202012.create_resource(document))

    def faults(schema: dict[str, Any], value: object) -> list[str]:
        rooted = (
            {**schema, "$id": "urn:document"} if "$ref" not in schema else {"$ref": f"urn:document{schema['$ref']}"}
        )
        return [error.message for error in OAS31Validator(rooted, registry=registry).iter_errors(value)]

    wrong, checked = [], 0
    for path, method, operation in operations(document):
        for media_type, content in contents(operation):
            given = [item["value"] for item in content.get("examples", {}).values()]
            for value in [*given, *([content["example"]] if "example" in content else [])]:
                if JSON.fullmatch(media_type):
                    checked += 1
                    wrong += [f"{method} {path}: {fault}" for fault in faults(content["schema"], value)]
    for name, schema in document["components"]["schemas"].items():
        for field, inner in schema.get("properties", {}).items():
            for value in inner.get("examples", ()):
                checked += 1
                pointer = {"$ref": f"#/components/schemas/{name}/properties/{field}"}
                wrong += [f"{name}.{field}: {fault}" for fault in faults(pointer, value)]
    assert not wrong, "\n".join(wrong)
    assert checked > 700


def test_no_title_of_a_field_makes_a_class_refer_to_itself(document: dict[str, Any]) -> None:
    components = document["components"]["schemas"]
    titled = [
        f"{name}.{field}"
        for name, schema in components.items()
        for field, inner in schema.get("properties", {}).items()
        if "title" in inner
    ]
    assert titled == []
    assert [name for name in components if not re.fullmatch(r"[A-Z][A-Za-z]+", name)] == []


def test_every_operation_says_who_may_use_it_and_what_people_call_it(document: dict[str, Any]) -> None:
    names, summaries = [], []
    tags = {tag["name"] for tag in document["tags"]}
    for path, _, operation in operations(document):
        assert operation["security"] == ([] if path in OPEN else [{"key": []}]), path
        assert set(operation["tags"]) <= tags, path
        names.append(operation["operationId"])
        summaries.append(operation["summary"])
        assert operation["description"], path
    assert len(set(names)) == len(names)
    assert len(set(summaries)) == len(summaries)
    assert all(re.fullmatch(r"[a-z]+(_[a-z]+)+", name) for name in names), names
    assert document["servers"]
    assert document["info"]["contact"]["name"]


def test_an_operation_has_one_type_of_answer(document: dict[str, Any]) -> None:
    for path, method, operation in operations(document):
        found = {
            str(content["schema"])
            for status, answer in operation["responses"].items()
            for media_type, content in answer.get("content", {}).items()
            if status.startswith("2") and media_type == "application/json"
        }
        assert len(found) <= 1, f"{method} {path}"


def test_no_keyword_is_of_another_version(document: dict[str, Any]) -> None:
    for path, _, operation in operations(document):
        for _, content in contents(operation):
            assert content.keys() <= {"schema", "example", "examples", "encoding"}, path
