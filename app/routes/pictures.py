"""Pictures of a job: those of one point, and that of a whole study."""

from collections.abc import Awaitable, Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal
from uuid import UUID

from fastapi import APIRouter, Depends, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app import convert, plots
from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.interactive import Workshop
from app.routes import documentation
from app.routes.dependencies import PREFIX, CallerOf, Readers
from app.routes.finished_jobs import FinishedJob
from app.routes.results import point_rows, request_of_point
from app.storage import stored_results
from app.tables import Job

router = APIRouter(prefix=f"{PREFIX}/jobs/{{job_id}}/plots", tags=["results"], route_class=KnownParametersRoute)

PictureFormat = Literal["svg", "png", "pdf"]
Tables = dict[str, list[dict[str, Any]]]

# Type checkers see any text in the names of the registry.
if TYPE_CHECKING:
    PointPicture = str
else:
    PointPicture = Literal[tuple(name for name, picture in plots.PICTURES.items() if not picture.whole)]

_PROBLEMS = {
    **documentation.UNCHANGED,
    **documentation.problems(
        ProblemKind.NOT_FOUND, ProblemKind.NOT_READY, ProblemKind.DISMISSED, ProblemKind.INVALID_PARAMETER
    ),
}
_SHOWN = "; ".join(f"{name}: {picture.title}" for name, picture in plots.PICTURES.items() if not picture.whole)

Draw = Callable[[str, plots.Found, plots.Facts, plots.Options], Awaitable[bytes]]


async def _drawer(request: Request, caller: CallerOf) -> Draw:
    studio: Workshop = request.app.state.studio

    async def drawn(name: str, found: plots.Found, facts: plots.Facts, options: plots.Options) -> bytes:
        return await studio.run(caller.owner, plots.draw, name, found, facts, options)

    return drawn


Drawer = Annotated[Draw, Depends(_drawer)]
Side = Annotated[float, Field(ge=plots.SMALLEST_PX, le=plots.LARGEST_PX)]


class _Look(BaseModel):
    """Theme and size of a picture."""

    model_config = ConfigDict(extra="forbid")

    theme: Literal["light", "dark"] = Field(default="light", description="Colours on white, or on black")
    width: Side | None = Field(default=None, description="Width [px]; 1000 if absent (1600 as PNG)")
    height: Side | None = Field(default=None, description="Height [px]; what the panels need if absent")


class PointQuery(_Look):
    """Look of a picture, and the point of the study that it shows."""

    point: int = Field(default=0, ge=0, description="Number of the study's point, from 0")


class StudyQuery(_Look):
    """Look of the picture of a study."""

    abscissa: Literal["reduced", "parameter"] = Field(
        default="reduced", description="Abscissa: ratios as in the source, or values in the field's unit"
    )


@router.get(
    "/study.{extension}",
    summary="Draw the study of a job",
    response_class=Response,
    responses={200: documentation.PICTURE_ANSWER, **_PROBLEMS},
)
async def study_plot(
    extension: PictureFormat,
    finished: FinishedJob,
    drawer: Drawer,
    readers: Readers,
    query: Annotated[StudyQuery, Query()],
) -> Response:
    """Draw all points of a study over the varied field, or as a map over two fields."""
    options = plots.Options(extension, query.theme, query.width, query.height, abscissa=query.abscissa)
    job, headers = finished.job, finished.headers(f"study {options} {plots.EDITION}")

    def read() -> tuple[Tables, plots.Facts]:
        with readers() as session:
            found = study_rows(session, job.id)
        return found, plots.facts_of(job.name or str(job.id), job.document, None, found, job.engine_version)

    found, facts = await run_in_threadpool(read)
    drawn = await drawer("study", found, facts, options)
    return Response(drawn, headers=headers, media_type=plots.MEDIA_TYPES[extension])


@router.get(
    "/{picture}.{extension}",
    summary="Draw a point of a job",
    description=f"Draw one point of a study, or the only one of another job. {_SHOWN}.",
    response_class=Response,
    responses={200: documentation.PICTURE_ANSWER, **_PROBLEMS},
)
async def point_plot(
    picture: PointPicture,
    extension: PictureFormat,
    finished: FinishedJob,
    drawer: Drawer,
    readers: Readers,
    query: Annotated[PointQuery, Query()],
) -> Response:
    """Draw amplitudes over wind speed, orbits at the observation point, or another picture of the registry."""
    options = plots.Options(extension, query.theme, query.width, query.height)
    job, headers = finished.job, finished.headers(f"{picture} {query.point} {options} {plots.EDITION}")

    def read() -> tuple[Tables, plots.Facts]:
        with readers() as session:
            return _of_point(session, job, query.point, picture)

    found, facts = await run_in_threadpool(read)
    drawn = await drawer(picture, found, facts, options)
    return Response(drawn, headers=headers, media_type=plots.MEDIA_TYPES[extension])


def _of_point(session: Session, job: Job, point: int, picture: str) -> tuple[Tables, plots.Facts]:
    """Return the rows that a picture needs, and the facts of the point's line."""
    everything = point_rows(session, job.id, point)
    document, number = request_of_point(session, job, point)
    static = next((p["static"] for p in stored_results.points(session, job.id) if p["point"] == point), None)
    facts = plots.facts_of(_title(job, document), document, static, everything, job.engine_version)
    needed = plots.PICTURES[picture]
    found = {name: everything[name] for name in needed.tables}
    if "orbits" in needed.computed:
        found["orbits"] = everything["orbits"]
    if "shapes" in needed.computed:
        found["shapes"] = _shapes(document, number)
    return found, facts


def _title(job: Job, document: Mapping[str, Any]) -> str:
    line = document.get("line") or {}
    return str(job.name or line.get("name") or job.id)


def _shapes(document: Mapping[str, Any], point: int) -> list[dict[str, Any]]:
    """Compute the mode shapes of a point anew, which costs less than storing them.

    Raises
    ------
    ProblemError
        404 if the line of the point has no mode shapes.
    """
    try:
        return convert.mode_shapes(document, point)
    except (ArithmeticError, ValueError) as error:
        raise ProblemError(ProblemKind.NOT_FOUND, f"The line has no mode shapes at point {point}.") from error


def study_rows(session: Session, job_id: UUID) -> Tables:
    """Return the rows that the picture of a study shows, each after the values of the axes."""
    points = list(stored_results.points(session, job_id))
    solved = [{**point["axes"], **point["static"]} for point in points if point["static"]]
    failed = [{**point["axes"], "failure": point["failure"]} for point in points if point["failure"]]
    tables = {
        name: list(stored_results.rows(session, job_id, name)) for name in ("critical_wind_speeds", "limit_cycles")
    }
    return {"static": solved, "failures": failed, **tables}
