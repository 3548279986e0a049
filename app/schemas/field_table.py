"""The table of input fields, generated from the schemas: name, type, unit, bounds, default and description."""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from pydantic import BaseModel

from app.schemas import JobRequest
from app.schemas.known import KnownLine

_Schema = Mapping[str, Any]


@cache
def input_fields() -> tuple[dict[str, Any], ...]:
    """Return a row for every field of a request, in the order of the document.

    Names are dotted. `[]` marks a list of objects, and `[spacer]` the type of its items to which the field belongs.
    """
    document = JobRequest.model_json_schema(by_alias=True)
    return tuple(_fields("", inlined(document, document["$defs"])))


@cache
def all_fields() -> tuple[dict[str, Any], ...]:
    """Return the rows of `input_fields`, and of the further fields of a line as an engineer knows it."""
    known = ({**row, "name": f"line.{row['name']}"} for row in fields_of(KnownLine))
    rows: dict[str, dict[str, Any]] = {}
    for row in (*input_fields(), *known):
        rows.setdefault(row["name"], row)
    return tuple(rows.values())


@cache
def fields_of(model: type[BaseModel], *, first_form: bool = False) -> tuple[dict[str, Any], ...]:
    """Return a row for every field of a document, as `input_fields` does for a request.

    With `first_form`, of a field that has several forms only the first one counts, so that its rows fit together.
    """
    document = model.model_json_schema(by_alias=True)
    return tuple(_fields("", inlined(document, document["$defs"]), 1 if first_form else None))


def field_names(model: type[BaseModel]) -> list[str]:
    """Return the dotted names of all fields of a document, in its order."""
    return [row["name"] for row in fields_of(model)]


def inlined(node: Any, definitions: Mapping[str, _Schema]) -> Any:
    """Return a schema with every reference replaced by its target."""
    if isinstance(node, list):
        return [inlined(item, definitions) for item in node]
    if not isinstance(node, dict):
        return node
    own = {key: inlined(value, definitions) for key, value in node.items() if key not in {"$ref", "$defs"}}
    if "$ref" not in node:
        return own
    return {**inlined(definitions[node["$ref"].rpartition("/")[2]], definitions), **own}


def _fields(prefix: str, schema: _Schema, forms: int | None = None) -> Iterator[dict[str, Any]]:
    """Yield the rows of an object's fields, each followed by the rows of the inner fields of so many of its forms."""
    for name, field in schema.get("properties", {}).items():
        path = prefix + name
        yield _row(path, field, required=name in schema.get("required", ()))
        for form in _forms(field)[:forms]:
            if form.get("type") == "array":
                for item in _forms(form["items"]):
                    yield from _fields(f"{path}[{_kind(item)}].", item, forms)
            else:
                yield from _fields(f"{path}[{_kind(form)}]." if _kind(form) else f"{path}.", form, forms)


def _kind(form: _Schema) -> str:
    """Return the type name of one of several forms; empty if there is only one form."""
    kind: str = form.get("properties", {}).get("type", {}).get("const", "")
    return kind


def _forms(schema: _Schema) -> list[_Schema]:
    """Return the forms that a schema allows apart from null."""
    several = schema.get("anyOf") or schema.get("oneOf")
    if several is None:
        return [] if schema.get("type") == "null" else [schema]
    return [form for one in several for form in _forms(one)]


def _row(path: str, field: _Schema, *, required: bool) -> dict[str, Any]:
    forms = _forms(field)
    innermost = forms[0]
    while innermost.get("type") == "array":
        innermost = _forms(innermost["items"])[0]
    return {
        "name": path,
        "type": " or ".join(dict.fromkeys(form["type"] for form in forms)),
        "unit": field.get("x-unit"),
        "required": required,
        "nullable": {"type": "null"} in field.get("anyOf", ()),
        "default": field.get("default"),
        "minimum": innermost.get("minimum"),
        "maximum": innermost.get("maximum"),
        "fewest_items": forms[0].get("minItems"),
        "most_items": forms[0].get("maxItems"),
        "choices": innermost.get("enum") or ([innermost["const"]] if "const" in innermost else None),
        "description": field["description"],
        "example": next(iter(field.get("examples", ())), None),
    }
