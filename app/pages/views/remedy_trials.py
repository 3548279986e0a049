"""Compare remedies on the line of a job: a button of its result makes another job of it."""

from typing import Any
from uuid import UUID

from fastapi import APIRouter, Request, Response

from app.http.problems import ProblemError, ProblemKind, invalid_document
from app.http.strict_routes import KnownParametersRoute
from app.pages.forms import Fields
from app.pages.frame import moved
from app.pages.recipes import said
from app.pages.submitting import submit
from app.pages.wording import words
from app.routes.dependencies import CallerOf, Readers
from app.routes.job_status import find_job
from app.schemas.faults import BadInput

router = APIRouter(include_in_schema=False, route_class=KnownParametersRoute)

_INSTEAD = {"study", "placement", "remedies", "webhook_url"}


@router.post("/pages/jobs/{job_id}/remedies")
async def try_remedies(request: Request, job_id: UUID, caller: CallerOf, readers: Readers, fields: Fields) -> Response:
    """Submit the line of a job with the usual remedies, by the hybrid model.

    Raises
    ------
    ProblemError
        404 if there is no such job or it computes lines of a batch; 422 if the line cannot have remedies.
    """
    del fields

    def trial() -> dict[str, Any]:
        with readers() as session:
            job = find_job(session, caller, job_id)
        if job.batch_id is not None:
            raise ProblemError(ProblemKind.NOT_FOUND, words().what_if.of_batch)
        document = {name: value for name, value in said(job.document).items() if name not in _INSTEAD}
        return {**document, "analysis": {**(document.get("analysis") or {}), "models": ["hybrid"]}, "remedies": {}}

    try:
        made = await submit(request, trial)
    except BadInput as error:
        raise invalid_document(error.faults) from error
    return moved(request, f"/pages/jobs/{made.id}")
