"""Answer every error as problem details (RFC 9457): from routes, FastAPI, Starlette, the body limit, or a defect."""

import logging
from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from typing import Any

from anyio import to_thread
from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import InternalError, OperationalError
from sqlalchemy.exc import TimeoutError as NoConnectionFree
from starlette.exceptions import HTTPException
from starlette.routing import Match

from app import convert
from app.http.body_limit import BodyLimit, Limit, Pace
from app.http.conditional import Bodiless
from app.http.prefix import LinkedJSON
from app.runtime.signing import SecretUnavailable
from app.schemas.faults import MOST_FAULTS, Fault, faults_of, json_pointer
from app.storage.database import takes_no_changes
from app.storage.pages import Removed
from app.storage.stored_results import CorruptResult

MEDIA_TYPE = "application/problem+json"

_logger = logging.getLogger(__name__)


class ProblemKind(Enum):
    """The kinds of problem: slug of the explaining page, status, title, and a sentence for the page."""

    INVALID_PARAMETER = ("invalid-parameter", 400, "Invalid parameter", "A query parameter is not valid.")
    UNAUTHENTICATED = ("unauthenticated", 401, "Unauthenticated", "The request needs a valid API key.")
    FORBIDDEN = (
        "forbidden",
        403,
        "Forbidden",
        "The API key lacks the scope that this method needs, or a page of another site sent the request.",
    )
    NOT_FOUND = ("not-found", 404, "Not found", "There is nothing at this address, or it was removed.")
    METHOD_NOT_ALLOWED = ("method-not-allowed", 405, "Method not allowed", "The address does not support this method.")
    NOT_ACCEPTABLE = (
        "not-acceptable",
        406,
        "Not acceptable",
        "The Accept header allows no media type of this address.",
    )
    TOO_SLOW = ("too-slow", 408, "Body too slow", "The request body arrives more slowly than the operator allows.")
    # Where kinds share a status, the last one applies to any other error of that status.
    REQUEST_IN_FLIGHT = (
        "request-in-flight",
        409,
        "Request in flight",
        "An earlier request with this Idempotency-Key is still in progress; repeat the request to get its answer.",
    )
    NOT_READY = ("not-ready", 409, "Not ready", "The job has not ended; its status document shows the progress.")
    DAMAGED = ("damaged", 410, "Damaged result", "A stored result is not what was stored, and must be computed anew.")
    DISMISSED = ("dismissed", 410, "Dismissed", "The job was cancelled and has no results.")
    TOO_LARGE = ("too-large", 413, "Body too large", "The request body is larger than the operator allows.")
    UNSUPPORTED_MEDIA_TYPE = (
        "unsupported-media-type",
        415,
        "Unsupported media type",
        "The service does not accept a body of this media type.",
    )
    KEY_REUSED = (
        "idempotency-key-reused",
        422,
        "Idempotency-Key reused",
        "The Idempotency-Key was used for another request within the last 24 hours.",
    )
    TAKES_TOO_LONG = (
        "takes-too-long",
        422,
        "Takes too long",
        "The line takes longer than a preview may; submit it as a job.",
    )
    INVALID_DOCUMENT = ("invalid-document", 422, "Invalid document", "The body is not JSON, or fields of it are wrong.")
    TOO_MANY_WAITING = (
        "too-many-waiting",
        429,
        "Too many waiting jobs",
        "So many jobs of one owner may not wait; try again when some have run, or cancel some.",
    )
    BUSY = ("busy", 429, "Busy", "Earlier ones are not done yet; try again when Retry-After says.")
    TOO_MANY_REQUESTS = (
        "too-many-requests",
        429,
        "Too many requests",
        "The quota for this minute is used up; wait as long as Retry-After says.",
    )
    HEAD_TOO_LARGE = (
        "head-too-large",
        431,
        "Head too large",
        "The request's address and header fields together are too large, or it has too many header fields.",
    )
    INTERNAL = ("internal", 500, "Internal error", "The service has a defect; the operator's log has the details.")
    UNAVAILABLE = ("unavailable", 503, "Unavailable", "The service cannot reach what it needs; try again later.")
    STORAGE_FULL = (
        "storage-full",
        507,
        "Storage quota used up",
        "Requests and results of an owner take all bytes that they may; DELETE jobs and batches, or ask the operator.",
    )

    def __init__(self, slug: str, status: int, title: str, description: str) -> None:
        """Store the parts of a kind as attributes."""
        self.slug = slug
        self.status = status
        self.title = title
        self.description = description


