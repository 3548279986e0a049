"""Fill what a line of a batch leaves open: from its coordinates, then from the defaults of the batch."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from app.schemas import Line
from app.schemas.faults import BadInput, Fault, json_pointer
from app.schemas.known import KnownLine
from app.sheets.columns import Computed

_OWN = frozenset({"name", "asset_id", "reference"})
_CLIMATE = "climate"


def checked_defaults(given: object) -> dict[str, Any]:
    """Return the defaults of a batch; null means that there are none.

    Raises
    ------
    BadInput
        If they are no object, or name what no line has or what belongs to one line.
    """
    if given is None:
        return {}
    if not isinstance(given, dict):
        raise BadInput([Fault("/defaults", "not_an_object", "must be an object with fields of a line")])
    known = {field.alias or name for model in (Line, KnownLine) for name, field in model.model_fields.items()}
    faults = [
        Fault(json_pointer(["defaults", name]), *_why(name)) for name in given if name in _OWN or name not in known
    ]
    if faults:
        raise BadInput(faults)
    return given


def _why(name: str) -> tuple[str, str]:
    if name in _OWN:
        return "not_a_default", "belongs to one line, so it has no default"
    return "unknown_field", "unknown field: defaults have the fields of a line"


def filled(
    document: Mapping[str, Any], computed: Sequence[Computed], defaults: Mapping[str, Any]
) -> tuple[dict[str, Any], list[Computed]]:
    """Return the fields of a line with what it leaves open, and those computed values that it took.

    Its own fields win over computed ones, these over defaults. The direction of the line goes into a climate only.
    """
    if not computed and not defaults:
        return dict(document), []
    taken = [value for value in computed if _is_wanted(value, document, defaults)]
    whole = merged(merged(defaults, _as_document(taken)), document)
    return whole, taken


def merged(under: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Return two documents as one; where both have an object it is merged, otherwise the second wins."""
    found = dict(under)
    for name, value in over.items():
        before = found.get(name)
        found[name] = merged(before, value) if isinstance(before, dict) and isinstance(value, dict) else value
    return found


def _is_wanted(value: Computed, document: Mapping[str, Any], defaults: Mapping[str, Any]) -> bool:
    part, name = value.path
    own = document.get(part)
    if part in document and not isinstance(own, dict):
        return False
    if isinstance(own, dict) and own.get(name) is not None:
        return False
    return part != _CLIMATE or isinstance(own, dict) or isinstance(defaults.get(part), dict)


def _as_document(computed: Iterable[Computed]) -> dict[str, Any]:
    document: dict[str, Any] = {}
    for value in computed:
        part, name = value.path
        document.setdefault(part, {})[name] = value.value
    return document
