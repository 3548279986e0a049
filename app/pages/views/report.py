"""The report of a job, as HTML and as PDF."""

from typing import Annotated, Any
from urllib.parse import quote
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import HTMLResponse

from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.interactive import Busy, Workshop
from app.pages import assets
from app.pages.findings import findings
from app.pages.frame import POLICY, address, units_of
from app.pages.reports import Material, NotPrintable, job_material, report_html, report_pdf
from app.pages.wording import words
from app.routes.dependencies import CallerOf
from app.routes.finished_jobs import FinishedJob
from app.storage import stored_results

router = APIRouter(include_in_schema=False, prefix="/pages/jobs/{job_id}", route_class=KnownParametersRoute)

_RETRY_SECONDS = "5"  # as long as a few reports take

Point = Annotated[int, Query(ge=0, description="Number of the study's point, from 0")]


@router.get("/report")
async def report(request: Request, job_id: UUID, finished: FinishedJob, point: Point = 0) -> Response:
    """Return the report as a page of its own, to read or to print."""
    material = await to_thread.run_sync(_material, request, finished, point)
    place = address(request)

    def picture(name: str) -> str:
        return place(f"/v1/jobs/{job_id}/plots/{name}.svg?point={point}")

    style = place(assets.address("own/report.css"))
    text = await to_thread.run_sync(report_html, material, units_of(request), picture, style)
    return HTMLResponse(text, headers={"Content-Security-Policy": POLICY, "Vary": "Cookie"})


@router.get("/report.pdf")
async def report_as_pdf(
    request: Request, job_id: UUID, caller: CallerOf, finished: FinishedJob, point: Point = 0
) -> Response:
    """Return the report as a file; it is made in a process of its own, one at a time.

    Raises
    ------
    ProblemError
        404 if this platform cannot make it; 429 if too many are being made.
    """
    material = await to_thread.run_sync(_material, request, finished, point)
    printers: Workshop = request.app.state.printers
    try:
        made = await printers.run(caller.owner, report_pdf, material, units_of(request))
    except Busy as error:
        raise ProblemError(ProblemKind.BUSY, words().report.busy, headers={"Retry-After": _RETRY_SECONDS}) from error
    except NotPrintable as error:
        raise ProblemError(ProblemKind.NOT_FOUND, str(error)) from error
    name = quote(f"{material.name or job_id}.pdf")
    headers = {"Content-Disposition": f"inline; filename*=UTF-8''{name}"}
    return Response(made, headers=headers, media_type="application/pdf")


def _material(request: Request, finished: Any, point: int) -> Material:
    job = finished.job
    with request.app.state.readers() as session:
        found = findings(session, job, point)
        if found is None or found.here["failure"]:
            raise ProblemError(ProblemKind.NOT_FOUND, words().result.no_results)
        orbits = [orbit for orbit in stored_results.orbits(session, job.id) if orbit["point"] == point]
        return job_material(session, job, found, orbits)
