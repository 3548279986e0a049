from uuid import UUID, uuid4

from sqlalchemy import func, select, text
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.convert import NumberedLine
from app.jobs import batch_progress, job_records, leases
from app.jobs.batch_progress import Counts
from app.jobs.job_records import CancelOutcome, JobFilters
from app.jobs.leases import Failure
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage import steady_clock
from app.tables import Batch, BatchItem, FailureKind, Job, JobStatus
from tests.batch_rows import ANALYSIS, add_batch, claim, item, run
from tests.documents import STRANGER, add_job, history, point_result


def count(sessions: sessionmaker[Session], batch_id: UUID) -> Counts:
    with sessions() as session:
        return batch_progress.counts(session, [batch_id])[batch_id]


def rows(sessions: sessionmaker[Session], table: type[Batch | BatchItem | Job]) -> int:
    with sessions() as session:
        return session.scalar(select(func.count()).select_from(table)) or 0


def test_counts_follow_the_chunks(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 4, 3, 2, 1)
    assert count(sessions, batch_id) == Counts(accepted=10)
    assert count(sessions, batch_id).status is JobStatus.ACCEPTED
    claim(sessions, chunks[1])
    run(sessions, chunks[0], frozenset({2}))
    with sessions.begin() as session:
        job_records.cancel(session, LOCAL, chunks[3])
    found = count(sessions, batch_id)
    assert (found.accepted, found.running, found.successful, found.failed, found.dismissed) == (2, 3, 3, 1, 1)
    assert (found.lines, found.progress, found.status) == (10, 0.5, JobStatus.RUNNING)
    assert found.started_at is not None and found.finished_at is None


def test_state_of_the_whole_is_that_of_its_lines(sessions: sessionmaker[Session]) -> None:
    good, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk, frozenset({1}))
    bad, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk, frozenset({1, 2}))
    assert [count(sessions, b).status for b in (good, bad)] == [JobStatus.SUCCESSFUL, JobStatus.FAILED]
    assert [count(sessions, b).progress for b in (good, bad)] == [1.0, 1.0]
    assert count(sessions, good).finished_at is not None


def test_chunk_carries_the_analysis_and_its_own_lines(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 2, 2)
    held = claim(sessions, chunks[1])
    assert held.batch_id == batch_id
    with sessions() as session:
        found = batch_records.lines_of_chunk(session, chunks[1], batch_id)
    assert found == (ANALYSIS, [NumberedLine(3, {"n": 3}), NumberedLine(4, {"n": 4})])


def test_batch_is_not_seen_before_it_is_accepted(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        batch_id = batch_records.begin(session, LOCAL, ANALYSIS)
        batch_records.add_items(session, [item(batch_id, 1, uuid4())])
    with sessions.begin() as session:
        assert batch_records.get(session, LOCAL.owner, batch_id) is None
        assert batch_records.page(session, LOCAL.owner, None, 10) == []
        assert batch_records.cancel(session, LOCAL, batch_id) is CancelOutcome.MISSING
        batch_records.discard(session, batch_id)
    assert [rows(sessions, table) for table in (Batch, BatchItem, Job)] == [0, 0, 0]


def test_only_old_batches_that_were_never_accepted_are_swept_away(sessions: sessionmaker[Session]) -> None:
    accepted, _ = add_batch(sessions, 1)
    with sessions.begin() as session:
        abandoned, coming_in = (
            batch_records.begin(session, LOCAL, ANALYSIS),
            batch_records.begin(session, LOCAL, ANALYSIS),
        )
    with sessions.begin() as session:
        for batch_id in (accepted, abandoned):
            session.get_one(Batch, batch_id).created_at = session.get_one(Batch, batch_id).created_at.replace(year=2020)
    with sessions.begin() as session:
        assert batch_records.discard_abandoned(session) == 1
        assert session.get(Batch, abandoned) is None
        assert session.get(Batch, accepted) is not None and session.get(Batch, coming_in) is not None


def test_cancel_ends_what_waits_and_asks_what_runs(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 1, 1, 1)
    run(sessions, chunks[0])
    held = claim(sessions, chunks[1])
    with sessions.begin() as session:
        assert batch_records.cancel(session, LOCAL, batch_id) is CancelOutcome.REQUESTED
        assert batch_records.cancel(session, LOCAL, batch_id) is CancelOutcome.REQUESTED
    with sessions.begin() as session:
        assert leases.heartbeat(session, held, 60.0, 0.5, "") is leases.Beat.CANCEL
        assert leases.dismiss(session, held)
    found = count(sessions, batch_id)
    assert (found.successful, found.dismissed, found.status) == (1, 2, JobStatus.DISMISSED)
    assert history(sessions, chunks[1])[-2:] == [("cancel_requested", 1), ("dismissed", 1)]
    assert history(sessions, chunks[2]) == [("accepted", 0), ("dismissed", 0)]


def test_cancel_of_waiting_chunks_ends_the_batch_at_once(sessions: sessionmaker[Session]) -> None:
    batch_id, _ = add_batch(sessions, 1, 1)
    with sessions.begin() as session:
        assert batch_records.cancel(session, LOCAL, batch_id) is CancelOutcome.DISMISSED
    assert count(sessions, batch_id).status is JobStatus.DISMISSED


def test_an_ended_batch_is_removed_with_everything(sessions: sessionmaker[Session]) -> None:
    batch_id, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk)
    with sessions.begin() as session:
        assert batch_records.cancel(session, LOCAL, batch_id) is CancelOutcome.REMOVED
    assert [rows(sessions, table) for table in (Batch, BatchItem, Job)] == [0, 0, 0]
    with sessions() as session:
        assert session.scalar(text("SELECT count(*) FROM results")) == 0


