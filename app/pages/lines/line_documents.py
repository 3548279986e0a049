"""From the document of a request to the texts of the form, and back; what the form lacks is kept beside it as JSON."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from app.pages.lines.line_fields import FormField, form_fields
from app.pages.lines.numbers import as_number
from app.pages.lines.row_lists import KIND, REST, RowList, row_lists
from app.pages.lines.rows import Row, kind_of, rows_in
from app.pages.measures import Units
from app.pages.wording import words
from app.schemas.faults import BadInput, Fault, parse_json
from app.schemas.units import in_unit


def to_texts(document: Mapping[str, Any], units: Units) -> dict[str, str]:
    """Return the texts of the form for a request, in the units of the reader."""
    rest = json.loads(json.dumps(document))
    texts: dict[str, str] = {}
    for row_list in row_lists().values():
        texts |= _row_texts(rest, row_list, units)
    for name, field in form_fields().items():
        text = _taken(rest, name.split("."), field, units)
        if text is not None:
            texts[name] = text
    return {**texts, REST: _json(_without_nulls(rest))}


def to_document(texts: Mapping[str, str], units: Units) -> dict[str, Any]:
    """Return the request of the texts of the form; what is no number stays a text, and the schema names its field.

    Raises
    ------
    BadInput
        If what the form or a row keeps as JSON is no object of JSON, or says again what has rows.
    """
    document = _object(texts.get(REST, ""), REST)
    for name, rows in rows_in(texts).items():
        if rows:
            row_list = row_lists()[name]
            items = [_item(row_list, number, row, units) for number, row in enumerate(rows)]
            _put(document, name.split("."), items, f"/{REST}")
    for name, field in form_fields().items():
        text = texts.get(name, "").strip()
        if text:
            length = field.row["most_items"] or 0
            _put(document, name.split("."), _value(text, field, units), field.pointer, length)
    document.setdefault("line", {})
    return document


def _row_texts(rest: dict[str, Any], row_list: RowList, units: Units) -> dict[str, str]:
    """Remove a list from a document and return the texts of its rows; none, if it is no list that rows can show."""
    path = row_list.name.split(".")
    items = _part(rest, path)
    if not isinstance(items, list) or len(items) > row_list.most_rows or not _are_rows(items, row_list):
        return {}
    texts: dict[str, str] = {}
    for number, item in enumerate(items):
        texts |= _item_texts(item, row_list, number, units)
    _remove(rest, path)
    return texts


def _are_rows(items: Sequence[Any], row_list: RowList) -> bool:
    if row_list.is_plain:
        return all(_is_value(_in_own_unit(item, row_list.kinds[""].fields[0]), number=True) for item in items)
    kinds = [item.get(KIND, "") if isinstance(item, dict) else None for item in items]
    return all(isinstance(kind, str) and kind in row_list.kinds for kind in kinds)


def _item_texts(item: Any, row_list: RowList, number: int, units: Units) -> dict[str, str]:
    kind = item.pop(KIND) if row_list.has_kinds else ""
    texts = {row_list.field_name(number, KIND): kind} if row_list.has_kinds else {}
    holder = {"": item} if row_list.is_plain else item
    for field in row_list.kinds[kind].fields:
        text = _taken(holder, field.name.split("."), field, units)
        if text is not None:
            texts[row_list.field_name(number, field.name)] = text
    kept = "" if row_list.is_plain else _json(_without_nulls(item))
    return texts | ({row_list.field_name(number, REST): kept} if kept or not texts else {})


def _taken(document: Any, path: Sequence[str], field: FormField, units: Units) -> str | None:
    """Take a value out of a document and return its text, None where it is absent or does not fit a field."""
    *before, last = path
    part = _part(document, before)
    if isinstance(part, list):
        inside = last.isdecimal() and int(last) < len(part) == field.row["most_items"]
        value = part[int(last)] if inside else None
    else:
        value = part.get(last) if isinstance(part, dict) else None
    value = _in_own_unit(value, field)
    if not _is_value(value, number=field.is_number):
        return None
    _remove(document, path)
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return field.entered(value, units) if number else str(value)


def _in_own_unit(value: Any, field: FormField) -> Any:
    """Return a number that comes with a unit in that of its field, everything else as it is."""
    return in_unit(value, field.row["unit"]) if isinstance(value, dict) and field.row["unit"] else value


def _is_value(value: Any, *, number: bool) -> bool:
    return isinstance(value, int | float) or (isinstance(value, str) and not number)


def _part(document: Any, path: Sequence[str]) -> Any:
    """Return what lies at a path in a document, None if there is nothing."""
    for name in path:
        document = document.get(name) if isinstance(document, dict) else None
    return document


def _item(row_list: RowList, number: int, row: Row, units: Units) -> Any:
    """Return the item of a list that a row says."""
    kind = kind_of(row_list, row)
    if row_list.is_plain:
        return _value(row.get("", "").strip(), row_list.kinds[""].fields[0], units)
    item = _object(row.get(REST, ""), row_list.field_name(number, REST))
    if row_list.has_kinds:
        item[KIND] = kind
    for field in row_list.kinds[kind].fields if kind in row_list.kinds else ():
        text = row.get(field.name, "").strip()
        if text:
            pointer = "/" + row_list.field_name(number, field.name).replace(".", "/")
            _put(item, field.name.split("."), _value(text, field, units), pointer, field.row["most_items"] or 0)
    return item


def _put(document: dict[str, Any], path: Sequence[str], value: Any, pointer: str, length: int = 0) -> None:
    """Put a value at a path in a document, whose last part may be the number of an item of a list of fixed length.

    Raises
    ------
    BadInput
        If what lies there already is a list, with the pointer of the field that says the value.
    """
    *before, last = path
    listed = last.isdecimal()
    for name in before[:-1] if listed else before:
        inner = document.setdefault(name, {})
        if isinstance(inner, list):
            raise BadInput([Fault(pointer, "exclusive", words().line.listed_already.format(name=name))])
        if not isinstance(inner, dict):
            inner = document[name] = {}
        document = inner
    if listed:
        held = document.get(before[-1])
        if not isinstance(held, list) or len(held) != length:
            held = document[before[-1]] = [""] * length
        held[int(last)] = value
    elif isinstance(value, list) and document.get(last):
        raise BadInput([Fault(pointer, "exclusive", words().line.said_twice.format(name=".".join(path)))])
    else:
        document[last] = value


def _value(text: str, field: FormField, units: Units) -> Any:
    number = as_number(text) if field.is_number else None
    if number is None:
        return text
    if field.row["type"] == "integer" and number.is_integer():
        return int(number)
    unit = field.unit(units)
    if unit.factor == 1.0 and unit.offset == 0.0:
        return number
    return {"value": number, "unit": unit.in_requests}


def _object(text: str, name: str) -> dict[str, Any]:
    """Return what a field of the form keeps as JSON."""
    if not text.strip():
        return {}
    pointer = "/" + name.replace(".", "/")
    try:
        found = parse_json(text.encode())
    except BadInput as error:
        raise BadInput([Fault(pointer, fault.code, fault.detail) for fault in error.faults]) from error
    if not isinstance(found, dict):
        raise BadInput([Fault(pointer, "json_type", words().line.not_an_object)])
    return found


def _json(kept: Any) -> str:
    return json.dumps(kept, indent=1, ensure_ascii=False) if kept else ""


def _remove(document: Any, path: Sequence[str]) -> None:
    """Remove what lies at a path in a document, with the parts that become empty by that; an item of a list is null."""
    *before, last = path
    part = _part(document, before)
    if isinstance(part, list):
        part[int(last)] = None
        empty = all(item is None for item in part)
    else:
        del part[last]
        empty = not part
    if empty and before:
        _remove(document, before)


def _without_nulls(value: Any) -> Any:
    """Return a document without nulls, which say nothing; an empty object or list may say something."""
    if not isinstance(value, dict):
        return value
    return {name: _without_nulls(inner) for name, inner in value.items() if inner is not None}
