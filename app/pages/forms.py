"""Read the forms that browsers post, and check that a page of this service sent them."""

from typing import Annotated
from urllib.parse import parse_qsl

from fastapi import Depends, Request

from app.http.problems import ProblemError, ProblemKind
from app.pages.frame import check_form

_MEDIA_TYPE = "application/x-www-form-urlencoded"
_MOST_FIELDS = 10_000  # the form of a line has as many rows as a line may have devices, and each some fields


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
    try:
        text = (await request.body()).decode()
        fields = dict(parse_qsl(text, keep_blank_values=True, max_num_fields=_MOST_FIELDS, errors="strict"))
    except ValueError as error:
        raise ProblemError(ProblemKind.INVALID_PARAMETER, f"The form cannot be read: {error}.") from error
    check_form(request, fields)
    return fields


Fields = Annotated[dict[str, str], Depends(_fields)]


def local_path(text: str) -> str:
    """Return a path of this service to go back to; the start page for anything that leads elsewhere."""
    safe = text.startswith("/") and not text.startswith(("//", "/\\")) and text.isprintable()
    return text if safe else "/"
