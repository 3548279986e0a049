"""Read the forms that browsers post, and check that a page of this service sent them."""

import re
from typing import Annotated
from urllib.parse import unquote_to_bytes

from fastapi import Depends, Request

from app.http.beside_loop import QUICK_BYTES, beside_loop_if_large, mark_large
from app.http.problems import ProblemError, ProblemKind
from app.pages.frame import check_form

_MEDIA_TYPE = "application/x-www-form-urlencoded"
_MOST_FIELDS = 10_000  # the form of a line has as many rows as a line may have devices, and each some fields
_PIECE = re.compile(rb"(?:[^%]|%(?:[0-9A-Fa-f]{2})?){1,50000}")


async def _fields(request: Request) -> dict[str, str]:
    """Return the fields of a posted form; the last one of several alike.

    Raises
    ------
    ProblemError
        415 if it is no form, 400 if it cannot be read, 403 if it does not come from a page that the caller read.
    """
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type != _MEDIA_TYPE:
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, f"The body is not {_MEDIA_TYPE}.")
    body = await request.body()
    if len(body) > QUICK_BYTES:
        mark_large(request)
    try:
        fields = await beside_loop_if_large(request, lambda: _parsed(body))
    except ValueError as error:
        raise ProblemError(ProblemKind.INVALID_PARAMETER, f"The form cannot be read: {error}.") from error
    check_form(request, fields)
    return fields


def _parsed(body: bytes) -> dict[str, str]:
    parts = body.split(b"&", _MOST_FIELDS)
    if len(parts) > _MOST_FIELDS:
        raise ValueError(f"it has more than {_MOST_FIELDS} fields")
    fields = (part.partition(b"=") for part in parts if part)
    return {_unquoted(name): _unquoted(value) for name, _, value in fields}


def _unquoted(text: bytes) -> str:
    """Return a text without escapes, made piece by piece: in one piece a long one would hold up the event loop."""
    pieces = _PIECE.finditer(text.replace(b"+", b" "))
    return b"".join(unquote_to_bytes(piece[0]) for piece in pieces).decode()


Fields = Annotated[dict[str, str], Depends(_fields)]


def local_path(text: str) -> str:
    """Return a path of this service to go back to; the start page for anything that leads elsewhere."""
    safe = text.startswith("/") and not text.startswith(("//", "/\\")) and text.isprintable()
    return text if safe else "/"
