"""The list of jobs, a page at a time."""

from typing import Annotated
from urllib.parse import urlencode

from fastapi import APIRouter, Query, Request, Response

from app.http import paging
from app.http.problems import query_fault
from app.http.strict_routes import KnownParametersRoute
from app.jobs import job_records
from app.jobs.job_records import JobFilters
from app.pages.frame import page
from app.routes.dependencies import CallerOf, Readers
from app.runtime.settings import signing_key

router = APIRouter(include_in_schema=False, route_class=KnownParametersRoute)

_ON_PAGE = 40


@router.get("/pages/jobs")
def list_of_jobs(
    request: Request, caller: CallerOf, readers: Readers, cursor: Annotated[str, Query(max_length=200)] = ""
) -> Response:
    """Return the owner's jobs, newest first, with a link to older ones.

    Raises
    ------
    ProblemError
        400 if the cursor is not one of this service.
    """
    key = signing_key(request.app.state.settings)
    try:
        after = paging.decode(key, cursor) if cursor else None
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error
    with readers() as session:
        found = job_records.page(session, caller.owner, JobFilters(), after, _ON_PAGE + 1)
        older = None
        if len(found) > _ON_PAGE:
            last = found[_ON_PAGE - 1]
            older = f"/pages/jobs?{urlencode({'cursor': paging.encode(key, (last.created_at, last.id))})}"
        return page(request, "jobs.html", jobs=found[:_ON_PAGE], older=older)
