"""What came of the lines of a batch, streamed in the order of their numbers, a bounded number in memory at a time."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal
from uuid import UUID

from sqlalchemy import Row, and_, func, select
from sqlalchemy.orm import Session

from app import results
from app.results import STATIC, TABLES
from app.tables import BatchItem, CriticalWindSpeedRow, FailureKind, Job, JobStatus, LimitCycleRow, PointRow

BatchTable = Literal["frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations", "summary"]

_LINES_A_FETCH = 200
_LABELS = ("number", "reference", "asset_id")
_OPEN = (JobStatus.ACCEPTED, JobStatus.RUNNING, JobStatus.DISMISSED)
_HARTOG = ("den_hartog_coefficient", "den_hartog_unstable")
_PEAKS = ("lowest_critical_wind_speed_m_per_s", "largest_vertical_m")


def columns(table: BatchTable) -> list[str]:
    """Return the names of a table's columns in order."""
    if table == "summary":
        return [*_LABELS, "status", "failure", *STATIC, *_HARTOG, *_PEAKS, "engine_version"]
    return [*_LABELS, *results.columns(table)]


def rows(session: Session, batch_id: UUID, table: BatchTable) -> Iterator[dict[str, Any]]:
    """Yield the rows of a table; the summary has one for every line, the others those of the lines that have any."""
    if table == "summary":
        for page in _pages(session, batch_id):
            yield from _summaries(session, page)
        return
    for page in _pages(session, batch_id):
        labels = {item.number: _labels(item) for item in page}
        for number, row in _rows_of(session, page, table):
            yield {**labels[number], **row}


def documents(session: Session, batch_id: UUID) -> Iterator[dict[str, Any]]:
    """Yield one object a line with everything that was found of it, or why there is nothing."""
    for page in _pages(session, batch_id):
        found: dict[int, dict[str, list[dict[str, Any]]]] = {
            item.number: {name: [] for name in TABLES} for item in page
        }
        for name in TABLES:
            for number, row in _rows_of(session, page, name):
                found[number][name].append(row)
        for item in page:
            yield {**_labels(item), **_state(item), **_point(item), **found[item.number]}


def errors(session: Session, batch_id: UUID, most: int | None = None) -> Iterator[dict[str, Any]]:
    """Yield what is wrong with rejected lines: number, reference, and pointer, code and sentence of each fault."""
    wanted = BatchItem.number, BatchItem.reference, BatchItem.faults
    rejected = BatchItem.batch_id == batch_id, BatchItem.chunk_id.is_(None)
    statement = select(*wanted).where(*rejected).order_by(BatchItem.number).limit(most)
    for number, reference, faults in session.execute(statement.execution_options(yield_per=_LINES_A_FETCH)):
        for fault in faults or ():
            yield {"number": number, "reference": reference, **fault}


def _pages(session: Session, batch_id: UUID) -> Iterator[Sequence[Row[Any]]]:
    """Yield the lines with the state of their chunk and their point, some at a time."""
    of_line = and_(PointRow.job_id == BatchItem.chunk_id, PointRow.point == BatchItem.number)
    point = [getattr(PointRow, name) for name in (*STATIC, *_HARTOG, "warnings", "engine_version", "failure")]
    statement = (
        select(BatchItem.number, BatchItem.reference, BatchItem.asset_id, BatchItem.chunk_id, BatchItem.faults)
        .add_columns(Job.status, Job.failure_kind, Job.failure_detail, PointRow.point, *point)
        .outerjoin(Job, Job.id == BatchItem.chunk_id)
        .outerjoin(PointRow, of_line)
        .where(BatchItem.batch_id == batch_id)
        .order_by(BatchItem.number)
        .limit(_LINES_A_FETCH)
    )
    last = 0
    while page := session.execute(statement.where(BatchItem.number > last)).all():
        yield page
        last = page[-1].number


def _rows_of(session: Session, page: Sequence[Row[Any]], table: results.Table) -> Iterator[tuple[int, dict[str, Any]]]:
    row_type = results.row_type(table)
    names = results.columns(table)
    wanted = [row_type.__table__.columns[name] for name in names]
    statement = (
        select(row_type.job_id, row_type.point, *wanted)
        .where(row_type.job_id.in_(_chunks(page)), row_type.point.between(page[0].number, page[-1].number))
        .order_by(row_type.point, row_type.row_number)
    )
    solved = {item.number for item in page if item.point is not None and item.failure is None}
    owners = {item.number: item.chunk_id for item in page}
    for job_id, number, *values in session.execute(statement):
        if number in solved and owners[number] == job_id:
            yield number, dict(zip(names, values, strict=True))


def _summaries(session: Session, page: Sequence[Row[Any]]) -> Iterator[dict[str, Any]]:
    lowest = _peaks(session, page, func.min(CriticalWindSpeedRow.wind_speed_m_per_s), CriticalWindSpeedRow)
    largest = _peaks(session, page, func.max(LimitCycleRow.vertical_m), LimitCycleRow)
    for item in page:
        peaks = (lowest.get((item.chunk_id, item.number)), largest.get((item.chunk_id, item.number)))
        state = _state(item)
        yield {
            **_labels(item),
            "status": state["status"],
            "failure": state["failure"]["detail"] if state["failure"] else None,
            **{name: getattr(item, name) for name in (*STATIC, *_HARTOG)},
            **dict(zip(_PEAKS, peaks, strict=True)),
            "engine_version": item.engine_version,
        }


def _peaks(
    session: Session, page: Sequence[Row[Any]], peak: Any, row_type: type[CriticalWindSpeedRow] | type[LimitCycleRow]
) -> Mapping[tuple[UUID, int], float | None]:
    between = row_type.point.between(page[0].number, page[-1].number)
    statement = select(row_type.job_id, row_type.point, peak).where(row_type.job_id.in_(_chunks(page)), between)
    found = session.execute(statement.group_by(row_type.job_id, row_type.point))
    return {(job_id, number): value for job_id, number, value in found}


def _chunks(page: Sequence[Row[Any]]) -> list[UUID]:
    return list({item.chunk_id for item in page if item.chunk_id is not None})


def _labels(item: Row[Any]) -> dict[str, Any]:
    return {name: getattr(item, name) for name in _LABELS}


def _state(item: Row[Any]) -> dict[str, Any]:
    """Return status and failure of a line, which follow from its chunk and its point."""
    if item.chunk_id is None:
        sentence = "; ".join(f"{fault['pointer'] or '/'}: {fault['detail']}" for fault in item.faults)
        return {"status": "rejected", "failure": {"kind": FailureKind.INPUT.value, "detail": sentence}}
    if item.point is not None and item.failure is None:
        return {"status": JobStatus.SUCCESSFUL.value, "failure": None}
    if item.status in _OPEN:
        return {"status": item.status.value, "failure": None}
    if item.failure is not None:
        failure = {"kind": FailureKind.NO_CONVERGENCE.value, "detail": item.failure}
    else:
        failure = {"kind": item.failure_kind.value, "detail": item.failure_detail}
    return {"status": JobStatus.FAILED.value, "failure": failure}


def _point(item: Row[Any]) -> dict[str, Any]:
    solved = item.point is not None and item.failure is None
    hartog = {"coefficient": item.den_hartog_coefficient, "unstable": item.den_hartog_unstable}
    return {
        "static": {name: getattr(item, name) for name in STATIC} if solved else None,
        "den_hartog": hartog if solved else None,
        "warnings": item.warnings or [],
        "engine_version": item.engine_version,
    }
