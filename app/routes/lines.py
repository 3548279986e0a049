"""Resolve lines as engineers know them."""

from typing import Annotated

from fastapi import APIRouter, Body, Response
from fastapi.responses import JSONResponse
from sqlalchemy.orm import Session

from app import convert
from app.answers.lines import ResolvedLine
from app.http.problems import ProblemKind, invalid_document
from app.http.strict_routes import StrictJsonRoute
from app.jobs import idempotency, job_records
from app.owned import records
from app.routes import documentation, own_documentation
from app.routes.dependencies import PREFIX, CallerOf, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.schemas.faults import BadInput
from app.schemas.known import KnownLine

router = APIRouter(prefix=f"{PREFIX}/lines", tags=["lines"], route_class=StrictJsonRoute)


@router.post(
    "/resolve",
    summary="Resolve a line as an engineer knows it",
    response_model=ResolvedLine,
    responses={
        200: {
            **documentation.body("The explicit line", ("application/json", own_documentation.RESOLVED)),
            "headers": documentation.REPLAYED_HEADER,
        },
        **documentation.problems(
            *KEY_PROBLEMS, ProblemKind.TOO_LARGE, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
)
def resolve_line(
    document: Annotated[KnownLine, Body(openapi_examples=own_documentation.KNOWN_LINES)],
    caller: CallerOf,
    key: KeyOf,
    writers: Writers,
) -> Response:
    """Return the whole explicit line and where each value came from, without an analysis.

    Conductors and ice shapes may be named, the tension may be that of an everyday state, ice may be a shape with a
    thickness. What is not said is estimated, with a range. The explicit line gives the same results.
    """

    def make(session: Session) -> PostOutcome:
        own = records.own_rows(session, caller.owner)
        return PostOutcome(JSONResponse(convert.resolve_line(document, own)))

    def fingerprint() -> str:
        return idempotency.fingerprint(router.prefix, job_records.canonical(document.model_dump(mode="json")))

    try:
        return run_once(writers, key, fingerprint, make).answer
    except BadInput as error:
        raise invalid_document(error.faults) from error
