"""The routes of OGC API - Processes."""

from collections.abc import Mapping
from typing import Annotated, Any
from urllib.parse import urlencode
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Body, Depends, Query, Request, Response
from sqlalchemy.orm import Session

from app import convert, schemas
from app.export import formats
from app.http import paging
from app.http.beside_loop import beside_loop, mark_large
from app.http.forwarded import own_address
from app.http.prefix import AddressedJSON
from app.http.problems import invalid_document, query_fault
from app.http.strict_routes import StrictJsonRoute
from app.jobs import job_records
from app.jobs.job_records import CancelOutcome, Submission
from app.jobs.submissions import Order
from app.ogc import descriptions, documents, refusals
from app.ogc.links import BASE, PROCESS, link
from app.ogc.requests import Execution, JobsQuery
from app.owned import records
from app.routes.dependencies import CallerOf, Readers, SettingsOf, Writers, vet_webhook
from app.routes.job_intake import checked, stored_job
from app.routes.streaming import streamed
from app.routes.waiting import wait_for_end
from app.runtime.signing import signing_key
from app.schemas.faults import BadInput
from app.security.caller import Caller, Owned
from app.tables import ENDED, Job

router = APIRouter(prefix=BASE, include_in_schema=False, route_class=StrictJsonRoute)


async def _known_process(process_id: str) -> None:
    if process_id != PROCESS:
        raise refusals.missing("no-such-process", f"There is no process {process_id[:100]}.")


@router.get("")
@router.get("/")
def landing() -> AddressedJSON:
    """Return the landing page."""
    return AddressedJSON(descriptions.landing())


@router.get("/conformance")
def conformance() -> AddressedJSON:
    """Return the conformance classes."""
    return AddressedJSON(descriptions.conformance())


@router.get("/processes")
def list_processes() -> AddressedJSON:
    """Return the list of processes, which is one."""
    links = [link("self", f"{BASE}/processes", "Processes")]
    return AddressedJSON({"processes": [descriptions.summary()], "links": links})


@router.get("/processes/{process_id}", dependencies=[Depends(_known_process)])
def describe_process(request: Request) -> Response:
    """Return the description of the process."""
    return Response(descriptions.description_text(own_address(request.scope)), media_type=formats.MEDIA_TYPES["json"])


@router.post("/processes/{process_id}/execution", dependencies=[Depends(_known_process)])
async def execute(request: Request, execution: Annotated[Execution, Body()]) -> Response:
    """Execute the process: 200 with its results if a short one ends in time, else 201 with the address of its job.

    `Prefer: respond-async` answers at once.

    Raises
    ------
    ProblemError
        404 for another process, 422 with every fault of the inputs, or if a subscriber's address is refused.
    """
    caller, shared = request.state.caller, request.app.state
    document = await beside_loop(request, lambda: _request_of(request, execution))
    mark_large(request)  # its rows of the owner may be
    kept = await checked(request, document, document.kept)
    told = {} if execution.subscriber is None else execution.subscriber.subscriptions()
    for pointer, wanted in told.items():
        await vet_webhook(shared.settings, wanted.url, pointer)
    line = document.line
    submission = Submission(caller, kept, line.name, line.asset_id, line.tags)
    job = await stored_job(request, Order(submission, tuple(told.values())))
    preferred = "respond-async" in ", ".join(request.headers.getlist("prefer")).lower()
    seconds, most = convert.estimate(document).seconds, shared.settings.longest_wait_seconds
    if not preferred and seconds is not None and seconds < most:
        await wait_for_end(shared.job_watch, Owned(caller.owner, job.id), int(most) or 1)
        job = await to_thread.run_sync(_find, request, job.id)
        if job.status in ENDED:
            refusals.require_success(job)
            monitor = f"<{own_address(request.scope)}{BASE}/jobs/{job.id}>; rel=monitor"
            return _answered(request, job, {"Link": monitor}, raw=execution.response == "raw")
    applied = {"Preference-Applied": "respond-async"} if preferred else {}
    return AddressedJSON(documents.status_info(job), 201, {"Location": f"{BASE}/jobs/{job.id}", **applied})


@router.get("/jobs")
def list_jobs(
    settings: SettingsOf, caller: CallerOf, readers: Readers, query: Annotated[JobsQuery, Query()]
) -> AddressedJSON:
    """Return one page of the jobs, newest first.

    Raises
    ------
    ProblemError
        400 if a parameter is not valid.
    """
    key, filters = signing_key(settings), query.filters()
    try:
        after = paging.decode(key, query.cursor) if query.cursor else None
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error
    found: list[Job] = []
    if filters is not None:
        with readers() as session:
            found = job_records.page(session, caller.owner, filters, after, query.rows + 1)
    shown = [documents.status_info(job) for job in found[: query.rows]]
    links = [link("self", f"{BASE}/jobs", "Jobs")]
    if len(found) > query.rows:
        last = found[query.rows - 1]
        kept = query.model_dump(mode="json", exclude_defaults=True) | {
            "limit": query.rows,
            "cursor": paging.encode(key, (last.created_at, last.id)),
        }
        links.append(link("next", f"{BASE}/jobs?{urlencode(kept, doseq=True)}", "Older jobs"))
    return AddressedJSON({"jobs": shown, "links": links})


@router.get("/jobs/{job_id}")
def job_status(request: Request, job_id: str) -> AddressedJSON:
    """Return the status of a job."""
    return AddressedJSON(documents.status_info(_find(request, job_id)))


@router.get("/jobs/{job_id}/results")
def job_results(request: Request, job_id: str) -> Response:
    """Return the results of a job under the name of its output.

    Raises
    ------
    ProblemError
        404 while they are not ready.
    """
    job = _find(request, job_id)
    refusals.require_success(job)
    return _answered(request, job, {}, raw=False)


@router.delete("/jobs/{job_id}")
def dismiss(request: Request, job_id: str, writers: Writers) -> AddressedJSON:
    """Cancel a job, or remove what an ended one has left."""
    found = _find(request, job_id)
    with writers.begin() as session:
        outcome = job_records.cancel(session, request.state.caller, found.id)
        session.flush()
        job = found if outcome is CancelOutcome.REMOVED else _of(session, request.state.caller, found.id)
        info = documents.status_info(job)
    return AddressedJSON(
        {**info, "status": "dismissed", "message": "The job is dismissed.", "links": info["links"][:1]}
    )


def _request_of(request: Request, execution: Execution) -> schemas.JobRequest:
    with request.app.state.readers() as session:
        own = records.own_rows(session, request.state.caller.owner)
    try:
        return execution.request(own)
    except BadInput as error:
        raise invalid_document(error.faults) from error


def _find(request: Request, job_id: str | UUID) -> Job:
    with request.app.state.readers() as session:
        return _of(session, request.state.caller, job_id)


def _of(session: Session, caller: Caller, job_id: str | UUID) -> Job:
    try:
        job = job_records.get(session, caller.owner, UUID(str(job_id)))
    except ValueError:
        job = None
    if job is None or job.batch_id is not None:
        raise refusals.missing("no-such-job", f"There is no job {str(job_id)[:100]}.")
    return job


def _answered(request: Request, job: Job, headers: Mapping[str, str], *, raw: bool) -> Response:
    def pieces(session: Session) -> Any:
        return formats.in_blocks(documents.results(session, job, raw=raw))

    return streamed(request.app.state.readers, pieces, formats.MEDIA_TYPES["json"], headers)
