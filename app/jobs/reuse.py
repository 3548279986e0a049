"""Reuse stored results: copy results of the same input and engine version to the owner's new job.

Copies stay when another job is removed. A job is looked up when it is posted, the lines of a batch when a worker takes
their chunk. A single line is found by its input, whether it was a job or part of a batch. A study or a search for
placements is found as a whole, by its job.
"""

import hashlib
import logging
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast
from uuid import UUID

import orjson
from sqlalchemy import (
    ARRAY,
    ColumnElement,
    String,
    Table,
    and_,
    bindparam,
    exists,
    func,
    insert,
    literal,
    select,
    update,
)
from sqlalchemy.orm import Session

from app.convert import NumberedLine, PointResult
from app.jobs import job_records
from app.storage import counters, stored_bytes
from app.storage.stored_results import RANKING_FIGURES, STATIC, CorruptResult, unpacked
from app.tables import Job, JobEventKind, JobStatus, PointRow

_POINTS = 100  # of a study that are held at once

_logger = logging.getLogger(__name__)

_LINE_ALONE = {"line", "analysis"}


@dataclass(frozen=True, slots=True)
class Source:
    """Stored results: those of a job, or of one line of a batch by its number in a chunk, and the bytes of a copy."""

    job_id: UUID
    line_number: int | None = None
    size: int = field(default=0, compare=False)


def find(
    session: Session, requests: Sequence[tuple[str, Mapping[str, Any]]], engine_version: str
) -> list[Source | None]:
    """Return for each owner and document the stored results of the same input by this engine version, labels ignored.

    Many lines cost one query, and one more for each that is found; each study or placement costs one, and one more to
    read its points. What is corrupt is reported and not found. The rows to copy are locked until the transaction ends,
    so that nobody removes them.
    """
    hashes = [hash_of(owner, document) for owner, document in requests]
    wanted = {line_hash for line_hash in hashes if line_hash is not None}
    known = _known(session, wanted, engine_version) if len(wanted) > 1 else wanted
    lines = {line_hash: _found_line(session, line_hash, engine_version) for line_hash in known}
    return [
        _found_whole(session, owner, document, engine_version) if line_hash is None else lines.get(line_hash)
        for line_hash, (owner, document) in zip(hashes, requests, strict=True)
    ]


def _known(session: Session, hashes: Collection[str], engine_version: str) -> Collection[str]:
    """Return the hashes with stored results; on SQLite, which runs in this process, return all and query one by one."""
    if session.get_bind().dialect.name != "postgresql":
        return hashes
    listed = bindparam("hashes", list(hashes), type_=ARRAY(String))
    each = func.unnest(listed).column_valued("wanted")  # no column of results: the subquery would take it for its own
    there = exists().where(PointRow.input_hash == each, *_usable(engine_version))
    return set(session.scalars(select(each).where(there)))


def _found_line(session: Session, line_hash: str, engine_version: str) -> Source | None:
    # Any match will do: an ORDER BY would make the database choose another index than the one on the input.
    columns = PointRow.job_id, PointRow.point, PointRow.batch_id, PointRow.tables, PointRow.orbits
    statement = select(*columns).where(PointRow.input_hash == line_hash, *_usable(engine_version))
    row = session.execute(statement.limit(1).with_for_update(read=True, key_share=True)).one_or_none()
    if row is None or not _is_sound(session, row):
        return None
    size = stored_bytes.of_points([row._asdict()])
    return Source(row.job_id, row.point if row.batch_id is not None else None, size)


def _is_sound(session: Session, row: Any) -> bool:
    """Tell whether a point is what was stored; report one that is not, and let nobody find it again."""
    try:
        unpacked(row.tables), unpacked(row.orbits)
    except CorruptResult as error:
        _logger.error("the stored result of point %d of job %s is corrupt: %s", row.point, row.job_id, error)
        place = PointRow.job_id == row.job_id, PointRow.point == row.point
        session.execute(update(PointRow).where(*place).values(input_hash=None))
        return False
    return True


def _are_sound(session: Session, job_id: UUID) -> bool:
    columns = select(PointRow.job_id, PointRow.point, PointRow.tables, PointRow.orbits)
    points = session.execute(columns.where(PointRow.job_id == job_id).order_by(PointRow.point)).yield_per(_POINTS)
    return all(_is_sound(session, row) for row in points)


def _found_whole(session: Session, owner: str, document: Mapping[str, Any], engine_version: str) -> Source | None:
    same = Job.owner == owner, Job.input_hash == job_records.input_hash(document), Job.batch_id.is_(None)
    usable = Job.status == JobStatus.SUCCESSFUL, Job.engine_version == engine_version
    statement = select(Job.id, Job.result_bytes).where(*same, *usable).order_by(Job.id).limit(1)
    found = session.execute(statement.with_for_update(read=True, key_share=True)).one_or_none()
    if found is None or not _are_sound(session, found.id):
        return None
    return Source(found.id, None, found.result_bytes)


