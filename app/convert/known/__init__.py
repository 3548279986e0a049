"""Lines as engineers know them, to the engine and back to an explicit document; numerics are loaded with the first."""

from typing import Any

from pydantic import ValidationError

from app.convert.known.own_rows import OwnRows
from app.schemas.faults import BadInput, faults_of
from app.schemas.known import KnownLine

__all__ = ["OwnRows", "resolve_document", "resolve_line"]

_NO_OWN_ROWS = OwnRows()


def resolve_document(document: object, own: OwnRows = _NO_OWN_ROWS) -> dict[str, Any]:
    """Check a line document in any of its forms, and resolve it.

    Raises
    ------
    BadInput
        With every fault of the schema, else as in `resolve_line`.
    """
    try:
        line = KnownLine.model_validate(document)
    except ValidationError as error:
        raise BadInput(faults_of(error.errors(include_url=False))) from error
    return resolve_line(line, own)


def resolve_line(line: KnownLine, own: OwnRows = _NO_OWN_ROWS) -> dict[str, Any]:
    """Return the explicit line of what is known, as `app.convert.known.to_document` says.

    Raises
    ------
    BadInput
        With every fault of the parts, or of the line as a whole.
    """
    from app.convert.known.to_document import resolved_document  # noqa: PLC0415 - the API needs no numerics to start

    return resolved_document(line, own)
