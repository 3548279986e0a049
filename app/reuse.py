"""What is stored already is not computed again: results of the same input and engine are copied for the same owner.

They are copied rather than referred to, so that each job keeps its own when another is removed. A job is looked up as
it is posted, the lines of a batch as a worker takes their chunk.
"""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any, cast
from uuid import UUID

import orjson
from sqlalchemy import Table, insert, literal, select
from sqlalchemy.orm import Session

from app import jobs
from app.convert import NumberedLine, PointResult
from app.results import PEAKS, STATIC, unpacked
from app.tables import Job, JobEventKind, JobStatus, PointRow


def find(session: Session, owner: str, document: Mapping[str, Any], engine_version: str) -> UUID | None:
    """Return a successful job of the owner with the same input, labels aside, computed by this version of the engine.

    Its row is locked until the end of the transaction, so that nobody removes what is to be copied.
    """
    same = Job.owner == owner, Job.input_hash == jobs.input_hash(document), Job.batch_id.is_(None)
    usable = Job.status == JobStatus.SUCCESSFUL, Job.engine_version == engine_version
    statement = select(Job.id).where(*same, *usable).order_by(Job.id).limit(1)
    with session.no_autoflush:  # jobs that are made together are written together
        return session.scalar(statement.with_for_update(read=True, key_share=True))


def answer(session: Session, job: Job, source: UUID, engine_version: str) -> None:
    """Give a new job the results of another, and end it."""
    job.status, job.progress, job.engine_version = JobStatus.SUCCESSFUL, 1.0, engine_version
    job.started_at = job.finished_at = job.created_at
    job.reused_from = source
    session.flush()
    table = cast(Table, PointRow.__table__)
    others = [column for column in table.columns if column.name != "job_id"]
    copied = select(literal(job.id, table.c.job_id.type), *others).where(table.c.job_id == source)
    session.execute(insert(table).from_select(["job_id", *(column.name for column in others)], copied))
    jobs.record(session, job.id, JobEventKind.SUCCESSFUL, detail=f"results of job {source}")


def hashes(owner: str, analysis: Mapping[str, Any], lines: Sequence[NumberedLine]) -> dict[int, str]:
    """Return what each line of an owner is found by, by its number: what is asked of it, labels aside."""
    common = hashlib.sha256(orjson.dumps([owner, analysis], option=orjson.OPT_SORT_KEYS))

    def of(line: NumberedLine) -> str:
        asked = {name: value for name, value in line.document.items() if name not in jobs.LABELS}
        whole = common.copy()
        whole.update(orjson.dumps(asked, option=orjson.OPT_SORT_KEYS))
        return whole.hexdigest()

    return {line.number: of(line) for line in lines}


def stored(session: Session, wanted: Mapping[int, str], engine_version: str) -> list[PointResult]:
    """Return the results of those of these lines that this version of the engine has computed, under their numbers."""
    usable = PointRow.failure.is_(None), PointRow.engine_version == engine_version
    statement = select(PointRow).where(PointRow.input_hash.in_(set(wanted.values())), *usable)
    found = {row.input_hash: row for row in session.scalars(statement)}
    return [_as_result(found[value], number) for number, value in wanted.items() if value in found]


def _as_result(row: PointRow, number: int) -> PointResult:
    return PointResult(
        point=number,
        axes={"number": number},
        static={name: getattr(row, name) for name in STATIC},
        den_hartog={"coefficient": row.den_hartog_coefficient, "unstable": row.den_hartog_unstable},
        peaks={name: getattr(row, name) for name in PEAKS},
        tables_json=unpacked(row.tables),
        orbits_json=unpacked(row.orbits),
        warnings=row.warnings,
        engine_version=row.engine_version,
        failure=None,
        input_hash=row.input_hash,
        reused=True,
    )
