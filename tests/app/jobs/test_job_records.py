from datetime import UTC, datetime, timedelta
from uuid import UUID, uuid4

import pytest
from sqlalchemy import func, select, update
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import job_records, leases
from app.jobs.job_records import CancelOutcome, JobFilters
from app.security.caller import LOCAL, Owned
from app.tables import Job, JobEvent, JobStatus, JobTag, PointRow
from tests.documents import STRANGER, add_job, create_job, history, look, point_result
from tests.statements import counted

DOCUMENT = {"line": {"b": 1.5, "a": "é"}, "analysis": {"loops": [1]}}


def ids(found: list[Job]) -> list[UUID]:
    return [job.id for job in found]


def cancel(sessions: sessionmaker[Session], job_id: UUID) -> CancelOutcome:
    with sessions.begin() as session:
        return job_records.cancel(session, LOCAL, job_id)


def test_created_job_is_kept_whole(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        made = create_job(session, LOCAL, DOCUMENT, name="C11", asset_id="L1", tags={"region": "north", "ice": "D"})
    with sessions() as session:
        job = job_records.get(session, LOCAL.owner, made.id)
        assert job is not None
        assert (job.status, job.attempt, job.progress, job.dispatched_at) == (JobStatus.ACCEPTED, 0, 0.0, None)
        assert (job.name, job.asset_id, job.document) == ("C11", "L1", DOCUMENT)
        assert {tag.key: tag.value for tag in job.tags} == {"region": "north", "ice": "D"}
        assert abs(job.created_at - datetime.now(UTC)) < timedelta(seconds=60)
        assert job.id.version == 7
    assert history(sessions, made.id) == [("accepted", 0)]


def test_job_tags_and_event_are_one_transaction(sessions: sessionmaker[Session]) -> None:
    with pytest.raises(RuntimeError), sessions.begin() as session:
        create_job(session, LOCAL, DOCUMENT, tags={"a": "b"})
        raise RuntimeError
    with sessions() as session:
        counts = [session.scalar(select(func.count()).select_from(table)) for table in (Job, JobTag, JobEvent)]
    assert counts == [0, 0, 0]


def test_looking_up_a_job_names_its_owner_in_the_query(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    with counted() as statements:
        theirs, mine = job_records.look_up(sessions, [Owned(STRANGER.owner, job_id), Owned(LOCAL.owner, job_id)])
    assert theirs is None and mine is not None and mine.id == job_id
    with counted() as alone:
        assert job_records.look_up(sessions, [Owned(STRANGER.owner, job_id)]) == [None]
    assert all("(jobs.owner, jobs.id) IN" in found[0] for found in (statements, alone))
    assert (len(statements), len(alone)) == (2, 1)  # no row came back, so no tags were read


def test_input_hash_knows_values_but_not_the_order_of_fields() -> None:
    turned = {"analysis": {"loops": [1]}, "line": {"a": "é", "b": 1.5}}
    other = {"analysis": {"loops": [1]}, "line": {"a": "é", "b": 1.25}}
    assert job_records.input_hash(DOCUMENT) == job_records.input_hash(turned)
    assert job_records.input_hash(DOCUMENT) != job_records.input_hash(other)
    assert job_records.input_hash({"a": 1}) == "015abd7f5cc57a2dd94b7590f04ad8084273905ee33ec5cebeae62276a97f862"


def test_input_hash_refuses_what_json_cannot_carry() -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        job_records.input_hash({"a": float("nan")})


def test_pages_hold_every_job_once_newest_first(sessions: sessionmaker[Session]) -> None:
    made = [add_job(sessions) for _ in range(7)]
    with sessions.begin() as session:
        # Three of one moment: the ids decide among them.
        session.execute(update(Job).where(Job.id.in_(made[2:5])).values(created_at=look(sessions, made[3]).created_at))
    seen: list[UUID] = []
    after = None
    with sessions() as session:
        while found := job_records.page(session, LOCAL.owner, JobFilters(), after, 2):
            seen += ids(found)
            after = (found[-1].created_at, found[-1].id)
    assert seen == made[::-1]


def test_filters(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        north = create_job(session, LOCAL, DOCUMENT, asset_id="L1", tags={"region": "north", "ice": "C"})
    with sessions.begin() as session:
        south = create_job(session, LOCAL, DOCUMENT, asset_id="L2", tags={"region": "south", "ice": "C"})
    cancel(sessions, south.id)

    def found(filters: JobFilters) -> list[UUID]:
        with sessions() as session:
            return ids(job_records.page(session, LOCAL.owner, filters, None, 10))

    assert found(JobFilters(status=JobStatus.DISMISSED)) == [south.id]
    assert found(JobFilters(asset_id="L1")) == [north.id]
    assert found(JobFilters(tags={"ice": "C"})) == [south.id, north.id]
    assert found(JobFilters(tags={"ice": "C", "region": "north"})) == [north.id]
    assert found(JobFilters(tags={"north": "region"})) == []
    assert found(JobFilters(batch_id=uuid4())) == []
    assert found(JobFilters(created_after=north.created_at)) == [south.id]
    assert found(JobFilters(created_before=south.created_at)) == [north.id]


@pytest.mark.parametrize("asked", ["Br\u00e5", "Bra\u030a"])
@pytest.mark.parametrize("stored", ["Br\u00e5", "Bra\u030a"])
def test_labels_that_earlier_versions_stored_are_found_in_either_form(
    sessions: sessionmaker[Session], stored: str, asked: str
) -> None:
    with sessions.begin() as session:
        job_id = create_job(session, LOCAL, DOCUMENT, asset_id=stored, tags={stored: stored}).id
        create_job(session, LOCAL, DOCUMENT, asset_id="Bra", tags={"Bra": "Bra"})
    with sessions() as session:
        for filters in (JobFilters(asset_id=asked), JobFilters(tags={asked: asked})):
            assert ids(job_records.page(session, LOCAL.owner, filters, None, 10)) == [job_id]


def test_cancel_ends_a_queued_job_at_once(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    assert cancel(sessions, job_id) is CancelOutcome.DISMISSED
    job = look(sessions, job_id)
    assert job.status is JobStatus.DISMISSED
    assert job.finished_at is not None
    assert history(sessions, job_id) == [("accepted", 0), ("dismissed", 0)]


def test_cancel_asks_a_running_job_once(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        leases.claim(session, job_id, "here", 60.0)
    assert [cancel(sessions, job_id), cancel(sessions, job_id)] == [CancelOutcome.REQUESTED] * 2
    job = look(sessions, job_id)
    assert (job.status, job.cancel_requested) == (JobStatus.RUNNING, True)
    assert history(sessions, job_id) == [("accepted", 0), ("running", 1), ("cancel_requested", 1)]


def test_cancel_removes_a_finished_job_with_all_its_rows(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        job_id = create_job(session, LOCAL, DOCUMENT, tags={"a": "b"}).id
        held = leases.claim(session, job_id, "here", 60.0)
        assert held is not None
        leases.finish(session, held, [point_result()])
    assert cancel(sessions, job_id) is CancelOutcome.REMOVED
    with sessions() as session:
        counts = [
            session.scalar(select(func.count()).select_from(table)) for table in (Job, JobTag, JobEvent, PointRow)
        ]
    assert counts == [0, 0, 0, 0]
    assert cancel(sessions, job_id) is CancelOutcome.MISSING


def test_jobs_of_another_owner_are_not_there(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        theirs = create_job(session, STRANGER, DOCUMENT)
    with sessions.begin() as session:
        assert job_records.get(session, STRANGER.owner, job_id) is None
        assert job_records.cancel(session, STRANGER, job_id) is CancelOutcome.MISSING
        assert ids(job_records.page(session, STRANGER.owner, JobFilters(), None, 10)) == [theirs.id]
        assert ids(job_records.page(session, LOCAL.owner, JobFilters(), None, 10)) == [job_id]
    assert look(sessions, job_id).status is JobStatus.ACCEPTED
