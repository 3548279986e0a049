"""Results of a batch's lines, streamed in the order of their numbers with few lines in memory at a time."""

from collections.abc import Container, Iterable, Iterator, Sequence
from itertools import islice
from typing import Any
from uuid import UUID

import orjson
from sqlalchemy import Row, Select, and_, case, select
from sqlalchemy.orm import Session

from app import convert
from app.storage.pages import in_pages
from app.storage.stored_results import (
    RANKING_FIGURES,
    STATIC,
    UNKNOWN_MOTIONS,
    VERDICT,
    ranking_columns,
    tables_of,
    unpacked,
)
from app.tables import Batch, BatchItem, FailureKind, Job, JobStatus, PointRow

_LINES_A_FETCH = 200
_LABELS = ("number", "reference", "asset_id")
_OPEN = (JobStatus.ACCEPTED, JobStatus.RUNNING, JobStatus.DISMISSED)
_HARTOG = ("den_hartog_coefficient", "den_hartog_unstable")


def columns(table: str) -> list[str]:
    """Return the names of a table's columns in order."""
    if table == "summary":
        figures = *STATIC, *_HARTOG, *RANKING_FIGURES, UNKNOWN_MOTIONS
        return [*_LABELS, "name", "status", "failure", *VERDICT, *figures, "engine_version"]
    return [*_LABELS, *convert.columns(table)]


def rows(session: Session, batch_id: UUID, table: str, only: Container[int] | None = None) -> Iterator[dict[str, Any]]:
    """Yield the rows of a table: one for every line in the summary, otherwise the rows of each line's results.

    only: the numbers of the lines that are wanted, None for all.
    """
    for item in _lines(session, batch_id, in_short=table == "summary", only=only):
        if table == "summary":
            yield _summary(item)
        elif _is_solved(item):
            labels = _labels(item)
            found = tables_of(item.tables).get(table, [])
            for row in _with_computed(found, item.computed) if table == "assumptions" else found:
                yield {**labels, **row}


def features(session: Session, batch_id: UUID, only: Container[int] | None = None) -> Iterator[dict[str, Any]]:
    """Yield the summary of each line as a GeoJSON feature with the coordinates of the line, null if it has none."""
    for item in _lines(session, batch_id, in_short=True, only=only):
        yield _feature(item)


def tagged_features(session: Session, batch_id: UUID) -> Iterator[dict[str, Any]]:
    """Yield the features of all lines, each with the tags of its line beside its properties."""
    for item in _lines(session, batch_id, in_short=True):
        yield {**_feature(item), "tags": item.tags or {}}


def documents(session: Session, batch_id: UUID, only: Container[int] | None = None) -> Iterator[bytes]:
    """Yield for each line a JSON object, with a line end, that holds all its results or its failure."""
    for item in _lines(session, batch_id, in_short=False, only=only):
        # The packed tables are JSON already; splice them into the object without parsing.
        head = orjson.dumps({**_labels(item), **_state(item), **_point(item)})
        yield b"%b,%b\n" % (head[:-1], _tables(item)[1:])


def _tables(item: Row[Any]) -> bytes:
    """Return the tables of a line as a JSON object."""
    if not _is_solved(item) or not item.computed:
        return unpacked(item.tables if _is_solved(item) else None)
    tables = tables_of(item.tables)
    return orjson.dumps({**tables, "assumptions": _with_computed(tables.get("assumptions", []), item.computed)})


def _with_computed(rows: Iterable[dict[str, Any]], computed: Sequence[dict[str, Any]] | None) -> list[dict[str, Any]]:
    """Return rows of the table `assumptions`, in which values that follow from coordinates say so."""
    paths = {row["path"] for row in computed or ()}
    return [*(computed or ()), *(row for row in rows if row["path"] not in paths)]


def errors(session: Session, batch_id: UUID, most: int | None = None) -> Iterator[dict[str, Any]]:
    """Yield the faults of rejected lines: number, reference, row, and pointer, code and sentence of each fault."""
    columns = select(BatchItem.number, BatchItem.reference, BatchItem.faults)
    rejected = columns.where(BatchItem.batch_id == batch_id, BatchItem.chunk_id.is_(None))
    for item in islice(_pages(session, batch_id, rejected), most):
        for fault in item.faults or ():
            yield {"number": item.number, "reference": item.reference, "row": None, "place": None, **fault}


