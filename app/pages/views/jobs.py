"""The list of jobs, a page at a time, and those of them that a reader wants to see."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Query, Request, Response
from sqlalchemy.orm import Session

from app.http import paging
from app.http.problems import query_fault
from app.http.strict_routes import KnownParametersRoute
from app.jobs import job_records
from app.jobs.job_records import JobFilters
from app.jobs.owner_quotas import standing
from app.pages.frame import page
from app.pages.wording import words
from app.routes.dependencies import CallerOf, Readers
from app.runtime.signing import signing_key
from app.security.caller import Caller
from app.tables import JobStatus

router = APIRouter(include_in_schema=False, route_class=KnownParametersRoute)

_ON_PAGE = 40


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which jobs a reader wants to see: those in a state, of an asset, with a tag as key:value or a key alone."""

    status: JobStatus | None
    asset_id: str
    tag: str

    @property
    def query(self) -> Mapping[str, str]:
        """Return the wishes as the query of an address, empty without any."""
        said = {"status": self.status and self.status.value, "asset_id": self.asset_id, "tag": self.tag}
        return {name: value for name, value in said.items() if value}

    def as_filters(self) -> JobFilters:
        """Return the filters of the list."""
        key, _, value = self.tag.partition(":")
        return JobFilters(self.status, self.asset_id or None, {key: value or None} if self.tag else {})


def _wanted(
    status: Annotated[str, Query(max_length=20)] = "",
    asset_id: Annotated[str, Query(max_length=200)] = "",
    tag: Annotated[str, Query(max_length=400)] = "",
) -> Wanted:
    """Return which jobs the address of a page asks for; the filters stay in it, so that it can be kept and sent."""
    return Wanted(JobStatus(status) if status in set(JobStatus) else None, asset_id.strip(), tag.strip())


@router.get("/pages/jobs")
def list_of_jobs(
    request: Request,
    caller: CallerOf,
    readers: Readers,
    wanted: Annotated[Wanted, Depends(_wanted)],
    cursor: Annotated[str, Query(max_length=200)] = "",
) -> Response:
    """Return the owner's jobs that are wanted, newest first, with a link to older ones.

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
        found = job_records.page(session, caller.owner, wanted.as_filters(), after, _ON_PAGE + 1)
        older = None
        if len(found) > _ON_PAGE:
            last = found[_ON_PAGE - 1]
            position = {"cursor": paging.encode(key, (last.created_at, last.id))}
            older = f"/pages/jobs?{urlencode({**wanted.query, **position})}"
        jobs = found[:_ON_PAGE]
        tags = sorted({f"{tag.key}:{tag.value}" for job in jobs for tag in job.tags})
        stored, states = _stored(request, session, caller), list(JobStatus)
    return page(request, "jobs.html", jobs=jobs, older=older, wanted=wanted, states=states, tags=tags, stored=stored)


def _stored(request: Request, session: Session, caller: Caller) -> str:
    """Return the sentence on what the owner has and may have, empty without a bound on bytes."""
    most = request.app.state.settings.stored_bytes_per_owner
    if not most:
        return ""
    had = standing(session, caller.owner)
    sizes = {"stored": f"{1e-6 * had.stored:,.1f}", "most": f"{1e-6 * most:,.0f}"}
    sentence: str = words().jobs.stored.format(running=had.running, waiting=had.waiting, **sizes)
    return sentence
