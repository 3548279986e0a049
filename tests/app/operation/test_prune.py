from datetime import timedelta
from uuid import UUID

import pytest
from sqlalchemy import func, select, update
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.operation import prune
from app.operation.prune import Pruned, Retention
from app.security import audit
from app.security.caller import LOCAL
from app.tables import (
    AuditAction,
    AuditEvent,
    Base,
    Batch,
    BatchItem,
    Job,
    JobEvent,
    JobTag,
    PointRow,
)
from tests.batch_rows import add_batch, claim, run
from tests.documents import add_job, create_job, look, point_result

KEPT = Retention(timedelta(days=30), timedelta(days=365))
DAYS = timedelta(days=1)


def rows(sessions: sessionmaker[Session], table: type[Base]) -> int:
    with sessions() as session:
        return session.scalar(select(func.count()).select_from(table)) or 0


def finished(sessions: sessionmaker[Session], days_ago: int) -> UUID:
    """Make a job with a tag and a result that ended so long ago."""
    with sessions.begin() as session:
        job_id = create_job(session, LOCAL, {"line": {}}, tags={"a": "b"}).id
    with sessions.begin() as session:
        held = leases.claim(session, job_id, "here", 60.0)
        assert held is not None
        leases.finish(session, held, [point_result()])
    age(sessions, days_ago, Job.id == job_id)
    return job_id


def age(sessions: sessionmaker[Session], days: int, *which: object) -> None:
    """Move jobs into the past."""
    with sessions.begin() as session:
        for job in session.scalars(select(Job).where(*which)):  # type: ignore[arg-type]
            job.created_at -= days * DAYS
            job.finished_at = job.finished_at and job.finished_at - days * DAYS


def age_batch(sessions: sessionmaker[Session], days: int, batch_id: UUID) -> None:
    age(sessions, days, Job.batch_id == batch_id)
    with sessions.begin() as session:
        batch = session.get_one(Batch, batch_id)
        batch.created_at -= days * DAYS


def test_what_ended_long_ago_goes_with_all_that_hangs_on_it(sessions: sessionmaker[Session]) -> None:
    for days in (31, 40):
        finished(sessions, days)
    recent = finished(sessions, 29)
    expected = Pruned(jobs=2, batches=0, lines=0, audit_events=0)
    assert prune.due(sessions, KEPT) == expected
    assert [rows(sessions, table) for table in (Job, JobTag, PointRow)] == [3, 3, 3]
    assert prune.prune(sessions, KEPT) == expected
    assert [rows(sessions, table) for table in (Job, JobTag, PointRow, JobEvent)] == [1, 1, 1, 3]
    assert look(sessions, recent).id == recent
    assert prune.prune(sessions, KEPT) == Pruned(0, 0, 0, 0)


def test_what_waits_or_runs_is_kept_however_old(sessions: sessionmaker[Session]) -> None:
    waiting, running = add_job(sessions), add_job(sessions)
    with sessions.begin() as session:
        leases.claim(session, running, "here", 60.0)
    age(sessions, 1000, Job.id.in_((waiting, running)))
    assert prune.prune(sessions, KEPT) == prune.due(sessions, KEPT) == Pruned(0, 0, 0, 0)
    assert rows(sessions, Job) == 2


def test_a_batch_goes_whole_or_not_at_all(sessions: sessionmaker[Session]) -> None:
    over, chunks = add_batch(sessions, 3, 2, rejected=1)
    part_recent, (old, recent) = add_batch(sessions, 2, 2)
    part_open, (done, _open) = add_batch(sessions, 2, 2)
    for chunk in (*chunks, old, recent, done):
        run(sessions, chunk)
    claim(sessions, _open)
    for batch_id in (over, part_recent, part_open):
        age_batch(sessions, 40, batch_id)
    age(sessions, -20, Job.id == recent)
    expected = Pruned(jobs=0, batches=1, lines=5, audit_events=0)
    assert prune.due(sessions, KEPT) == expected
    assert prune.prune(sessions, KEPT) == expected
    with sessions() as session:
        assert set(session.scalars(select(Batch.id))) == {part_recent, part_open}
        assert set(session.scalars(select(Job.batch_id))) == {part_recent, part_open}
        assert set(session.scalars(select(BatchItem.batch_id))) == {part_recent, part_open}
    assert rows(sessions, BatchItem) == 8


def test_a_run_that_was_cut_off_is_taken_up_by_the_next(
    sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    batch_id, chunks = add_batch(sessions, 3, 2)
    for chunk in chunks:
        run(sessions, chunk)
    age_batch(sessions, 40, batch_id)
    with monkeypatch.context() as patch:
        patch.setattr(prune, "_delete_lines", broken)
        with pytest.raises(ZeroDivisionError):
            prune.prune(sessions, KEPT)
    assert [rows(sessions, table) for table in (Batch, Job, BatchItem)] == [1, 0, 5]
    assert prune.prune(sessions, KEPT).lines == 5
    assert [rows(sessions, table) for table in (Batch, Job, BatchItem)] == [0, 0, 0]


def broken(*_: object) -> int:
    raise ZeroDivisionError


def test_chunks_whose_batch_is_gone_go_too(sessions: sessionmaker[Session]) -> None:
    batch_id, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk)
    age_batch(sessions, 40, batch_id)
    with sessions.begin() as session:
        session.delete(session.get_one(Batch, batch_id))
    assert prune.prune(sessions, KEPT) == Pruned(0, 0, 0, 0)
    assert rows(sessions, Job) == 0


def test_no_transaction_removes_more_than_its_share(
    sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("_JOBS_AT_ONCE", "_LINES_AT_ONCE", "_EVENTS_AT_ONCE"):
        monkeypatch.setattr(prune, name, 2)
    for _ in range(5):
        finished(sessions, 40)
    batch_id, chunks = add_batch(sessions, 1, 1, 1)
    for chunk in chunks:
        run(sessions, chunk)
    age_batch(sessions, 40, batch_id)
    assert prune.prune(sessions, KEPT) == Pruned(jobs=5, batches=1, lines=3, audit_events=0)
    assert [rows(sessions, table) for table in (Job, Batch, BatchItem, PointRow)] == [0, 0, 0, 0]


def test_the_record_has_a_time_of_its_own_and_tells_of_the_run(sessions: sessionmaker[Session]) -> None:
    finished(sessions, 40)
    with sessions.begin() as session:
        audit.record(session, LOCAL, AuditAction.JOB_REMOVED)
        session.execute(
            update(AuditEvent)
            .where(AuditEvent.action == AuditAction.JOB_REMOVED)
            .values(at=session.scalars(select(AuditEvent.at).limit(1)).one() - 366 * DAYS)
        )
    assert prune.due(sessions, KEPT).audit_events == 1
    assert prune.prune(sessions, KEPT).audit_events == 1
    with sessions() as session:
        newest, *rest = audit.latest(session, None, None, 10)
    assert [event.action for event in rest] == [AuditAction.JOB_SUBMITTED]
    assert (newest.action, newest.owner) == (AuditAction.PRUNED, "operator")
    assert newest.detail is not None and newest.detail.endswith("1 jobs, 0 batches, 0 lines, 1 audit events")
