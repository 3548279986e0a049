"""The page of a job: its progress while it runs, then the verdict and everything behind it."""

from typing import Annotated, Any
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse
from sqlalchemy.orm import Session

from app.http.forwarded import own_address
from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.jobs import job_records
from app.jobs.job_records import CancelOutcome
from app.pages.charts.curves import curves
from app.pages.charts.whole_curves import with_whole_curves
from app.pages.findings import Findings, findings
from app.pages.forms import Fields
from app.pages.frame import moved, page, units_of
from app.pages.motions import motions, worst
from app.pages.moving import moving, name_of
from app.pages.recipes import recipes
from app.pages.result_parts import parts
from app.pages.submitting import submit
from app.pages.wording import words
from app.routes.dependencies import CallerOf, Readers, Writers
from app.routes.finished_jobs import FinishedJob
from app.routes.job_status import find_job
from app.security.caller import Scope
from app.tables import Job, JobStatus

router = APIRouter(include_in_schema=False, prefix="/pages/jobs/{job_id}", route_class=KnownParametersRoute)

Point = Annotated[int, Query(ge=0, description="Number of the study's point, from 0")]
_UNDER_WAY = {JobStatus.ACCEPTED, JobStatus.RUNNING}


@router.get("")
def job_page(request: Request, job_id: UUID, caller: CallerOf, readers: Readers, point: Point = 0) -> Response:
    """Return the page of a job in its state."""
    with readers() as session:
        job = find_job(session, caller, job_id)
        if job.status in _UNDER_WAY:
            return page(request, "job_under_way.html", job=job)
        found = None if job.status is JobStatus.DISMISSED else findings(session, job, point)
        seen = motions(session, job, found) if found is not None else []
    if found is None or found.here["failure"]:
        return page(request, "job_without_result.html", job=job, found=found)
    repeat = recipes(job, own_address(request.scope), with_key=caller.key_id is not None)
    shown = parts(job, found, units_of(request), seen)
    return page(request, "result.html", job=job, found=found, recipes=repeat, **shown)


@router.get("/motion")
def motion_of_job(
    request: Request, finished: FinishedJob, readers: Readers, point: Point = 0, cycle: int | None = None
) -> Response:
    """Return the part of the page that shows one motion in its course: the one asked for, or the largest stable one.

    Raises
    ------
    ProblemError
        404 if there is no such motion.
    """
    job, units = finished.job, units_of(request)
    with readers() as session:
        found = _found(session, job, point)
        seen = motions(session, job, found)
    chosen = worst(seen) if cycle is None else next((motion for motion in seen if motion.number == cycle), None)
    if chosen is None:
        raise ProblemError(ProblemKind.NOT_FOUND, words().motion.none)
    names = [(motion.number, name_of(motion, units)) for motion in seen]
    shown = moving(job, found, chosen, units)
    return page(request, "parts/motion.html", job=job, found=found, shown=shown, names=names)


@router.get("/curves")
async def curves_of_job(
    request: Request, finished: FinishedJob, caller: CallerOf, readers: Readers, point: Point = 0
) -> Response:
    """Return the curves that the page draws, from the onset on."""

    def read() -> Findings:
        with readers() as session:
            return _found(session, finished.job, point)

    stored, previews = await to_thread.run_sync(read), request.app.state.previews
    found, note = await with_whole_curves(previews, caller.owner, finished.job.document, stored)
    drawn = await to_thread.run_sync(curves, found, units_of(request))
    return JSONResponse({**drawn, "note": note})


@router.post("/cancel")
def cancel(request: Request, job_id: UUID, caller: CallerOf, writers: Writers, fields: Fields) -> Response:
    """Cancel a job that is under way, or remove one that has ended where the form says so: it may have ended meanwhile.

    Raises
    ------
    ProblemError
        403 if the key may not cancel.
    """
    if Scope.CANCEL not in caller.scopes:
        raise ProblemError(ProblemKind.FORBIDDEN, words().result.may_not_cancel)
    with writers.begin() as session:
        outcome = job_records.cancel(session, caller, job_id, may_remove=fields.get("remove") == "yes")
    gone = outcome in {CancelOutcome.REMOVED, CancelOutcome.MISSING}
    return moved(request, "/pages/jobs" if gone else f"/pages/jobs/{job_id}")


@router.post("/again")
async def again(request: Request, job_id: UUID, caller: CallerOf, readers: Readers, fields: Fields) -> Response:
    """Submit the document of a job once more, to be computed anew."""
    del fields

    def document() -> dict[str, Any]:
        with readers() as session:
            return dict(find_job(session, caller, job_id).document)

    job = await submit(request, document, may_reuse=False)
    return moved(request, f"/pages/jobs/{job.id}")


def _found(session: Session, job: Job, point: int) -> Findings:
    found = findings(session, job, point)
    if found is None:
        raise ProblemError(ProblemKind.NOT_FOUND, words().result.no_results)
    return found
