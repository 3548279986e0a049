from datetime import UTC, datetime, timedelta, timezone

import pytest
from sqlalchemy import text
from sqlalchemy.exc import IntegrityError, StatementError
from sqlalchemy.orm import Session, sessionmaker

from app.tables import FailureKind, Job, JobStatus
from tests.documents import add_job, look


@pytest.mark.parametrize(
    ("change", "constraint"),
    [
        ("status = 'paused'", "ck_jobs_status"),
        ("status = 'failed'", "ck_jobs_failed_with_kind"),
        ("status = 'failed', failure_kind = 'bad luck'", "ck_jobs_failure_kind"),
        ("failure_kind = 'internal'", "ck_jobs_failed_with_kind"),
        ("status = 'running'", "ck_jobs_running_with_lease"),
    ],
)
def test_the_database_itself_refuses_states_that_cannot_be(
    sessions: sessionmaker[Session], change: str, constraint: str
) -> None:
    add_job(sessions)
    with pytest.raises(IntegrityError, match=constraint), sessions.begin() as session:
        session.execute(text(f"UPDATE jobs SET {change}"))


@pytest.mark.parametrize("kind", list(FailureKind))
def test_the_database_takes_every_failure_kind(sessions: sessionmaker[Session], kind: FailureKind) -> None:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        session.execute(text("UPDATE jobs SET status = 'failed', failure_kind = :kind"), {"kind": kind.value})
    assert look(sessions, job_id).failure_kind is kind


def test_moments_keep_their_instant_whatever_their_zone(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        job = session.get_one(Job, job_id)
        job.status = JobStatus.DISMISSED
        job.finished_at = datetime(2026, 7, 1, 2, 30, 0, 123456, tzinfo=timezone(timedelta(hours=5)))
    finished = look(sessions, job_id).finished_at
    assert finished is not None
    assert finished.isoformat() == datetime(2026, 6, 30, 21, 30, 0, 123456, tzinfo=UTC).isoformat()


def test_naive_moments_are_refused(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    with pytest.raises(StatementError, match="needs a time zone"), sessions.begin() as session:
        session.get_one(Job, job_id).finished_at = datetime(2026, 7, 1)
