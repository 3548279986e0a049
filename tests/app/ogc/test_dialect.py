"""Schemas that OpenAPI 3.0 and JSON Schema 2020-12 read alike."""

from typing import Any

import pytest
from jsonschema import Draft202012Validator
from openapi_schema_validator import OAS30Validator
from openapi_spec_validator import OpenAPIV30SpecValidator

from app.ogc.descriptions import description
from app.ogc.dialect import shared
from app.routes.own_documentation import KNOWN_LINE
from tests.documents import short_request

TAGS = {
    "type": "object",
    "additionalProperties": False,
    "patternProperties": {"^[a-z]+$": {"type": "string", "const": "north"}},
    "propertyNames": {"maxLength": 64},
}
FIELDS = {
    "type": "object",
    "properties": {
        "const": {"anyOf": [{"type": "number", "minimum": 0.0, "x-unit": "m"}, {"type": "null"}], "examples": [2.5]},
        "kinds": {"type": "array", "items": {"const": "spacer", "title": "Kind"}},
        "tags": TAGS,
    },
}


def test_words_of_one_dialect_alone_are_said_in_those_of_both() -> None:
    assert shared(FIELDS)["properties"] == {
        "const": {"anyOf": [{"type": "number", "minimum": 0.0}, {"enum": [None]}], "example": 2.5},
        "kinds": {"type": "array", "items": {"enum": ["spacer"], "title": "Kind"}},
        "tags": {"type": "object", "additionalProperties": {"type": "string", "enum": ["north"]}},
    }


@pytest.mark.parametrize("dialect", [Draft202012Validator, OAS30Validator])
def test_both_dialects_accept_and_refuse_the_same(dialect: Any) -> None:
    validator = dialect(shared(FIELDS))
    assert validator.is_valid({"const": None, "kinds": ["spacer"], "tags": {"region": "north"}})
    for wrong in ({"const": -1.0}, {"const": "1"}, {"kinds": ["damper"]}, {"tags": {"region": "south"}}):
        assert not validator.is_valid(wrong), wrong


def test_every_schema_of_the_description_is_one_of_openapi_3_0() -> None:
    described = description()
    schemas = {name: put["schema"] for name, put in {**described["inputs"], **described["outputs"]}.items()}
    # `contentMediaType` is a word of the standard beside those of OpenAPI.
    schemas["result"] = {k: v for k, v in schemas["result"].items() if k != "contentMediaType"}
    about = {"openapi": "3.0.3", "info": {"title": "Galloping", "version": "1"}, "paths": {}}
    document = {**about, "components": {"schemas": schemas}}
    assert [error.message for error in OpenAPIV30SpecValidator(document).iter_errors()] == []
    assert "x-unit" not in str(schemas)
    for line in (short_request()["line"], KNOWN_LINE):
        assert OAS30Validator(schemas["line"]).is_valid(line)
    assert not OAS30Validator(schemas["line"]).is_valid({**short_request()["line"], "span": {"length_m": -1.0}})