_METHODS = ("DELETE", "GET", "PATCH", "POST", "PUT")
_BY_STATUS = {kind.status: kind for kind in ProblemKind}


class ProblemError(HTTPException):
    """Raised by a route to answer with a problem; FastAPI does not convert it."""

    def __init__(
        self,
        kind: ProblemKind,
        detail: str,
        *,
        faults: Sequence[Fault] = (),
        links: Sequence[Mapping[str, str]] = (),
        headers: Mapping[str, str] | None = None,
        type_address: str | None = None,
    ) -> None:
        """Take the kind, a sentence for this occurrence, and optional parts; a standard may have its own type of it."""
        self.kind = kind
        self.type_address = type_address
        self.faults = faults
        self.links = links
        super().__init__(kind.status, detail, dict(headers) if headers else None)


def problem_document(kind: ProblemKind, detail: str, instance: str, faults: Sequence[Fault] = ()) -> dict[str, Any]:
    """Return the problem document for one occurrence, with at most `MOST_FAULTS` faults."""
    listed = [{"pointer": f.pointer, "code": f.code, "detail": f.detail} for f in faults[:MOST_FAULTS]]
    more = f" Only the first {MOST_FAULTS} faults are listed." if len(faults) > MOST_FAULTS else ""
    return {
        "type": f"/problems/{kind.slug}",
        "title": kind.title,
        "status": kind.status,
        "detail": detail + more,
        "instance": instance,
        "errors": listed,
    }


Shown = Callable[[Request, ProblemError], Response | None]
"""Returns a page that explains a problem to a person, or None where a program asked."""


def install(app: FastAPI, max_body_bytes: Mapping[str, int], slowest_body: tuple[float, float], shown: Shown) -> None:
    """Make an application answer every error with a problem, and limit its bodies by path; "" means all other paths.

    slowest_body: the longest silence in seconds, and the bytes a second that a body must bring.
    """
    app.state.shown_problem = shown
    app.add_exception_handler(ProblemError, answer)
    app.add_exception_handler(Bodiless, _on_bodiless)
    app.add_exception_handler(HTTPException, _on_http)
    app.add_exception_handler(RequestValidationError, _on_validation)
    for of_database in (OperationalError, InternalError):  # PostgreSQL calls it internal when it takes no changes
        app.add_exception_handler(of_database, _on_database)
    app.add_exception_handler(SecretUnavailable, _on_secret)
    app.add_exception_handler(NoConnectionFree, _on_database)
    app.add_exception_handler(CorruptResult, _on_corrupt)
    app.add_exception_handler(Removed, _on_removed)
    app.add_exception_handler(Exception, _on_defect)
    limits = {path: Limit(most_bytes, _too_large(most_bytes)) for path, most_bytes in max_body_bytes.items()}
    pace = Pace(*slowest_body, _too_slow(*slowest_body))
    app.add_middleware(BodyLimit, limits=limits, pace=pace, refuse=answer)


def _too_large(most_bytes: int) -> ProblemError:
    detail = f"The body is larger than {most_bytes} bytes."
    return ProblemError(ProblemKind.TOO_LARGE, detail, headers={"Connection": "close"})


def _too_slow(silent_seconds: float, bytes_a_second: float) -> ProblemError:
    detail = f"The body must bring {bytes_a_second:g} bytes a second and must not pause for {silent_seconds:g} s."
    return ProblemError(ProblemKind.TOO_SLOW, detail, headers={"Connection": "close"})


def invalid_document(faults: Sequence[Fault]) -> ProblemError:
    """Return the problem for a body with these faults."""
    return ProblemError(ProblemKind.INVALID_DOCUMENT, _count(faults), faults=faults)


def _count(faults: Sequence[Fault]) -> str:
    if len(faults) > MOST_FAULTS:
        return f"The document has more than {MOST_FAULTS} faults."
    return f"The document has {len(faults)} fault{'s' if len(faults) != 1 else ''}."


