"""Clearance between two phases: computed motions beside the ellipses of design practice."""

from typing import Annotated

from fastapi import APIRouter, Query, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

from app import convert
from app.answers.clearance import Clearance
from app.export import formats
from app.export.clearance_report import COLUMNS, report_rows
from app.export.formats import Dialect
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.routes import documentation
from app.routes.dependencies import PREFIX, Readers
from app.routes.finished_jobs import FinishedJob
from app.routes.results import point_rows, request_of_point
from app.schemas.fields import example_of
from app.storage import stored_results

router = APIRouter(prefix=f"{PREFIX}/jobs/{{job_id}}", tags=["results"], route_class=KnownParametersRoute)

Spacing = Annotated[float, Field(ge=-100.0, le=100.0)]


class ClearanceQuery(BaseModel):
    """The position of the other phase, and the method whose ellipse to compare with the motions."""

    model_config = ConfigDict(extra="forbid")

    vertical_spacing_m: Spacing = Field(default=0.0, description="Height of the other phase above this one [m]")
    horizontal_spacing_m: Spacing = Field(
        default=0.0, description="Distance of the other phase downwind of this one [m]"
    )
    method: convert.EllipseMethodName = Field(default="cigre", description="Method that gives the ellipse")
    point: int = Field(default=0, ge=0, description="Number of the study's point, from 0")


@router.get(
    "/clearance",
    summary="Get the clearance between two phases",
    response_model=Clearance,
    responses={
        200: documentation.body("The clearances", ("application/json", example_of(Clearance))),
        **documentation.UNCHANGED,
        **documentation.problems(
            ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_FOUND, ProblemKind.NOT_READY, ProblemKind.DISMISSED
        ),
    },
)
def clearance_between_phases(
    finished: FinishedJob, query: Annotated[ClearanceQuery, Query()], readers: Readers
) -> JSONResponse:
    """Return the clearance between two phases that gallop alike, for each motion and for an ellipse of design practice.

    Each phase may be anywhere in its envelope, the convex hull of the paths of all sub-conductors. Conductors have no
    thickness here.
    """
    job, headers = finished.job, finished.headers("json")
    offset = query.vertical_spacing_m, query.horizontal_spacing_m
    if offset == (0.0, 0.0):
        raise query_fault(
            "vertical_spacing_m",
            "must differ from 0 unless horizontal_spacing_m does: two phases cannot hang at the same place",
        )
    with readers() as session:
        found = point_rows(session, job.id, query.point)
        points = stored_results.points(session, job.id)
        found["static"] = [p["static"] for p in points if p["point"] == query.point and p["static"]]
        request = request_of_point(session, job, query.point)
    if not found["static"]:
        raise ProblemError(ProblemKind.NOT_FOUND, f"The job has no results at point {query.point}.")
    return JSONResponse(convert.clearances(request, found, offset, query.method), headers=headers)


@router.get(
    "/clearance-report",
    summary="Get the clearances as a report that utilities process",
    response_class=Response,
    responses={
        200: documentation.body("The report", ("text/csv", ",".join(COLUMNS))),
        **documentation.UNCHANGED,
        **documentation.problems(
            ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_FOUND, ProblemKind.NOT_READY, ProblemKind.DISMISSED
        ),
    },
)
def clearance_report(
    finished: FinishedJob,
    readers: Readers,
    dialect: Annotated[Dialect, Query(description=documentation.DIALECT)] = "plain",
    point: Annotated[int, Query(ge=0, description="Number of the study's point, from 0")] = 0,
) -> Response:
    """Return the table `clearances` as CSV under the names of clearance reports, lengths in m and angles in degrees.

    The structure is the tag `structure` of the line, else its asset_id, else its name; the set is its tag `set`.

    Raises
    ------
    ProblemError
        404 if the job has no results at this point.
    """
    job, headers = finished.job, finished.headers(f"clearance report {dialect}")
    with readers() as session:
        tables = stored_results.tables_of_point(session, job.id, point)
        if tables is None:
            raise ProblemError(ProblemKind.NOT_FOUND, f"The job has no results at point {point}.")
        request, _ = request_of_point(session, job, point)
    rows = report_rows(request["line"], tables.get("clearances", []))
    text = "".join(formats.csv_text(COLUMNS, rows, dialect))
    return Response(text, headers=headers, media_type=formats.MEDIA_TYPES["csv"])
