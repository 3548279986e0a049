"""The ids that link a request, its jobs and every log line about them.

A context variable holds them. Code that serves a request or runs a job can read them in its own thread or task, and in
those that it starts with a copy of its context.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from opentelemetry.trace import get_current_span
from uuid_utils import uuid7

LONGEST_REQUEST_ID = 128
TRACE_PARENT_LENGTH = 55

_REQUEST_ID = re.compile(rf"[A-Za-z0-9._:/+=@-]{{1,{LONGEST_REQUEST_ID}}}")
_TRACE_PARENT = re.compile(r"(?!ff)[0-9a-f]{2}-(?!0{32})[0-9a-f]{32}-(?!0{16})[0-9a-f]{16}-[0-9a-f]{2}")


@dataclass(frozen=True, slots=True)
class Ids:
    """The ids of the current work: a request and, in a worker, its job.

    `trace_parent` identifies the caller's span in the format of W3C Trace Context.
    """

    request_id: str | None = None
    trace_parent: str | None = None
    job_id: str | None = None
    attempt: int | None = None

    @property
    def trace_id(self) -> str | None:
        """Return the id of the trace that the request belongs to."""
        return self.trace_parent.split("-")[1] if self.trace_parent else None


_NONE = Ids()
_current: ContextVar[Ids] = ContextVar("ids", default=_NONE)


def current() -> Ids:
    """Return the ids of the current work; all are None outside requests and jobs."""
    return _current.get()


def request_id() -> str | None:
    """Return the id of the current request, or of the request that created the current job."""
    return _current.get().request_id


def trace_parent() -> str | None:
    """Return the current span: OpenTelemetry's if tracing is on, otherwise the caller's."""
    span = get_current_span().get_span_context()
    if span.is_valid:
        return f"00-{span.trace_id:032x}-{span.span_id:016x}-{span.trace_flags:02x}"
    return _current.get().trace_parent


def trace_id() -> str | None:
    """Return the id of the trace that the current work belongs to."""
    parent = trace_parent()
    return parent.split("-")[1] if parent else None


def of_this_work() -> Ids:
    """Return the ids to store with a job that this request creates."""
    return Ids(request_id(), trace_parent())


@contextmanager
def bound(ids: Ids) -> Iterator[None]:
    """Set the ids for the enclosed code, then restore the previous ones."""
    token = _current.set(ids)
    try:
        yield
    finally:
        _current.reset(token)


def of_request(given_id: str | None, given_parent: str | None) -> Ids:
    """Return the ids of a request from its headers X-Request-ID and traceparent; replace an id that is not acceptable.

    An id is limited in length and characters because it goes into headers, logs and the database unchanged.
    """
    kept = given_id if given_id and _REQUEST_ID.fullmatch(given_id) else str(uuid7())
    return Ids(kept, given_parent if given_parent and _TRACE_PARENT.fullmatch(given_parent) else None)
