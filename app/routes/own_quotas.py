"""Quotas of an owner: what is used and allowed, and the answers to requests that are over one."""

from collections.abc import Mapping

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse

from app.answers.quota_use import QuotaDocument
from app.http import problems
from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.jobs import owner_quotas
from app.jobs.owner_quotas import Bounded, OverQuota
from app.routes import documentation
from app.routes.dependencies import PREFIX, CallerOf, Readers, SettingsOf
from app.schemas.fields import example_of

router = APIRouter(prefix=PREFIX, tags=["service"], route_class=KnownParametersRoute)

QUOTA_PROBLEMS = (ProblemKind.TOO_MANY_WAITING, ProblemKind.STORAGE_FULL)

_RETRY_SECONDS = "30"  # by then some of thousands of jobs have run


@router.get(
    "/quotas",
    summary="Get the quotas and their use",
    response_model=QuotaDocument,
    responses={200: documentation.body("What is used and allowed", ("application/json", example_of(QuotaDocument)))},
)
def get_quotas(settings: SettingsOf, caller: CallerOf, readers: Readers) -> JSONResponse:
    """Return how many jobs of the owner run and wait, how many bytes are stored, and the most of each.

    What is removed counts no more. Requests a minute are told by the header fields `RateLimit`.
    """
    with readers() as session:
        found = owner_quotas.standing(session, caller.owner)
    return JSONResponse(
        {
            "running_jobs": {"used": found.running, "most": settings.running_jobs_per_owner or None},
            "waiting_jobs": {"used": found.waiting, "most": settings.waiting_jobs_per_owner or None},
            "stored_bytes": {"used": found.stored, "most": settings.stored_bytes_per_owner or None},
            "expected_bytes": found.expected,
        }
    )


def problem(over: OverQuota, headers: Mapping[str, str] | None = None) -> ProblemError:
    """Return the problem for a request that is over a quota."""
    links = [{"rel": "quotas", "href": f"{PREFIX}/quotas"}]
    if over.bounded is Bounded.WAITING:
        detail = f"{over.most} jobs and chunks of one owner may wait, and with this {over.used + over.asked} would."
        fields = {"Retry-After": _RETRY_SECONDS, **(headers or {})}
        return ProblemError(ProblemKind.TOO_MANY_WAITING, detail, links=links, headers=fields)
    detail = (
        f"Requests and results of one owner may take {over.most} bytes. They take {over.used}, and this needs "
        f"{over.asked} more. DELETE ended jobs and batches that are not needed any more."
    )
    return ProblemError(ProblemKind.STORAGE_FULL, detail, links=links, headers=headers)


async def answer(request: Request, error: Exception) -> Response:
    """Answer a request that is over a quota."""
    assert isinstance(error, OverQuota)
    return await problems.answer(request, problem(error))
