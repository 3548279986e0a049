"""The page on which a few values of a job's line are moved, and the curve follows without a job."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse
from sqlalchemy.orm import Session, sessionmaker

from app.http.beside_loop import beside_loop
from app.http.problems import ProblemError, ProblemKind, invalid_document
from app.http.strict_routes import KnownParametersRoute
from app.pages.charts.curves import curves
from app.pages.findings import Findings, with_axes
from app.pages.forms import Fields
from app.pages.frame import moved, page, units_of
from app.pages.measures import Units
from app.pages.recipes import said
from app.pages.result_parts import facts
from app.pages.submitting import checked, submit
from app.pages.views.result import Point
from app.pages.what_if.documents import ties_phases
from app.pages.what_if.moved_lines import as_job, loops_looked_at, speeds_of, to_look
from app.pages.what_if.sliders import Slider, sliders
from app.pages.wording import word_for, words
from app.routes.dependencies import CallerOf, Readers
from app.routes.job_status import find_job
from app.routes.previews import preview
from app.schemas.faults import BadInput, Fault
from app.security.caller import Caller
from app.storage import stored_results
from app.tables import Job

_SCRIPT_WORDS = ("kept", "busy", "too_often", "too_long", "signed_out", "refused")

router = APIRouter(include_in_schema=False, prefix="/pages/jobs/{job_id}/what-if", route_class=KnownParametersRoute)


@dataclass(frozen=True, slots=True)
class _Base:
    """A job's request as it was said, its explicit line, and the sliders of both."""

    job: Job
    point: int
    request: Mapping[str, Any]
    explicit: Mapping[str, Any]
    sliders: Mapping[str, Slider]


@router.get("")
def what_if(request: Request, job_id: UUID, caller: CallerOf, readers: Readers, point: Point = 0) -> Response:
    """Return the page with the sliders where the line has its values."""
    return _shown(request, _base(readers, caller, (job_id, point), units_of(request)), {}, ())


@router.post("/curves")
async def curves_of_moved_line(
    request: Request, job_id: UUID, caller: CallerOf, readers: Readers, fields: Fields, point: Point = 0
) -> Response:
    """Return the curves, the verdict and the figures of the line with its sliders where the form says.

    A form without values is the line as it is.
    """
    units = units_of(request)
    base = await to_thread.run_sync(lambda: _base(readers, caller, (job_id, point), units))
    if ties_phases(base.explicit):
        raise ProblemError(ProblemKind.TAKES_TOO_LONG, words().what_if.tied)
    try:
        sound = await beside_loop(
            request, lambda: checked(request, to_look(base.request, base.explicit, base.sliders, fields))
        )
    except BadInput as error:
        raise invalid_document(error.faults) from error
    kept, result = await preview(request, caller, sound)
    if result.failure is not None:
        raise invalid_document([Fault("/line", "failed", result.failure)])
    here = {"static": result.static, "warnings": result.warnings, "point": 0, "axes": {}}
    found = Findings(0, [here], kept["line"], kept["analysis"], result.tables)
    return JSONResponse(await to_thread.run_sync(_drawn, found, units))


@router.post("")
async def submit_moved_line(
    request: Request, job_id: UUID, caller: CallerOf, readers: Readers, fields: Fields, point: Point = 0
) -> Response:
    """Submit the line with its sliders where the form says, with the analysis of the job."""
    base = await to_thread.run_sync(lambda: _base(readers, caller, (job_id, point), units_of(request)))
    try:
        job = await submit(request, lambda: as_job(base.request, base.explicit, base.sliders, fields))
    except BadInput as error:
        return await to_thread.run_sync(_shown, request, base, fields, error.faults)
    return moved(request, f"/pages/jobs/{job.id}")


def _base(readers: sessionmaker[Session], caller: Caller, at: tuple[UUID, int], units: Units) -> _Base:
    """Return what is moved: the line of a job, at a point of its study if it has one.

    Raises
    ------
    ProblemError
        404 if there is no such job, or it computes lines of a batch.
    """
    with readers() as session:
        job = find_job(session, caller, at[0])
        if job.batch_id is not None:
            raise ProblemError(ProblemKind.NOT_FOUND, words().what_if.of_batch)
        axes = _axes(session, job, at[1])
    request = said(job.document)
    explicit = with_axes(job.document["line"], axes)
    # A study may vary a field that the engineer's form lacks; then the explicit line stands for both.
    own = all(_at(request["line"], path) is not None for path in axes)
    request["line"] = with_axes(request["line"], axes) if own else explicit
    speeds = speeds_of(job.document["analysis"])
    return _Base(job, at[1], request, explicit, sliders(request["line"], explicit, speeds, units))


def _at(line: Any, path: str) -> Any:
    for name in path.split("."):
        line = line.get(name) if isinstance(line, Mapping) else None
    return line


def _axes(session: Session, job: Job, point: int) -> Mapping[str, Any]:
    if not job.document.get("study"):
        return {}
    rows = (row for row in stored_results.points(session, job.id) if row["point"] == point)
    return next((row["axes"] for row in rows), {}) or {}


def _shown(request: Request, base: _Base, fields: Mapping[str, str], faults: Any) -> Response:
    values = {name: fields.get(name, slider.text) for name, slider in base.sliders.items()}
    said_words = words()
    own = said_words.what_if
    texts = {name: getattr(own, name) for name in _SCRIPT_WORDS}
    loops = loops_looked_at(base.request)
    count = said_words.loops.one if loops == [1] else own.loops.format(loops=own.between.join(map(str, loops)))
    return page(
        request,
        "what_if.html",
        422 if faults else 200,
        base=base,
        values=values,
        faults=faults,
        follows=not ties_phases(base.explicit),
        loops=count,
        script_words=json.dumps(texts),
        chart_words=json.dumps({**vars(said_words.chart), "before": own.before, "at": own.wind_now}),
    )


def _drawn(found: Findings, units: Units) -> Mapping[str, Any]:
    verdict, wind = found.verdict or {}, found.line["design_wind_m_per_s"]
    said_words = words()
    return {
        **curves(found, units),
        "at": units.value(wind, "m/s"),
        "gallops": verdict.get("gallops", "undecided"),
        "answer": word_for(said_words.gallops, verdict.get("gallops", "undecided")),
        "sentence": units.sentence(verdict.get("sentence", "")),
        "facts": facts(found, units),
    }
