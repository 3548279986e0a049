"""From the document of a request to the texts of the form, and back; what the form lacks is kept beside it as JSON."""

import json
from collections.abc import Mapping
from typing import Any

from app.pages.lines.line_fields import FormField, form_fields
from app.pages.measures import Units
from app.schemas.faults import BadInput, Fault, parse_json

REST = "rest"
"""The field of the form that holds, as JSON, what has no field of its own."""


def to_texts(document: Mapping[str, Any], units: Units) -> dict[str, str]:
    """Return the texts of the form for a request, in the units of the reader."""
    rest = json.loads(json.dumps(document))
    texts = {}
    for name, field in form_fields().items():
        value = _take(rest, name.split("."), field)
        if value is not None:
            number = isinstance(value, int | float) and not isinstance(value, bool)
            texts[name] = field.entered(value, units) if number else str(value)
    kept = _pruned(rest)
    return {**texts, REST: json.dumps(kept, indent=1, ensure_ascii=False) if kept else ""}


def to_document(texts: Mapping[str, str], units: Units) -> dict[str, Any]:
    """Return the request of the texts of the form; what is no number stays a text, and the schema names its field.

    Raises
    ------
    BadInput
        If what the form keeps as JSON is no object of JSON.
    """
    document = _rest(texts.get(REST, ""))
    for name, field in form_fields().items():
        text = texts.get(name, "").strip()
        if text:
            _put(document, name.split("."), _value(text, field, units))
    document.setdefault("line", {})
    return document


def _rest(text: str) -> dict[str, Any]:
    if not text.strip():
        return {}
    try:
        found = parse_json(text.encode())
    except BadInput as error:
        raise BadInput([Fault(f"/{REST}", fault.code, fault.detail) for fault in error.faults]) from error
    if not isinstance(found, dict):
        raise BadInput([Fault(f"/{REST}", "json_type", "must be an object, such as {}")])
    return found


def _take(document: Any, path: list[str], field: FormField) -> Any:
    """Remove a value from a document and return it, None where it is absent or does not fit a field of the form."""
    part = document
    for name in path[:-1]:
        part = part.get(name) if isinstance(part, dict) else None
    value = part.get(path[-1]) if isinstance(part, dict) else None
    if isinstance(value, dict | list) or value is None or (isinstance(value, str) and field.is_number):
        return None
    del part[path[-1]]
    return value


def _put(document: dict[str, Any], path: list[str], value: Any) -> None:
    part = document
    for name in path[:-1]:
        inner = part.get(name)
        if not isinstance(inner, dict):
            inner = part[name] = {}
        part = inner
    part[path[-1]] = value


def _value(text: str, field: FormField, units: Units) -> Any:
    if not field.is_number:
        return text
    plain = text.replace("\N{MINUS SIGN}", "-").replace("\N{NARROW NO-BREAK SPACE}", "").replace(" ", "")
    if plain.count(",") == 1 and "." not in plain:
        plain = plain.replace(",", ".")
    try:
        number = float(plain)
    except ValueError:
        return text
    if field.row["type"] == "integer" and number.is_integer():
        return int(number)
    unit = field.unit(units)
    if unit.factor == 1.0 and unit.offset == 0.0:
        return number
    return {"value": number, "unit": unit.in_requests}


def _pruned(value: Any) -> Any:
    """Return a document without nulls and without parts that have become empty."""
    if not isinstance(value, dict):
        return value
    kept = {name: _pruned(inner) for name, inner in value.items() if inner is not None}
    return {name: inner for name, inner in kept.items() if inner not in ({}, [])}
