"""Schemas in the words that OpenAPI 3.0, which the standard asks for, and JSON Schema 2020-12 share."""

from collections.abc import Mapping
from typing import Any

_LEFT_OUT = frozenset({"x-unit", "discriminator", "propertyNames", "examples", "const", "patternProperties"})
_OF_SCHEMAS = frozenset({"anyOf", "oneOf", "allOf", "items", "not", "additionalProperties"})
_NULL = {"type": "null"}


def shared(schema: Mapping[str, Any]) -> dict[str, Any]:
    """Return a schema of 2020-12 without references so that both dialects read it alike.

    Units remain in the names of fields; where names of properties match one pattern, any name is allowed.
    """
    if schema == _NULL:
        return {"enum": [None]}
    made = {key: _inner(key, value) for key, value in schema.items() if key not in _LEFT_OUT}
    if "const" in schema:
        made["enum"] = [schema["const"]]
    if schema.get("examples"):
        made["example"] = schema["examples"][0]
    for named in schema.get("patternProperties", {}).values():
        made["additionalProperties"] = shared(named)
    return made


def _inner(key: str, value: Any) -> Any:
    if key == "properties":
        return {name: shared(field) for name, field in value.items()}
    if key not in _OF_SCHEMAS or isinstance(value, bool):
        return value
    return [shared(one) for one in value] if isinstance(value, list) else shared(value)
