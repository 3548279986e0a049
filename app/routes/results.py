"""Results of a job, streamed: the whole document, and single tables as JSON, CSV, Parquet or XLSX."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Query, Request
from fastapi.responses import StreamingResponse
from sqlalchemy.orm import Session

from app import convert
from app.answers.results import ResultDocument, TableName
from app.batches import batch_records
from app.export import formats
from app.export.exported_columns import ExportedColumn, axis_columns, exported_columns
from app.export.formats import Dialect, Format
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.routes import documentation
from app.routes.dependencies import PREFIX, Readers
from app.routes.finished_jobs import FinishedJob
from app.routes.job_status import failure_of
from app.routes.streaming import streamed
from app.storage import stored_results
from app.tables import Job

router = APIRouter(prefix=f"{PREFIX}/jobs/{{job_id}}", tags=["results"], route_class=KnownParametersRoute)

Rows = Iterator[dict[str, object]]

_PROBLEMS = {
    **documentation.UNCHANGED,
    **documentation.problems(ProblemKind.NOT_FOUND, ProblemKind.NOT_READY, ProblemKind.DISMISSED),
}
_TABLE_PROBLEMS = {
    **_PROBLEMS,
    **documentation.problems(ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_ACCEPTABLE),
}


@router.get(
    "/results",
    summary="Get the results of a job",
    response_class=StreamingResponse,
    responses={
        200: {
            **documentation.body("All results", ("application/json", documentation.RESULT)),
            "model": ResultDocument,
        },
        **_PROBLEMS,
    },
)
def job_results(finished: FinishedJob, readers: Readers) -> StreamingResponse:
    """Return all results; for a failed job, those of its finished points and its failure."""
    job, headers = finished.job, finished.headers("json")

    def pieces(session: Session) -> Iterator[str]:
        points = list(stored_results.points(session, job.id))
        tables: dict[str, Rows] = {name: stored_results.rows(session, job.id, name) for name in convert.TABLES}
        return formats.in_blocks(formats.result_text(job.document, points, tables, failure_of(job)))

    return streamed(readers, pieces, formats.MEDIA_TYPES["json"], headers)


@router.get(
    "/results/{table}",
    summary="Get a result table of a job",
    response_class=StreamingResponse,
    responses={200: documentation.TABLE_ANSWER, **_TABLE_PROBLEMS},
)
def result_table(
    table: TableName,
    request: Request,
    finished: FinishedJob,
    readers: Readers,
    format: Annotated[Format | None, Query(description="Format; takes precedence over the Accept header")] = None,  # noqa: A002
    dialect: Annotated[Dialect, Query(description=documentation.DIALECT)] = "plain",
) -> StreamingResponse:
    """Return one table of flat rows as JSON, CSV, Parquet or XLSX, chosen by `?format=` or the Accept header."""
    chosen = format or formats.preferred_format(request.headers.get("accept", ""))
    if chosen is None:
        raise ProblemError(ProblemKind.NOT_ACCEPTABLE, f"Tables are {', '.join(formats.MEDIA_TYPES.values())}.")
    if dialect != "plain" and chosen != "csv":
        raise query_fault("dialect", "is for CSV only")
    job, headers = finished.job, finished.headers(f"{chosen} {dialect}")
    name = convert.TABLES_BY_ADDRESS[table]

    def pieces(session: Session) -> Iterator[str] | Iterator[bytes]:
        rows = stored_results.rows(session, job.id, name)
        if chosen == "parquet":
            from app.export import parquet  # noqa: PLC0415 - pyarrow loads slowly, and only Parquet needs it

            return parquet.parquet_bytes(_columns(job, name), rows)
        if chosen == "xlsx":
            from app.export import workbook  # noqa: PLC0415 - openpyxl loads slowly, and only workbooks need it

            return workbook.xlsx_bytes(name, _columns(job, name), rows)
        if chosen == "csv":
            return formats.in_blocks(formats.csv_text([*_axes(job), *convert.columns(name)], rows, dialect))
        return formats.in_blocks(formats.json_text(name, rows))

    return streamed(readers, pieces, formats.MEDIA_TYPES[chosen], headers)


def request_of_point(session: Session, job: Job, point: int) -> tuple[Mapping[str, Any], int]:
    """Return the request and the point number for a point of a job; the points of a chunk are lines."""
    if job.batch_id is None:
        return job.document, point
    analysis, lines = batch_records.lines_of_chunk(session, job.id, job.batch_id)
    return {"line": {line.number: line.document for line in lines}[point], "analysis": analysis}, 0


def _columns(job: Job, name: str) -> list[ExportedColumn]:
    """Return the columns of a table of a job, with those that stand before its own."""
    study = (job.document.get("study") or {"axes": []})["axes"]
    before = exported_columns("summary", ["number"]) if job.batch_id is not None else axis_columns(study)
    return [*before, *exported_columns(name, convert.columns(name))]


def _axes(job: Job) -> list[str]:
    """Return the names of the first columns of every row of a job."""
    study = job.document.get("study") or {"axes": []}
    return ["number"] if job.batch_id is not None else [axis["parameter"] for axis in study["axes"]]


def point_rows(session: Session, job_id: UUID, point: int) -> dict[str, list[dict[str, Any]]]:
    """Return the rows of one point of a job that pictures show.

    Raises
    ------
    ProblemError
        404 if there is no such point.
    """
    axes = next((p["axes"] for p in stored_results.points(session, job_id) if p["point"] == point), None)
    if axes is None:
        raise ProblemError(ProblemKind.NOT_FOUND, f"The job has no results at point {point}.")
    wanted = dict(axes) if isinstance(axes, dict) else {}

    def at_point(name: str) -> list[dict[str, Any]]:
        rows = stored_results.rows(session, job_id, name)
        return [row for row in rows if all(row[key] == value for key, value in wanted.items())]

    found: dict[str, list[dict[str, Any]]] = {name: at_point(name) for name in convert.TABLES}
    found["orbits"] = [orbit for orbit in stored_results.orbits(session, job_id) if orbit["point"] == point]
    return found
