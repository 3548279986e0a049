"""Submit, read, list and cancel jobs."""

from typing import Annotated
from urllib.parse import urlencode
from uuid import UUID

from fastapi import APIRouter, Body, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.orm import Session

from app import schemas
from app.answers.jobs import JobDocument, JobEstimate, JobPage
from app.http import paging
from app.http.prefix import LinkedJSON
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.jobs import idempotency, job_records
from app.jobs.job_records import CancelOutcome, JobFilters
from app.routes import documentation, own_documentation
from app.routes.dependencies import PREFIX, RETRY_SECONDS, CallerOf, MayReuse, Readers, SettingsOf, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.routes.job_intake import JOBS, accepted_job, estimate
from app.routes.job_status import find_job, find_status, job_address, job_document
from app.routes.known_lines import KnownLineRoute
from app.routes.moments import Moment
from app.routes.own_quotas import QUOTA_PROBLEMS
from app.routes.waiting import APPLIED_HEADER, Wait, applied, wait_for_end
from app.runtime.signing import signing_key
from app.schemas.fields import Label, example_of
from app.security.caller import Owned
from app.tables import ENDED, JobStatus

router = APIRouter(prefix=JOBS, tags=["jobs"], route_class=KnownLineRoute)

_MOST_ON_PAGE = 500
_REQUESTS = documentation.REQUESTS | own_documentation.KNOWN_REQUESTS
_COMMON = documentation.problems(ProblemKind.NOT_FOUND)


class ListQuery(BaseModel):
    """Filters of a list of jobs, and where the page begins."""

    model_config = ConfigDict(extra="forbid")

    status: JobStatus | None = Field(default=None, description="Only jobs in this state")
    asset_id: Label | None = Field(default=None, description="Only jobs of this asset")
    tag: list[Label] = Field(default=[], max_length=10, description="Only jobs with these tags, each as key:value")
    batch_id: UUID | None = Field(default=None, description="Chunks of this batch, which appear in no other list")
    created_after: Moment | None = Field(
        default=None, description="Only jobs created after this time, with a time zone"
    )
    created_before: Moment | None = Field(
        default=None, description="Only jobs created before this time, with a time zone"
    )
    limit: int = Field(default=50, ge=1, le=_MOST_ON_PAGE, description="Most jobs on the page")
    cursor: str | None = Field(default=None, max_length=200, description="Cursor from a `next` address")

    def as_filters(self) -> JobFilters:
        """Return the filters.

        Raises
        ------
        ProblemError
            400 if a tag is not key:value, or a key appears twice.
        """
        pairs = [text.partition(":") for text in self.tag]
        tags: dict[str, str | None] = {key: value for key, _, value in pairs}
        if len(tags) != len(pairs) or not all(key and colon and value for key, colon, value in pairs):
            raise query_fault("tag", "a tag is key:value, each key at most once")
        return JobFilters(self.status, self.asset_id, tags, self.batch_id, self.created_after, self.created_before)


