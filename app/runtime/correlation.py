"""The ids that tie a request to its jobs, and every line of the logs to both.

They are kept in a context variable: whatever works for a request or a job finds them without being handed them, in
its own thread or task and in those that it starts with its context.
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
    """What is being worked on: a request, and in a worker its job.

    trace_parent names the caller's span as W3C Trace Context writes it.
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
    """Return the ids of what is being worked on here; all are None outside of requests and jobs."""
    return _current.get()


def request_id() -> str | None:
    """Return the id of the request that is being served, or that made the job at work."""
    return _current.get().request_id


def trace_parent() -> str | None:
    """Return the span that what happens here belongs to: OpenTelemetry's if it is on, else the caller's."""
    span = get_current_span().get_span_context()
    if span.is_valid:
        return f"00-{span.trace_id:032x}-{span.span_id:016x}-{span.trace_flags:02x}"
    return _current.get().trace_parent


def of_this_work() -> Ids:
    """Return the ids that a job made here is to carry."""
    return Ids(request_id(), trace_parent())


@contextmanager
def bound(ids: Ids) -> Iterator[None]:
    """Work under these ids, and afterwards under those of before."""
    token = _current.set(ids)
    try:
        yield
    finally:
        _current.reset(token)


def of_request(given_id: str | None, given_parent: str | None) -> Ids:
    """Return the ids of a request by its headers X-Request-ID and traceparent; an id that cannot be kept is replaced.

    What an id may hold is bounded, since it goes into headers, logs and the database as it stands.
    """
    kept = given_id if given_id and _REQUEST_ID.fullmatch(given_id) else str(uuid7())
    return Ids(kept, given_parent if given_parent and _TRACE_PARENT.fullmatch(given_parent) else None)
