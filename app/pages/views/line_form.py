"""The page on which a line is described and submitted."""

import json
from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Query, Request, Response

from app.pages import examples
from app.pages.forms import Fields
from app.pages.frame import moved, page
from app.pages.recipes import said
from app.pages.submitting import submit
from app.routes.dependencies import CallerOf, Readers
from app.routes.job_status import find_job
from app.schemas.faults import BadInput, parse_json

router = APIRouter(include_in_schema=False, prefix="/pages/lines")


@router.get("/new")
def new_line(
    request: Request,
    caller: CallerOf,
    readers: Readers,
    example: Annotated[str, Query(max_length=40)] = examples.DRAKE,
    job: UUID | None = None,
) -> Response:
    """Return the form, filled with an example or with the line of an earlier job."""
    if job is None:
        name = example if example in examples.NAMES else examples.DRAKE
        document: dict[str, Any] = {"line": examples.line(name), "analysis": examples.ANALYSIS}
    else:
        with readers() as session:
            document = said(find_job(session, caller, job).document)
    return page(request, "line.html", text=json.dumps(document, indent=1, ensure_ascii=False), faults=())


@router.post("/new")
async def submit_line(request: Request, fields: Fields) -> Response:
    """Submit what the form says; show it again with its faults if it has any."""
    text = fields.get("document", "")
    try:
        job = await submit(request, parse_json(text.encode()))
    except BadInput as error:
        return page(request, "line.html", 422, text=text, faults=error.faults)
    return moved(request, f"/pages/jobs/{job.id}")