def test_failed_lines_go_into_new_chunks_under_their_numbers(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 4, 2, 1)
    run(sessions, chunks[0], frozenset({2, 3}))
    held = claim(sessions, chunks[1])
    with sessions.begin() as session:
        leases.fail(session, held, Failure(FailureKind.TIME_LIMIT, "Too long."), [point_result(5)])
    assert (count(sessions, batch_id).successful, count(sessions, batch_id).failed) == (3, 3)
    with sessions.begin() as session:
        again = batch_records.resubmit(session, LOCAL, batch_id, 2)
        assert batch_records.resubmit(session, LOCAL, batch_id, 2) == []
    with sessions() as session:
        moved = [[line.number for line in batch_records.lines_of_chunk(session, c, batch_id)[1]] for c in again]
    assert moved == [[2, 3], [6]]
    found = count(sessions, batch_id)
    assert (found.accepted, found.successful, found.failed, found.status) == (4, 3, 0, JobStatus.RUNNING)
    for chunk in (*again, chunks[2]):
        run(sessions, chunk)
    assert count(sessions, batch_id).successful == 7


def test_lost_chunks_lines_failed(sessions: sessionmaker[Session], settings: Settings) -> None:
    batch_id, (chunk,) = add_batch(sessions, 3)
    for _ in range(settings.max_attempts):
        claim(sessions, chunk, -1.0)
        with sessions.begin() as session:
            steady_clock.move_on(session, None)
            assert leases.release_expired(session, settings) == 1
    assert (count(sessions, batch_id).failed, count(sessions, batch_id).status) == (3, JobStatus.FAILED)
    with sessions.begin() as session:
        assert len(batch_records.resubmit(session, LOCAL, batch_id, 10)) == 1


def test_chunks_are_listed_with_their_batch_only(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 1, 1)
    single = add_job(sessions)
    with sessions() as session:
        assert [job.id for job in job_records.page(session, LOCAL.owner, JobFilters(), None, 10)] == [single]
        of_batch = job_records.page(session, LOCAL.owner, JobFilters(batch_id=batch_id), None, 10)
    assert {job.id for job in of_batch} == set(chunks)


def test_chunks_and_jobs_wait_for_messages_apart(sessions: sessionmaker[Session], settings: Settings) -> None:
    at_once = settings.model_copy(update={"sweep_seconds": 1e-9})
    _, chunks = add_batch(sessions, 1)
    single = add_job(sessions)
    with sessions.begin() as session:
        assert leases.take_undispatched(session, at_once, queue_is_empty=False) == [single]
        assert leases.take_undispatched(session, at_once, queue_is_empty=False, chunks=True) == chunks


def test_pages_follow_each_other(sessions: sessionmaker[Session]) -> None:
    made = [add_batch(sessions, 1)[0] for _ in range(5)]
    with sessions() as session:
        first = batch_records.page(session, LOCAL.owner, None, 3)
        rest = batch_records.page(session, LOCAL.owner, (first[-1].created_at, first[-1].id), 3)
    assert [batch.id for batch in first + rest] == made[::-1]


def test_a_removed_chunk_takes_its_lines_along(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 2, 3)
    run(sessions, chunks[0])
    with sessions.begin() as session:
        assert job_records.cancel(session, LOCAL, chunks[0]) is CancelOutcome.REMOVED
    assert count(sessions, batch_id) == Counts(accepted=3)
    assert rows(sessions, BatchItem) == 3


def test_batches_of_another_owner_are_not_there(sessions: sessionmaker[Session]) -> None:
    batch_id, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk, frozenset({1}))
    with sessions.begin() as session:
        assert batch_records.get(session, STRANGER.owner, batch_id) is None
        assert batch_records.page(session, STRANGER.owner, None, 10) == []
        assert batch_records.resubmit(session, STRANGER, batch_id, 2) == []
        assert batch_records.cancel(session, STRANGER, batch_id) is CancelOutcome.MISSING
        assert job_records.page(session, STRANGER.owner, JobFilters(batch_id=batch_id), None, 10) == []
        assert job_records.cancel(session, STRANGER, chunk) is CancelOutcome.MISSING
    assert count(sessions, batch_id).failed == 1
    with sessions() as session:
        assert session.get_one(Job, chunk).owner == LOCAL.owner
