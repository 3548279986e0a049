"""Finish the document that FastAPI writes: what it cannot declare, and what generators stumble over."""

from collections.abc import Iterator
from typing import Any

from app.http.problems import ProblemKind
from app.openapi.line_forms import with_both_forms
from app.routes import documentation
from app.schemas.fields import with_nulls
from app.security.gate import is_open

_UNTYPED = frozenset({"validate_only"})  # generators give an operation one type of answer: that of `.../estimate`
_LITERAL = frozenset({"example", "examples", "default", "enum", "const"})  # values, which are no schemas


def finished(document: dict[str, Any]) -> dict[str, Any]:
    """Return the document with nulls in its examples, problems, security and both forms of a line, for OpenAPI 3.1."""
    document = with_both_forms(with_nulls(document))
    document["components"]["securitySchemes"] = {"key": _KEY}
    for path, _, operation in operations(document):
        operation["responses"]["default"] = documentation.ANY_PROBLEM_AS_SENT
        operation["security"] = [] if is_open(path) else [{"key": []}]
        if not is_open(path):
            operation["responses"] |= _REFUSALS
        given = operation.get("parameters", [])
        operation["parameters"] = [parameter for parameter in given if parameter["name"] not in _UNTYPED]
        for answer in operation["responses"].values():
            for content in answer.get("content", {}).values():
                content.pop("itemSchema", None)  # a keyword of OpenAPI 3.2
    _drop_titles(document)
    return document


def operations(document: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield path, method and content of every operation."""
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            yield path, method, operation


_KEY = {
    "type": "http",
    "scheme": "bearer",
    "description": "A key from `galloping keys create`; not needed while no key exists",
}
_REFUSALS = {
    str(status): answer
    for status, answer in documentation.problems(
        ProblemKind.UNAUTHENTICATED, ProblemKind.FORBIDDEN, ProblemKind.TOO_MANY_REQUESTS
    ).items()
}


def _drop_titles(node: Any) -> None:
    """Remove the titles of fields and parameters, which repeat their names.

    Generators name a class after the title of a field, so that the field `den_hartog` would refer to itself.
    """
    if isinstance(node, list):
        for item in node:
            _drop_titles(item)
    if not isinstance(node, dict):
        return
    fields = node.get("properties")
    named = [*fields.values()] if isinstance(fields, dict) else []
    if "in" in node and "schema" in node:
        named.append(node["schema"])
    for schema in named:
        if isinstance(schema, dict) and isinstance(schema.get("title"), str):
            del schema["title"]
    for name, inner in node.items():
        if name not in _LITERAL:
            _drop_titles(inner)