@router.post(
    "",
    summary="Submit a job",
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
async def submit_job(
    request: Request,
    document: Annotated[schemas.JobRequest, Body(openapi_examples=_REQUESTS)],
    key: KeyOf,
    may_reuse: MayReuse,
    validate_only: Annotated[bool, Query(include_in_schema=False)] = False,
) -> Response:
    """Accept a line for analysis. The service stores the job before it answers, whether or not a worker is running.

    The line may be one as an engineer knows it, as `POST /v1/lines/resolve` takes it; the job then holds the explicit
    line. The design wind of a line is one of the wind speeds where the analysis names none.

    If the owner has stored results of the same input by this engine version, from a job or a line of a batch, the job
    ends at once with a copy of them, and `reused_from` names their source. `Cache-Control: no-cache` requests a new
    computation. `?validate_only=true` answers as `POST /v1/jobs/estimate` does, and submits nothing.
    """
    if validate_only:
        return await estimate(request, document)
    return await accepted_job(request, document, key, may_reuse=may_reuse)


@router.post(
    "/estimate",
    summary="Check a job and estimate its cost",
    response_model=JobEstimate,
    responses={
        200: documentation.body("The estimate", ("application/json", example_of(JobEstimate))),
        **documentation.problems(
            ProblemKind.TOO_LARGE, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
)
async def estimate_job(
    request: Request, document: Annotated[schemas.JobRequest, Body(openapi_examples=_REQUESTS)]
) -> Response:
    """Check what would be a job, and estimate its computing time from measured costs. Nothing is stored."""
    return await estimate(request, document)


@router.get(
    "/{job_id}",
    summary="Get the status of a job",
    response_model=JobDocument,
    responses={
        200: {
            **documentation.body("Status", ("application/json", documentation.FINISHED_JOB)),
            "headers": APPLIED_HEADER,
        },
        **_COMMON,
    },
)
async def job_status(request: Request, job_id: UUID, wait: Wait) -> LinkedJSON:
    """Return the status of a job, at once or, with `Prefer: wait=N`, when it ends or after N seconds."""
    statuses, caller = request.app.state.statuses, request.state.caller
    job = await find_status(statuses, caller, job_id)
    if wait and job.status not in ENDED:
        await wait_for_end(request.app.state.job_watch, Owned(caller.owner, job_id), wait)
        job = await find_status(statuses, caller, job_id)
    headers = applied(wait) if job.status in ENDED else {"Retry-After": RETRY_SECONDS, **applied(wait)}
    return LinkedJSON(job_document(job), headers=headers)


@router.get(
    "",
    summary="List jobs",
    response_model=JobPage,
    responses={
        200: documentation.body("A page of jobs, newest first", ("application/json", documentation.JOB_PAGE)),
        **documentation.problems(ProblemKind.INVALID_PARAMETER),
    },
)
def list_jobs(
    request: Request,
    filters: Annotated[ListQuery, Query()],
    settings: SettingsOf,
    caller: CallerOf,
    readers: Readers,
) -> LinkedJSON:
    """Return one page of the jobs, newest first; `next` is the address of the next page."""
    key = signing_key(settings)
    after = _place(key, filters.cursor) if filters.cursor else None
    with readers() as session:
        found = job_records.page(session, caller.owner, filters.as_filters(), after, filters.limit + 1)
        documents = [job_document(job) for job in found[: filters.limit]]
    following = None
    if len(found) > filters.limit:
        last = found[filters.limit - 1]
        following = _next_address(request, paging.encode(key, (last.created_at, last.id)))
    return LinkedJSON({"jobs": documents, "next": following})


@router.delete(
    "/{job_id}",
    summary="Cancel or remove a job",
    response_model=None,
    responses={
        200: {
            **documentation.body("The queued job is dismissed", ("application/json", documentation.DISMISSED_JOB)),
            "model": JobDocument,
        },
        202: {
            **documentation.body("The running job will stop", ("application/json", documentation.STOPPING_JOB)),
            "model": JobDocument,
        },
        204: {"description": "The finished job and its results are removed"},
        **_COMMON,
        **documentation.problems(ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_READY),
    },
)
def cancel_or_remove_job(
    job_id: UUID,
    caller: CallerOf,
    writers: Writers,
    if_ended: Annotated[
        bool, Query(description="Remove only: 409 if it has not ended, instead of cancelling it")
    ] = False,
) -> Response:
    """Cancel a job, or remove a finished one with its results.

    What has just ended is removed, too: `POST .../cancel` never removes, and `?if_ended=true` never cancels.
    """
    with writers.begin() as session:
        if if_ended and find_job(session, caller, job_id).status not in ENDED:
            raise ProblemError(ProblemKind.NOT_READY, "The job has not ended, so it was not removed.")
        outcome = job_records.cancel(session, caller, job_id)
        if outcome is CancelOutcome.REMOVED:
            return Response(status_code=204)
        session.flush()
        document = job_document(find_job(session, caller, job_id))
    if outcome is CancelOutcome.REQUESTED:
        return LinkedJSON(document, 202, headers={"Retry-After": RETRY_SECONDS})
    return LinkedJSON(document)


@router.post(
    "/{job_id}/cancel",
    summary="Cancel a job",
    response_model=JobDocument,
    responses={
        200: {
            **documentation.body("It has ended, now or before", ("application/json", documentation.DISMISSED_JOB)),
            "model": JobDocument,
        },
        202: {
            **documentation.body("The running job will stop", ("application/json", documentation.STOPPING_JOB)),
            "model": JobDocument,
        },
        **_COMMON,
        **documentation.problems(*KEY_PROBLEMS),
    },
)
def cancel_job(job_id: UUID, caller: CallerOf, key: KeyOf, writers: Writers) -> Response:
    """Cancel a job; one that has ended keeps its results."""

    def make(session: Session) -> PostOutcome:
        outcome = job_records.cancel(session, caller, job_id, may_remove=False)
        session.flush()
        document = job_document(find_job(session, caller, job_id))
        if outcome is CancelOutcome.REQUESTED:
            return PostOutcome(LinkedJSON(document, 202, headers={"Retry-After": RETRY_SECONDS}))
        return PostOutcome(LinkedJSON(document))

    return run_once(writers, key, lambda: idempotency.fingerprint(job_address(job_id), "cancel"), make).answer


def _place(key: bytes, cursor: str) -> paging.Place:
    try:
        return paging.decode(key, cursor)
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error


def _next_address(request: Request, cursor: str) -> str:
    kept = [(name, value) for name, value in request.query_params.multi_items() if name != "cursor"]
    return f"{PREFIX}/jobs?{urlencode([*kept, ('cursor', cursor)])}"
