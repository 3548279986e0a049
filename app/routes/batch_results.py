"""Results of a batch, streamed as NDJSON, JSON, CSV, Parquet, XLSX or GeoJSON, and the faults of rejected lines."""

from collections.abc import Iterator
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
from app.routes import batch_documentation, documentation
from app.routes.batch_status import require_results
from app.routes.dependencies import PREFIX, CallerOf, Readers
from app.routes.finished_jobs import KnownTags
from app.routes.streaming import streamed

router = APIRouter(prefix=f"{PREFIX}/batches/{{batch_id}}", tags=["batches"])

BatchFormat = Literal["ndjson", "json", "csv", "parquet", "xlsx", "geojson"]
_MEDIA_TYPES: dict[BatchFormat, str] = {
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
    form = asked.format or formats.preferred(request.headers.get("accept", ""), _MEDIA_TYPES)
    if form is None:
        raise ProblemError(ProblemKind.NOT_ACCEPTABLE, f"Results are {', '.join(_MEDIA_TYPES.values())}.")
    if asked.dialect != "plain" and form != "csv":
        raise query_fault("dialect", "is for CSV only")
    if form == "geojson" and asked.table not in {None, "summary"}:
        raise query_fault("table", "must be summary or absent for GeoJSON, which has one feature a line")
    state = require_results(readers, caller, batch_id, partial=asked.partial)
    # Results that may still change get no tag: it would have to be known before the last row is read.
    headers = unless_known(known, strong_tag(state, form, asked.dialect)) if state else {"Vary": "Accept"}
    name = convert.TABLES_BY_ADDRESS.get(asked.table or "summary", "summary")

    def pieces(session: Session) -> Iterator[str] | Iterator[bytes]:
        if form == "geojson":
            return formats.in_blocks(formats.geojson_text(line_results.features(session, batch_id)))
        if form == "ndjson" and asked.table is None:
            return formats.in_blocks(line_results.documents(session, batch_id))
        rows = line_results.rows(session, batch_id, name)
        if form == "parquet":
            from app.export import parquet  # noqa: PLC0415 - pyarrow loads slowly, and only Parquet needs it

            return parquet.parquet_bytes(exported_columns(name, line_results.columns(name)), rows)
        if form == "xlsx":
            from app.export import workbook  # noqa: PLC0415 - openpyxl loads slowly, and only workbooks need it

            return workbook.xlsx_bytes(name, exported_columns(name, line_results.columns(name)), rows)
        if form == "csv":
            return formats.in_blocks(formats.csv_text(line_results.columns(name), rows, asked.dialect))
        return formats.in_blocks(formats.json_text(name, rows) if form == "json" else formats.ndjson_text(rows))

    return streamed(readers, pieces, _MEDIA_TYPES[form], headers)


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
