"""Compare a line with remedies against galloping."""

from typing import Annotated

from fastapi import APIRouter, Body, Request, Response

from app.answers.jobs import JobDocument
from app.http.problems import ProblemKind
from app.routes import documentation
from app.routes.dependencies import PREFIX, MayReuse
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf
from app.routes.job_intake import accepted_job
from app.routes.known_lines import KnownLineRoute
from app.routes.own_quotas import QUOTA_PROBLEMS
from app.schemas.request import RemediesRequest

router = APIRouter(prefix=f"{PREFIX}/remedies", tags=["jobs"], route_class=KnownLineRoute)


@router.post(
    "",
    summary="Compare remedies on a line",
    status_code=202,
    response_model=JobDocument,
    responses={
        202: {
            **documentation.body(
                "Accepted; Location is the address of its status", ("application/json", documentation.ACCEPTED_JOB)
            ),
            "headers": documentation.ACCEPTED_HEADERS,
        },
        **documentation.problems(
            *KEY_PROBLEMS,
            *QUOTA_PROBLEMS,
            ProblemKind.TOO_LARGE,
            ProblemKind.UNSUPPORTED_MEDIA_TYPE,
            ProblemKind.INVALID_DOCUMENT,
        ),
    },
)
async def compare_remedies(
    request: Request,
    document: Annotated[RemediesRequest, Body(openapi_examples=documentation.REMEDIES_REQUESTS)],
    key: KeyOf,
    may_reuse: MayReuse,
) -> Response:
    """Accept a line as a job that analyses it as it is and with each remedy: pendulums, spacers, another tension, ...

    The table `remedies` of its results has one row for each. Places that are not given are searched for; the row says
    `no_improvement` where none is better than nothing. Without `remedies` the usual ones are tried.
    """
    return await accepted_job(request, document, key, may_reuse=may_reuse)