def adopt(job: Job, source: Source, engine_version: str) -> None:
    """End a job that is not stored yet with the results of another job or line; `copy` gives it those later."""
    job.status, job.progress = JobStatus.SUCCESSFUL, 1.0
    job.started_at = job.finished_at = job.created_at
    job.engine_version, job.reused_from, job.result_bytes = engine_version, source.job_id, source.size


def copy(session: Session, job_id: UUID, source: Source) -> None:
    """Copy the results that a stored job has adopted, and record its end."""
    table = cast(Table, PointRow.__table__)
    copied, detail = [table.c.job_id == source.job_id], f"results of job {source.job_id}"
    own: dict[str, ColumnElement[Any]] = {"job_id": literal(job_id, table.c.job_id.type)}
    if source.line_number is not None:
        copied.append(table.c.point == source.line_number)
        detail = f"results of line {source.line_number} of a batch, in its chunk {source.job_id}"
        alone: dict[str, Any] = {"point": 0, "axes": {}, "batch_id": None}
        own |= {name: literal(value, table.c[name].type) for name, value in alone.items()}
    others = {column.name: column for column in table.columns}
    columns = {**others, **own}
    session.execute(insert(table).from_select(list(columns), select(*columns.values()).where(*copied)))
    job_records.record(session, job_id, JobEventKind.SUCCESSFUL, detail=detail)
    counters.add_end(session, JobStatus.SUCCESSFUL, chunk=False)


def hash_of(owner: str, document: Mapping[str, Any]) -> str | None:
    """Return the hash by which the line of a request is found; None if the request has a study or a placement."""
    if document.keys() != _LINE_ALONE:
        return None
    return _hashing(owner, document["analysis"])(document["line"])


def hashes(owner: str, analysis: Mapping[str, Any], lines: Sequence[NumberedLine]) -> dict[int, str]:
    """Return the hash of each line's input by the number of the line, labels ignored."""
    of = _hashing(owner, analysis)
    return {line.number: of(line.document, line.known) for line in lines}


def _hashing(owner: str, analysis: Mapping[str, Any]) -> Callable[..., str]:
    common = hashlib.sha256(orjson.dumps([owner, analysis], option=orjson.OPT_SORT_KEYS))

    def of(line: Mapping[str, Any], known: Mapping[str, Any] | None = None) -> str:
        whole = common.copy()
        whole.update(orjson.dumps(_unlabelled(line), option=orjson.OPT_SORT_KEYS))
        if known is not None:  # the same line has other results where they list what is assumed
            said = {**known, "line": _unlabelled(known["line"])}
            whole.update(orjson.dumps(said, option=orjson.OPT_SORT_KEYS))
        return whole.hexdigest()

    return of


def _unlabelled(line: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in line.items() if name not in job_records.LABELS}


def _usable(engine_version: str) -> tuple[ColumnElement[bool], ...]:
    return PointRow.failure.is_(None), PointRow.engine_version == engine_version


def stored(session: Session, wanted: Mapping[int, str], engine_version: str) -> list[PointResult]:
    """Return the stored results of these lines by this engine version, under the lines' numbers.

    A line computed several times has several copies; one of them is read. A corrupt one is reported and left out.
    """
    same = PointRow.input_hash.in_(set(wanted.values()))
    place = func.row_number().over(partition_by=PointRow.input_hash).label("place")
    copies = select(PointRow.job_id, PointRow.point, place).where(same, *_usable(engine_version)).subquery()
    one = PointRow.job_id == copies.c.job_id, PointRow.point == copies.c.point, copies.c.place == 1
    found = {row.input_hash: row for row in session.scalars(select(PointRow).join(copies, and_(*one)))}
    sound = {value: row for value, row in found.items() if _is_sound(session, row)}
    return [_as_result(sound[value], number) for number, value in wanted.items() if value in sound]


def _as_result(row: PointRow, number: int) -> PointResult:
    return PointResult(
        point=number,
        axes={"number": number},
        static={name: getattr(row, name) for name in STATIC},
        den_hartog={"coefficient": row.den_hartog_coefficient, "unstable": row.den_hartog_unstable},
        ranking_figures={name: getattr(row, name) for name in RANKING_FIGURES},
        tables_json=unpacked(row.tables),
        orbits_json=unpacked(row.orbits),
        warnings=row.warnings,
        engine_version=row.engine_version,
        failure=None,
        input_hash=row.input_hash,
        reused=True,
        verdict=row.verdict,
    )