def _pages(session: Session, batch_id: UUID, statement: Select[*tuple[Any, ...]]) -> Iterator[Row[Any]]:
    return in_pages(session, statement, BatchItem.number, _LINES_A_FETCH, select(Batch.id).where(Batch.id == batch_id))


def _lines(
    session: Session, batch_id: UUID, *, in_short: bool, only: Container[int] | None = None
) -> Iterator[Row[Any]]:
    """Return the lines with the state of their chunk and their result, reading a page at a time.

    In short, they have name, tags and verdict, and their tables only if these were stored without the verdict.
    """
    of_line = and_(PointRow.job_id == BatchItem.chunk_id, PointRow.point == BatchItem.number)
    names = (*STATIC, *_HARTOG, *RANKING_FIGURES, "warnings", "engine_version", "failure")
    older = case((PointRow.verdict.is_(None), PointRow.tables), else_=None).label("tables")
    name = BatchItem.document["name"].as_string().label("name")
    tags = BatchItem.document["tags"].label("tags")
    short, whole = (PointRow.verdict, older, name, tags, BatchItem.geometry), (PointRow.tables, BatchItem.computed)
    statement = (
        select(BatchItem.number, BatchItem.reference, BatchItem.asset_id, BatchItem.chunk_id, BatchItem.faults)
        .add_columns(Job.status, Job.failure_kind, Job.failure_detail, PointRow.point)
        .add_columns(*(getattr(PointRow, name) for name in names), *(short if in_short else whole))
        .outerjoin(Job, Job.id == BatchItem.chunk_id)
        .outerjoin(PointRow, of_line)
        .where(BatchItem.batch_id == batch_id)
    )
    return (item for item in _pages(session, batch_id, statement) if only is None or item.number in only)


def _feature(item: Row[Any]) -> dict[str, Any]:
    return {"type": "Feature", "id": item.number, "geometry": item.geometry, "properties": _summary(item)}


def _summary(item: Row[Any]) -> dict[str, Any]:
    state = _state(item)
    verdict = item.verdict
    if verdict is None and _is_solved(item):
        verdict = next(iter(tables_of(item.tables).get("verdict", ())), None)
    return {
        **_labels(item),
        "name": item.name,
        "status": state["status"],
        "failure": state["failure"]["detail"] if state["failure"] else None,
        **{name: (verdict or {}).get(name) for name in VERDICT},
        **{name: getattr(item, name) for name in (*STATIC, *_HARTOG)},
        **ranking_columns(item),
        "engine_version": item.engine_version,
    }


def _is_solved(item: Row[Any]) -> bool:
    return item.point is not None and item.failure is None


def _labels(item: Row[Any]) -> dict[str, Any]:
    return {name: getattr(item, name) for name in _LABELS}


def _state(item: Row[Any]) -> dict[str, Any]:
    """Return the status and the failure of a line, from its chunk and its result."""
    if item.chunk_id is None:
        sentence = "; ".join(f"{fault['pointer'] or '/'}: {fault['detail']}" for fault in item.faults)
        return {"status": "rejected", "failure": {"kind": FailureKind.INPUT.value, "detail": sentence}}
    if _is_solved(item):
        return {"status": JobStatus.SUCCESSFUL.value, "failure": None}
    if item.status in _OPEN:
        return {"status": item.status.value, "failure": None}
    if item.failure is not None:
        failure = {"kind": FailureKind.NO_CONVERGENCE.value, "detail": item.failure}
    else:
        failure = {"kind": item.failure_kind.value, "detail": item.failure_detail}
    return {"status": JobStatus.FAILED.value, "failure": failure}


def _point(item: Row[Any]) -> dict[str, Any]:
    solved = _is_solved(item)
    hartog = {"coefficient": item.den_hartog_coefficient, "unstable": item.den_hartog_unstable}
    return {
        "static": {name: getattr(item, name) for name in STATIC} if solved else None,
        "den_hartog": hartog if solved else None,
        "warnings": item.warnings or [],
        "engine_version": item.engine_version,
    }
