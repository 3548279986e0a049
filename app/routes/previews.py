"""Compute a line at once, without storing anything."""

from typing import Annotated, Any

from anyio import to_thread
from fastapi import APIRouter, Body, Request, Response

from app import convert, interactive, schemas
from app.answers.results import ResultDocument
from app.convert import PointResult
from app.export import formats
from app.http.beside_loop import beside_loop_if_large
from app.http.problems import ProblemError, ProblemKind, invalid_document
from app.routes import documentation
from app.routes.dependencies import PREFIX, CallerOf
from app.routes.known_lines import KnownLineRoute
from app.schemas.faults import Fault
from app.security.caller import Caller

router = APIRouter(prefix=f"{PREFIX}/previews", tags=["lines"], route_class=KnownLineRoute)

_JOBS_ONLY = ("study", "placement", "webhook_url")


@router.post(
    "",
    summary="Compute a line at once, without a job",
    response_model=ResultDocument,
    responses={
        200: documentation.body("All results", ("application/json", documentation.RESULT)),
        **documentation.problems(
            ProblemKind.TOO_LARGE,
            ProblemKind.UNSUPPORTED_MEDIA_TYPE,
            ProblemKind.TAKES_TOO_LONG,
            ProblemKind.INVALID_DOCUMENT,
            ProblemKind.BUSY,
        ),
    },
)
async def preview_line(
    request: Request,
    document: Annotated[schemas.JobRequest, Body(openapi_examples=documentation.REQUESTS)],
    caller: CallerOf,
) -> Response:
    """Return the results of a line as its job would, for a person who changes a value and looks.

    Nothing is stored, so there is nothing to read later. Each process of the API computes one line at a time, for a few
    seconds at most; values that are assumed are not sampled. Studies and placements need a job.
    """
    kept, point = await preview(request, caller, document)
    text = await to_thread.run_sync(_text, kept, point)
    return Response(text, media_type=formats.MEDIA_TYPES["json"])


async def preview(request: Request, caller: Caller, document: schemas.JobRequest) -> tuple[dict[str, Any], PointResult]:
    """Return a checked request as it is computed, and what was found.

    Raises
    ------
    ProblemError
        422 if only a job takes it, the engine refuses it or it takes too long; 429 if too many previews wait.
    """
    kept = await beside_loop_if_large(request, lambda: _sound(document))
    previews: interactive.Previews = request.app.state.previews
    try:
        point = await previews.compute(caller.owner, kept)
    except interactive.Busy as error:
        raise ProblemError(ProblemKind.BUSY, ProblemKind.BUSY.description, headers={"Retry-After": "1"}) from error
    except interactive.TakesTooLong as error:
        detail = f"The line takes longer than {previews.seconds:g} s; submit it as a job."
        raise ProblemError(ProblemKind.TAKES_TOO_LONG, detail) from error
    except (ArithmeticError, ValueError) as error:
        raise invalid_document([Fault("/line", "invalid", str(error))]) from error
    return kept, point


def _sound(document: schemas.JobRequest) -> dict[str, Any]:
    """Return a request as it is computed; raise the problem of one that is not sound or that only a job takes."""
    if faults := [*_only_for_jobs(document), *convert.request_faults(document)]:
        raise invalid_document(faults)
    return _without_samples(document.kept())


def _only_for_jobs(document: schemas.JobRequest) -> list[Fault]:
    return [
        Fault(f"/{name}", "jobs_only", "must be absent: only a job takes it")
        for name in _JOBS_ONLY
        if getattr(document, name) is not None
    ]


def _without_samples(kept: dict[str, Any]) -> dict[str, Any]:
    return {**kept, "analysis": {**kept["analysis"], "uncertainty": {"samples": 0}}}


def _text(kept: dict[str, Any], point: PointResult) -> str:
    facts = {
        "axes": {},
        "static": point.static,
        "den_hartog": point.den_hartog,
        "warnings": point.warnings,
        "engine_version": point.engine_version,
        "failure": point.failure,
    }
    return "".join(formats.result_text(kept, [facts], point.tables))
