"""Conditional requests: strong entity tags and 304 answers (RFC 9110, sections 8.8.3 and 13.1.2)."""

import hashlib

from starlette.exceptions import HTTPException

from app.convert import ENGINE_VERSION


class Bodiless(HTTPException):
    """Raised by a route to answer with a status and headers only."""


def strong_tag(*parts: object) -> str:
    """Return the entity tag for content determined by these parts and by the version of the service."""
    text = "\0".join(map(str, (ENGINE_VERSION, *parts)))
    return f'"{hashlib.sha256(text.encode()).hexdigest()[:32]}"'


def unless_known(known: str, tag: str) -> dict[str, str]:
    """Return the headers of an answer with this tag; the client may cache it but must revalidate it.

    Raises
    ------
    Bodiless
        304 if the tag is in `known`, the value of the If-None-Match header.
    """
    headers = {"ETag": tag, "Cache-Control": "private, no-cache", "Vary": "Accept, Authorization"}
    tags = {text.strip().removeprefix("W/") for text in known.split(",")}
    if tag in tags or "*" in tags:
        raise Bodiless(304, headers=headers)
    return headers
