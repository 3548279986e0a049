"""Results of a batch, streamed as NDJSON, JSON, CSV, Parquet, XLSX or GeoJSON, and the faults of rejected lines."""

from collections.abc import Container, Iterator
from typing import Annotated, Literal
from uuid import UUID

from fastapi import APIRouter, Query, Request
from fastapi.responses import StreamingResponse
from pydantic import BaseModel, Field
from sqlalchemy.orm import Session

from app import convert
from app.answers.batches import BatchErrors, BatchTableName
from app.batches import line_results
from app.export import formats
from app.export.exported_columns import exported_columns
from app.export.formats import Dialect
from app.http.conditional import strong_tag, unless_known
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.routes import batch_documentation, documentation
from app.routes.batch_status import require_results
from app.routes.dependencies import PREFIX, CallerOf, Readers
from app.routes.finished_jobs import KnownTags
from app.routes.streaming import streamed

router = APIRouter(prefix=f"{PREFIX}/batches/{{batch_id}}", tags=["batches"], route_class=KnownParametersRoute)

BatchFormat = Literal["ndjson", "json", "csv", "parquet", "xlsx", "geojson"]
MEDIA_TYPES: dict[BatchFormat, str] = {
    "ndjson": "application/x-ndjson",
    "json": formats.MEDIA_TYPES["json"],
    "csv": "text/csv",
    "parquet": formats.PARQUET,
    "xlsx": formats.XLSX,
    "geojson": formats.GEOJSON,
}


class ResultsQuery(BaseModel):
    """Which results of a batch to return, and in which format."""

    table: BatchTableName | None = Field(
        default=None,
        description="One table of flat rows; without it, NDJSON has all results, other formats the summary",
    )
    format: BatchFormat | None = Field(default=None, description="Format; takes precedence over the Accept header")
    dialect: Dialect = Field(default="plain", description=documentation.DIALECT)
    partial: bool = Field(default=False, description="Return the results so far, even if lines still wait or run")


@router.get(
    "/results",
    summary="Get the results of a batch",
    response_class=StreamingResponse,
    responses={
        200: batch_documentation.RESULTS_ANSWER,
        **documentation.UNCHANGED,
        **documentation.problems(
            ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_FOUND, ProblemKind.NOT_ACCEPTABLE, ProblemKind.NOT_READY
        ),
    },
)
def batch_results(
    batch_id: UUID,
    request: Request,
    caller: CallerOf,
    readers: Readers,
    asked: Annotated[ResultsQuery, Query()],
    known: KnownTags = "",
) -> StreamingResponse:
    """Return the results of the lines in the order of their numbers: one object with all results each, or one table.

    Every row has `number`, `reference` and `asset_id`. A line without results has its failure. GeoJSON has a feature
    for each line: the coordinates with which it was sent, or null, and the summary as properties.
    """
    form = asked.format or formats.preferred(request.headers.get("accept", ""), MEDIA_TYPES)
    if form is None:
        raise ProblemError(ProblemKind.NOT_ACCEPTABLE, f"Results are {', '.join(MEDIA_TYPES.values())}.")
    if asked.dialect != "plain" and form != "csv":
        raise query_fault("dialect", "is for CSV only")
    if form == "geojson" and asked.table not in {None, "summary"}:
        raise query_fault("table", "must be summary or absent for GeoJSON, which has one feature a line")
    state = require_results(readers, caller, batch_id, partial=asked.partial)
    # Results that may still change get no tag: it would have to be known before the last row is read.
    headers = unless_known(known, strong_tag(state, form, asked.dialect)) if state else {"Vary": "Accept"}
    name = None if asked.table is None else convert.TABLES_BY_ADDRESS.get(asked.table, "summary")

    return streamed(
        readers,
        lambda session: result_pieces(session, batch_id, (form, asked.dialect), name),
        MEDIA_TYPES[form],
        headers,
    )


def result_pieces(
    session: Session,
    batch_id: UUID,
    form: tuple[BatchFormat, Dialect],
    table: str | None,
    only: Container[int] | None = None,
) -> Iterator[str] | Iterator[bytes]:
    """Return the results of a batch's lines in a format and dialect, of one table or, with None, all of them.

    only: the numbers of the lines that are wanted, None for all.
    """
    kind, dialect = form
    if kind == "geojson":
        return formats.in_blocks(formats.geojson_text(line_results.features(session, batch_id, only)))
    if kind == "ndjson" and table is None:
        return formats.in_blocks(line_results.documents(session, batch_id, only))
    name = table or "summary"
    rows = line_results.rows(session, batch_id, name, only)
    if kind == "parquet":
        from app.export import parquet  # noqa: PLC0415 - pyarrow loads slowly, and only Parquet needs it

        return parquet.parquet_bytes(exported_columns(name, line_results.columns(name)), rows)
    if kind == "xlsx":
        from app.export import workbook  # noqa: PLC0415 - openpyxl loads slowly, and only workbooks need it

        return workbook.xlsx_bytes(name, exported_columns(name, line_results.columns(name)), rows)
    if kind == "csv":
        return formats.in_blocks(formats.csv_text(line_results.columns(name), rows, dialect))
    return formats.in_blocks(formats.json_text(name, rows) if kind == "json" else formats.ndjson_text(rows))


@router.get(
    "/errors",
    summary="Get the faults of rejected lines",
    response_class=StreamingResponse,
    responses={
        200: {
            **documentation.body("All faults", ("application/json", batch_documentation.ERRORS)),
            "model": BatchErrors,
        },
        **documentation.problems(ProblemKind.NOT_FOUND),
    },
)
def batch_errors(batch_id: UUID, caller: CallerOf, readers: Readers) -> StreamingResponse:
    """Return all faults of the lines that were rejected when the batch was received."""
    require_results(readers, caller, batch_id, partial=True)

    def pieces(session: Session) -> Iterator[str]:
        return formats.in_blocks(formats.json_text("errors", line_results.errors(session, batch_id)))

    return streamed(readers, pieces, "application/json", {})
