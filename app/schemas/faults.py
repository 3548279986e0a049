"""Faults of a request: the place in the document, a code and a sentence. All are collected before any is reported."""

import codecs
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from pydantic_core import from_json

from app.schemas.meant import meant
from app.schemas.units import WrongUnit

MOST_FAULTS = 1000
MOST_VALUES = 200_000
"""Values of a JSON text, told by the marks between them; a measured table of 10,000 rows has 50,000."""
MOST_NAMES = 50_000
"""Names in a JSON text, told by the colons behind them."""
MOST_ESCAPES = 500_000
"""Backslashes in a JSON text; a document has one now and then."""
_MOST_MEMBERS = 1000  # names of one object; the largest of a document has some 50
_MOST_SUGGESTED = 50  # each looks through all names of fields
_MOST_CHARACTERS = 200
_MOST_SHOWN = 80

# pydantic adds the name of a tagged union's branch to the location, after the field or the list item.
_SPEEDS, _DEVICE, _AERODYNAMICS = "wind_speeds_m_per_s", "device", "aerodynamics"
_LISTS = ("devices", "tried")
_FORMS = frozenset({"list", "range", "coefficients", "measured", "named"})


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault: JSON pointer (RFC 6901) to the field, a code for programs, and a sentence for people."""

    pointer: str
    code: str
    detail: str

    def __str__(self) -> str:
        """Return the place and the sentence."""
        return f"{self.pointer or '/'}: {self.detail}"


class BadInput(ValueError):
    """Raised when a document is not valid; `faults` holds all its faults."""

    def __init__(self, faults: Sequence[Fault]) -> None:
        """Take at least one fault."""
        self.faults = tuple(faults)
        super().__init__("; ".join(str(fault) for fault in self.faults))


class BodyTooLarge(Exception):
    """Raised when a body, or one line of it, is too large; the text names it and the limit."""


def parse_json(raw: bytes) -> Any:
    """Return the value of a JSON text; NaN and infinities pass, and the schema then names their fields.

    A byte order mark is passed over, and a text that begins with that of UTF-16, as PowerShell writes it, is read so.

    Raises
    ------
    BadInput
        If the text is not JSON, neither UTF-8 nor UTF-16, nested too deeply, has more than `MOST_VALUES` values,
        `MOST_NAMES` names or `MOST_ESCAPES` escapes, or an object repeats a name.
    """
    try:
        raw = _in_utf8(raw)
        _check_size(raw)
        value = from_json(raw)
        repeated = list(islice(_repeated_names(raw.decode()), MOST_FAULTS))
    except BadInput:
        raise
    except ValueError as error:
        raise BadInput([Fault("", "json_invalid", f"not valid JSON: {error}")]) from error
    if repeated:
        raise BadInput(repeated)
    return value


def _check_size(raw: bytes) -> None:
    """Refuse a text whose values alone would cost; counting its bytes costs a thousandth of reading them."""
    bounds: tuple[tuple[int, str, tuple[bytes, ...]], ...] = (
        (MOST_VALUES, "values", (b",", b"[", b"{")),
        (MOST_NAMES, "names", (b":",)),
        (MOST_ESCAPES, "escapes", (b"\\",)),
    )
    for most, what, marks in bounds:
        found = sum(map(raw.count, marks))
        if found > most:
            raise BadInput([Fault("", "too_many", f"has some {found} {what}; a document may have at most {most}")])


def _in_utf8(raw: bytes) -> bytes:
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return raw.decode("utf-16").encode()
    if b"\0" in raw[:4]:
        raise ValueError("the text has zero bytes, like UTF-16 without a byte order mark; save it as UTF-8")
    return raw.removeprefix(codecs.BOM_UTF8)


@dataclass(frozen=True, slots=True)
class _Members:
    """The members of a JSON object as the text lists them."""

    pairs: Sequence[tuple[str, Any]]


def _repeated_names(text: str) -> Iterator[Fault]:
    """Yield a fault for every repeated name in an object, because its meaning would be ambiguous."""
    unique = True

    def note(pairs: Sequence[tuple[str, Any]]) -> None:
        nonlocal unique
        unique = unique and len(dict(pairs)) == len(pairs)
        if len(pairs) > _MOST_MEMBERS:
            detail = f"an object has {len(pairs)} names, the first of them {pairs[0][0][:_MOST_SHOWN]!r}"
            raise BadInput([Fault("", "too_many", f"{detail}; it may have at most {_MOST_MEMBERS}")])

    json.loads(text, object_pairs_hook=note, parse_int=str, parse_float=str)
    if not unique:
        yield from _repetitions(json.loads(text, object_pairs_hook=_Members, parse_int=str, parse_float=str), [])


def _repetitions(node: Any, path: Sequence[object]) -> Iterator[Fault]:
    pairs = node.pairs if isinstance(node, _Members) else enumerate(node) if isinstance(node, list) else ()
    seen: set[object] = set()
    for name, value in pairs:
        if name in seen:
            yield Fault(json_pointer([*path, name]), "repeated_name", "appears more than once in its object")
        seen.add(name)
        yield from _repetitions(value, [*path, name])


def json_pointer(tokens: Iterable[object]) -> str:
    """Join tokens to a JSON pointer; shorten tokens that are too long."""
    texts = (str(token)[:_MOST_CHARACTERS] for token in tokens)
    return "".join("/" + text.replace("~", "~0").replace("/", "~1") for text in texts)


def faults_of(errors: Iterable[Mapping[str, Any]], *, skip: int = 0, root: str = "") -> list[Fault]:
    """Convert pydantic's errors to faults that show the value found, if the errors contain it.

    One more than `MOST_FAULTS` are converted at most, which tells that there are more.

    Parameters
    ----------
    errors : iterable of mappings
    skip : int
        Number of tokens to drop from the beginning of each location.
    root : str
        Beginning of every pointer.
    """
    taken = enumerate(islice(errors, MOST_FAULTS + 1))
    return [_fault(error, error["loc"][skip:], root, suggests=place < _MOST_SUGGESTED) for place, error in taken]


def _fault(error: Mapping[str, Any], location: Sequence[int | str], root: str, *, suggests: bool) -> Fault:
    if location[-1:] == ("[key]",) and location[-2:-1] == (error.get("input"),):
        location = location[:-1]  # the name of a member is at fault: pydantic puts this word behind it
    tokens = [token for i, token in enumerate(location) if not _is_branch(location, i)]
    if error["type"] == "union_tag_not_found":
        tokens.append("type")
    code, detail = _wording(error)
    if code == "unknown_field" and suggests:
        detail += meant([*root.split("/")[1:], *tokens])
    return Fault(root + json_pointer(tokens), code, detail[: 2 * _MOST_CHARACTERS] + _found(error))


def _is_branch(location: Sequence[int | str], place: int) -> bool:
    *before, owner = (None, None, *location[:place])[-2:]
    if owner in {_SPEEDS, _AERODYNAMICS}:
        return location[place] in _FORMS
    return owner == _DEVICE or (before in [[name] for name in _LISTS] and isinstance(owner, int))


def _found(error: Mapping[str, Any]) -> str:
    """Return the wrong value as short JSON; empty for objects and lists, and if the field's name is wrong."""
    value = error.get("ctx", {}).get("tag") if error["type"] == "union_tag_invalid" else error.get("input", ...)
    if error["type"] in {"extra_forbidden", "missing"} or not isinstance(value, str | int | float | None):
        return ""
    if isinstance(value, str):
        value = value[:_MOST_SHOWN]
    if isinstance(value, int) and abs(value) >= 10**_MOST_SHOWN:
        return f", got a whole number of more than {_MOST_SHOWN} digits"
    return f", got {json.dumps(value, ensure_ascii=False)[:_MOST_SHOWN]}"


def _wording(error: Mapping[str, Any]) -> tuple[str, str]:
    code, detail = str(error["type"]), str(error["msg"])
    if isinstance(error.get("input"), WrongUnit):
        return "unit", error["input"].sentence
    if code == "extra_forbidden":
        return "unknown_field", "unknown field"
    if code in {"union_tag_not_found", "union_tag_invalid"}:
        *others, last = str(error.get("ctx", {}).get("expected_tags", "a kind of device")).replace("'", "").split(", ")
        return "unknown_type", f"type must be {', '.join(others)} or {last}" if others else f"type must be {last}"
    if code in {"model_type", "model_attributes_type", "dict_type"}:
        return "not_an_object", "must be an object"
    return code, detail[:1].lower() + detail[1:]
