"""Tell a line that was posted without its wrapper from a document with faults."""

from typing import Any

from app.schemas.faults import Fault

_MARKS = frozenset({"conductor", "span", "bundle", "ice"})


def without_wrapper(document: Any, wrapper: str) -> Fault | None:
    """Return the fault of a document that is a line, or a list of lines, instead of an object with them.

    `wrapper` shows what such an object looks like: `{"line": <the line>, ...}`.
    """
    if _is_line(document):
        return Fault("", "missing_wrapper", f"this is a line by itself; post {wrapper}")
    if isinstance(document, list) and document and all(map(_is_line, document[:10])):
        return Fault("", "missing_wrapper", f"this is a list of lines by itself; post {wrapper}")
    return None


def _is_line(document: Any) -> bool:
    return isinstance(document, dict) and "line" not in document and len(_MARKS & document.keys()) >= 2
