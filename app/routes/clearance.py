"""Clearance between two phases: computed motions beside the ellipses of design practice."""

from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

from app import convert
from app.answers.clearance import Clearance
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.routes import documentation
from app.routes.dependencies import PREFIX, Readers
from app.routes.finished_jobs import FinishedJob
from app.routes.results import point_rows, request_of_point
from app.schemas.fields import example_of
from app.storage import stored_results

router = APIRouter(prefix=f"{PREFIX}/jobs/{{job_id}}", tags=["results"])

Spacing = Annotated[float, Field(ge=-100.0, le=100.0)]


class ClearanceQuery(BaseModel):
    """Where the other phase hangs, and whose ellipse is held against the motions."""

    model_config = ConfigDict(extra="forbid")

    vertical_spacing_m: Spacing = Field(default=0.0, description="How far the other phase lies above [m]")
    horizontal_spacing_m: Spacing = Field(default=0.0, description="How far the other phase lies downwind [m]")
    method: convert.EllipseMethodName = Field(default="cigre", description="Whose ellipse")
    point: int = Field(default=0, ge=0, description="Point of a study")


@router.get(
    "/clearance",
    response_model=Clearance,
    responses={
        200: documentation.body("What is left", ("application/json", example_of(Clearance))),
        **documentation.UNCHANGED,
        **documentation.problems(
            ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_FOUND, ProblemKind.NOT_READY, ProblemKind.DISMISSED
        ),
    },
)
def clearance(finished: FinishedJob, asked: Annotated[ClearanceQuery, Query()], readers: Readers) -> JSONResponse:
    """Tell how near two phases come that gallop alike, each anywhere in its envelope: motion by motion, and by ellipse.

    The envelope is the convex hull of the paths of all sub-conductors; conductors are taken as lines.
    """
    job, headers = finished.job, finished.headers("json")
    offset = asked.vertical_spacing_m, asked.horizontal_spacing_m
    if offset == (0.0, 0.0):
        raise query_fault("vertical_spacing_m", "the other phase cannot hang in the same place")
    with readers() as session:
        found = point_rows(session, job.id, asked.point)
        points = stored_results.points(session, job.id)
        found["static"] = [p["static"] for p in points if p["point"] == asked.point and p["static"]]
        request = request_of_point(session, job, asked.point)
    if not found["static"]:
        raise ProblemError(ProblemKind.NOT_FOUND, f"The job has no results at point {asked.point}.")
    return JSONResponse(convert.clearances(request, found, offset, asked.method), headers=headers)