def _respond(request: Request, problem: ProblemError) -> Response:
    shown: Response | None = request.app.state.shown_problem(request, problem)
    if shown is not None:
        return shown
    document = problem_document(problem.kind, problem.detail, request.url.path[:500], problem.faults)
    if problem.type_address is not None:
        document["type"] = problem.type_address
    if problem.links:
        document["links"] = list(problem.links)
    return LinkedJSON(document, problem.status_code, headers=problem.headers, media_type=MEDIA_TYPE)


async def answer(request: Request, error: Exception) -> Response:
    """Answer with the problem that was raised."""
    assert isinstance(error, ProblemError)
    return _respond(request, error)


async def _on_bodiless(_: Request, error: Exception) -> Response:
    assert isinstance(error, Bodiless)
    return Response(status_code=error.status_code, headers=error.headers)


async def _on_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    kind = _BY_STATUS.get(error.status_code, ProblemKind.INVALID_PARAMETER)
    headers = {"Allow": _methods(request)} if kind is ProblemKind.METHOD_NOT_ALLOWED else error.headers
    return _respond(request, ProblemError(kind, kind.description, headers=headers))


def _methods(request: Request) -> str:
    """Return the methods that an address supports; Starlette reports only those of the first matching route."""

    def takes(method: str) -> bool:
        scope = {**request.scope, "method": method}
        return any(route.matches(scope)[0] is Match.FULL for route in request.app.routes)

    methods = [method for method in _METHODS if takes(method)]
    return ", ".join(sorted({*methods, "HEAD"} if "GET" in methods else methods))


async def _on_validation(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    return _respond(request, await to_thread.run_sync(validation_problem, error.errors(), error.body))


def validation_problem(errors: Sequence[Any], document: object) -> ProblemError:
    """Return the problem for what the schemas of a route found; the faults of a large document take seconds to name."""
    places = {wrong["loc"][0] for wrong in errors}
    if "path" in places:
        return ProblemError(ProblemKind.NOT_FOUND, ProblemKind.NOT_FOUND.description)
    if "body" not in places:
        return ProblemError(ProblemKind.INVALID_PARAMETER, "See errors.", faults=faults_of(errors))
    faults = faults_of([wrong for wrong in errors if wrong["loc"][0] == "body"], skip=1)
    return invalid_document(convert.with_further_faults(document, faults))


async def _on_database(request: Request, error: Exception) -> Response:
    return _respond(request, database_fault(error))


async def _on_secret(request: Request, error: Exception) -> Response:
    return _respond(request, secret_fault(error))


def database_fault(error: Exception) -> ProblemError:
    """Log that the database does not answer, or takes no changes, and return the problem for it."""
    detail = "The database takes no changes." if takes_no_changes(error) else "The database does not answer."
    _logger.error("%s %s", detail, error)
    return ProblemError(ProblemKind.UNAVAILABLE, detail, headers={"Retry-After": "5"})


def secret_fault(error: Exception) -> ProblemError:
    """Log that the signing secret cannot be read, and return the problem for it."""
    _logger.error("the signing secret cannot be read: %s", error)
    detail = "The service cannot read its signing secret; its operator must put it back."
    return ProblemError(ProblemKind.UNAVAILABLE, detail, headers={"Retry-After": "5"})


async def _on_corrupt(request: Request, error: Exception) -> Response:
    _logger.error("the stored result behind %s is corrupt: %s", request.url.path[:500], error)
    detail = "Its checksum is wrong. Compute it anew: POST /v1/jobs/{id}/retry, or post the lines of the batch again."
    return _respond(request, ProblemError(ProblemKind.DAMAGED, detail))


async def _on_removed(request: Request, _: Exception) -> Response:
    return _respond(request, ProblemError(ProblemKind.NOT_FOUND, ProblemKind.NOT_FOUND.description))


async def _on_defect(request: Request, error: Exception) -> Response:
    # Starlette raises the error again after this answer, and the server logs it with its traceback.
    return _respond(request, ProblemError(ProblemKind.INTERNAL, ProblemKind.INTERNAL.description))


def query_fault(name: str, detail: str) -> ProblemError:
    """Return the problem for one query parameter."""
    fault = Fault(json_pointer(["query", name]), "invalid", detail)
    return ProblemError(ProblemKind.INVALID_PARAMETER, "See errors.", faults=[fault])
