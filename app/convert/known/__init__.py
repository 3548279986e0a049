"""Lines as engineers know them, to the engine and back to an explicit document; numerics are loaded with the first."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from app.convert.known.forms import is_known_form
from app.convert.known.own_rows import OwnRows
from app.schemas import JobRequest, Line
from app.schemas.faults import BadInput, Fault, faults_of
from app.schemas.known import KnownLine

if TYPE_CHECKING:
    from engine.known.description import KnownLine as EngineLine

__all__ = [
    "OwnRows",
    "explicit_line",
    "explicit_request",
    "is_known_form",
    "is_known_request",
    "known_of",
    "resolve_document",
    "resolve_line",
]

_NO_OWN_ROWS = OwnRows()


def explicit_line(line: Any, own: OwnRows = _NO_OWN_ROWS) -> tuple[Any, dict[str, Any] | None]:
    """Return a line document as it is, or resolved if it has a form that the explicit line has not.

    Returns
    -------
    line : any
        Whoever reads it checks it as a whole.
    known : dict or None
        What was said of a line that was resolved, with the own rows that it names.

    Raises
    ------
    BadInput
        With every fault of the forms and of the parts.
    """
    if not is_known_form(line):
        return line, None
    from app.convert.known.to_document import explicit_document  # noqa: PLC0415 - the API needs no numerics to start

    return explicit_document(_known_line(line), own), {"line": line, **own.named_in(line)}


def explicit_request(document: Any, own: OwnRows = _NO_OWN_ROWS) -> Any:
    """Return a request document whose line is explicit, with what was said of it as `known`.

    A request that says `known` itself, because it was sent back, must say the line that follows from it.

    Raises
    ------
    BadInput
        As in `resolve_document`, with pointers from the root of the request; or if `known` and line differ.
    """
    if not is_known_request(document):
        return document
    if not is_known_form(document.get("line")):
        return _checked(document)
    line = document["line"]
    try:
        explicit = resolve_document(line, own)["line"]
    except BadInput as error:
        raise BadInput([Fault(f"/line{f.pointer}", f.code, f.detail) for f in error.faults]) from error
    return {**document, "line": explicit, "known": {"line": line, **own.named_in(line)}}


def is_known_request(document: object) -> bool:
    """Tell whether a request document has a line in such a form, or says how its line is known."""
    return isinstance(document, dict) and (is_known_form(document.get("line")) or document.get("known") is not None)


def _checked(document: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a request whose line is the one that follows from its `known`."""
    try:
        line, own = _read(document["known"])
        explicit = resolve_line(line, own)["line"]
    except (BadInput, ValidationError, LookupError, TypeError) as error:
        rule = "must be what a result gave back, or absent; give the line as you know it in `line`"
        raise BadInput([Fault("/known", "known", rule)]) from error
    if _explicit(document.get("line")) != _explicit(explicit):
        raise BadInput([Fault("/known", "known", "must be absent where the line was changed: they are not the same")])
    return document


def _explicit(line: object) -> Line | None:
    try:
        return Line.model_validate(line)
    except ValidationError:
        return None


def _read(known: Mapping[str, Any]) -> tuple[KnownLine, OwnRows]:
    return KnownLine.model_validate(known["line"]), OwnRows.of(known)


def known_of(request: JobRequest) -> "EngineLine | None":
    """Return the engine's line of what is known, from a request that was resolved; None for an explicit one."""
    return None if request.known is None else known_of_document(request.known)


def known_of_document(known: Mapping[str, Any]) -> "EngineLine":
    """Return the engine's line of what is known, from a document that `explicit_line` gave."""
    from app.convert.known.to_engine import known_line  # noqa: PLC0415 - the API needs no numerics to start

    return known_line(*_read(known))


def resolve_document(document: object, own: OwnRows = _NO_OWN_ROWS) -> dict[str, Any]:
    """Check a line document in any of its forms, and resolve it.

    Raises
    ------
    BadInput
        With every fault of the schema, else as in `resolve_line`.
    """
    return resolve_line(_known_line(document), own)


def _known_line(document: object) -> KnownLine:
    try:
        return KnownLine.model_validate(document)
    except ValidationError as error:
        raise BadInput(faults_of(error.errors(include_url=False))) from error


def resolve_line(line: KnownLine, own: OwnRows = _NO_OWN_ROWS) -> dict[str, Any]:
    """Return the explicit line of what is known, as `app.convert.known.to_document` says.

    Raises
    ------
    BadInput
        With every fault of the parts, or of the line as a whole.
    """
    from app.convert.known.to_document import resolved_document  # noqa: PLC0415 - the API needs no numerics to start

    return resolved_document(line, own)
