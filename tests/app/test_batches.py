from typing import Any
from uuid import UUID, uuid4

from sqlalchemy import func, select, text
from sqlalchemy.orm import Session, sessionmaker
from uuid_utils.compat import uuid7

from app import batch_counts, batches, jobs, leases
from app.auth import LOCAL
from app.batch_counts import Counts
from app.batches import Chunk
from app.convert import NumberedLine
from app.jobs import CancelOutcome, JobFilters
from app.leases import Failure
from app.settings import Settings
from app.tables import Batch, BatchItem, FailureKind, Job, JobStatus
from tests.documents import STRANGER, add_job, history, point_result

ANALYSIS: dict[str, Any] = {"loops": [1]}


def add_batch(sessions: sessionmaker[Session], *sizes: int, rejected: int = 0) -> tuple[UUID, list[UUID]]:
    """Make an accepted batch with chunks of these sizes, whose line number n has the document {"n": n}."""
    chunks = [Chunk(uuid7(), part, size) for part, size in enumerate(sizes, 1)]
    owners = [chunk.id for chunk in chunks for _ in range(chunk.lines)]
    with sessions.begin() as session:
        batch_id = batches.begin(session, LOCAL, ANALYSIS)
        batches.add_items(session, [item(batch_id, n, owner) for n, owner in enumerate(owners, 1)])
        batches.accept(session, LOCAL, batch_id, chunks, rejected)
    return batch_id, [chunk.id for chunk in chunks]


def item(
    batch_id: UUID, number: int, chunk_id: UUID | None, faults: list[dict[str, str]] | None = None
) -> dict[str, Any]:
    return {
        "batch_id": batch_id,
        "number": number,
        "chunk_id": chunk_id,
        "reference": f"r{number}",
        "asset_id": None,
        "document": None if faults else {"n": number},
        "faults": faults,
    }


def claim(sessions: sessionmaker[Session], chunk_id: UUID, seconds: float = 60.0) -> leases.Claim:
    with sessions.begin() as session:
        held = leases.claim(session, chunk_id, "here", seconds)
    assert held is not None
    return held


def run(sessions: sessionmaker[Session], chunk_id: UUID, failing: frozenset[int] = frozenset()) -> None:
    """End a chunk with a result for each of its lines."""
    held = claim(sessions, chunk_id)
    assert held.batch_id is not None
    with sessions.begin() as session:
        _, lines = batches.lines_of_chunk(session, chunk_id, held.batch_id)
        points = [point_result(line.number, failure="Bad." if line.number in failing else None) for line in lines]
        assert leases.finish(session, held, points)


def count(sessions: sessionmaker[Session], batch_id: UUID) -> Counts:
    with sessions() as session:
        return batch_counts.counts(session, [batch_id])[batch_id]


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
        jobs.cancel(session, LOCAL, chunks[3])
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
        found = batches.lines_of_chunk(session, chunks[1], batch_id)
    assert found == (ANALYSIS, [NumberedLine(3, {"n": 3}), NumberedLine(4, {"n": 4})])


def test_batch_is_not_seen_before_it_is_accepted(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        batch_id = batches.begin(session, LOCAL, ANALYSIS)
        batches.add_items(session, [item(batch_id, 1, uuid4())])
    with sessions.begin() as session:
        assert batches.get(session, LOCAL.owner, batch_id) is None
        assert batches.page(session, LOCAL.owner, None, 10) == []
        assert batches.cancel(session, LOCAL, batch_id) is CancelOutcome.MISSING
        batches.discard(session, batch_id)
    assert [rows(sessions, table) for table in (Batch, BatchItem, Job)] == [0, 0, 0]


def test_only_old_batches_that_were_never_accepted_are_swept_away(sessions: sessionmaker[Session]) -> None:
    accepted, _ = add_batch(sessions, 1)
    with sessions.begin() as session:
        abandoned, coming_in = batches.begin(session, LOCAL, ANALYSIS), batches.begin(session, LOCAL, ANALYSIS)
    with sessions.begin() as session:
        for batch_id in (accepted, abandoned):
            session.get_one(Batch, batch_id).created_at = session.get_one(Batch, batch_id).created_at.replace(year=2020)
    with sessions.begin() as session:
        assert batches.discard_abandoned(session) == 1
        assert session.get(Batch, abandoned) is None
        assert session.get(Batch, accepted) is not None and session.get(Batch, coming_in) is not None


def test_cancel_ends_what_waits_and_asks_what_runs(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 1, 1, 1)
    run(sessions, chunks[0])
    held = claim(sessions, chunks[1])
    with sessions.begin() as session:
        assert batches.cancel(session, LOCAL, batch_id) is CancelOutcome.REQUESTED
        assert batches.cancel(session, LOCAL, batch_id) is CancelOutcome.REQUESTED
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
        assert batches.cancel(session, LOCAL, batch_id) is CancelOutcome.DISMISSED
    assert count(sessions, batch_id).status is JobStatus.DISMISSED


def test_an_ended_batch_is_removed_with_everything(sessions: sessionmaker[Session]) -> None:
    batch_id, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk)
    with sessions.begin() as session:
        assert batches.cancel(session, LOCAL, batch_id) is CancelOutcome.REMOVED
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
        again = batches.resubmit(session, LOCAL, batch_id, 2)
        assert batches.resubmit(session, LOCAL, batch_id, 2) == []
    with sessions() as session:
        moved = [[line.number for line in batches.lines_of_chunk(session, c, batch_id)[1]] for c in again]
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
            assert leases.release_expired(session, settings) == 1
    assert (count(sessions, batch_id).failed, count(sessions, batch_id).status) == (3, JobStatus.FAILED)
    with sessions.begin() as session:
        assert len(batches.resubmit(session, LOCAL, batch_id, 10)) == 1


def test_chunks_are_listed_with_their_batch_only(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 1, 1)
    single = add_job(sessions)
    with sessions() as session:
        assert [job.id for job in jobs.page(session, LOCAL.owner, JobFilters(), None, 10)] == [single]
        of_batch = jobs.page(session, LOCAL.owner, JobFilters(batch_id=batch_id), None, 10)
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
        first = batches.page(session, LOCAL.owner, None, 3)
        rest = batches.page(session, LOCAL.owner, (first[-1].created_at, first[-1].id), 3)
    assert [batch.id for batch in first + rest] == made[::-1]


def test_a_removed_chunk_takes_its_lines_along(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 2, 3)
    run(sessions, chunks[0])
    with sessions.begin() as session:
        assert jobs.cancel(session, LOCAL, chunks[0]) is CancelOutcome.REMOVED
    assert count(sessions, batch_id) == Counts(accepted=3)
    assert rows(sessions, BatchItem) == 3


def test_batches_of_another_owner_are_not_there(sessions: sessionmaker[Session]) -> None:
    batch_id, (chunk,) = add_batch(sessions, 2)
    run(sessions, chunk, frozenset({1}))
    with sessions.begin() as session:
        assert batches.get(session, STRANGER.owner, batch_id) is None
        assert batches.page(session, STRANGER.owner, None, 10) == []
        assert batches.resubmit(session, STRANGER, batch_id, 2) == []
        assert batches.cancel(session, STRANGER, batch_id) is CancelOutcome.MISSING
        assert jobs.page(session, STRANGER.owner, JobFilters(batch_id=batch_id), None, 10) == []
        assert jobs.cancel(session, STRANGER, chunk) is CancelOutcome.MISSING
    assert count(sessions, batch_id).failed == 1
    with sessions() as session:
        assert session.get_one(Job, chunk).owner == LOCAL.owner
