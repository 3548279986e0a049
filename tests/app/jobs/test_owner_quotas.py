"""The quotas of an owner in SQL. Times are not waited for: what a process remembers ends when a test lets it."""

from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.batches.batch_records import Chunk
from app.convert import ENGINE_VERSION
from app.jobs import idempotency, job_records, leases, owner_quotas, reuse, submissions
from app.jobs.idempotency import Answer, KeyTaken
from app.jobs.job_records import Submission
from app.jobs.leases import Failure
from app.jobs.owner_quotas import Amount, Bounded, OverQuota, Quotas, standing
from app.jobs.submissions import Keyed, Order
from app.security.caller import LOCAL
from app.storage import stored_bytes, stored_results
from app.tables import BatchItem, FailureKind, Job, PointRow
from tests.batch_rows import add_batch, claim, run
from tests.documents import STRANGER, add_job, point_result, short_request
from tests.statements import counted
from tests.threads import at_once

MEGABYTE = 1_000_000


def orders(count: int, *, may_reuse: bool = False, **changes: Any) -> list[Order]:
    submission = Submission(LOCAL, {**short_request(), **changes})
    return [Order(submission, may_reuse=may_reuse) for _ in range(count)]


def post(sessions: sessionmaker[Session], allowed: Quotas, asked: Sequence[Order]) -> list[str]:
    with sessions.begin() as session:
        return [type(result).__name__ for result in submissions.accept(session, asked, allowed)]


def used(sessions: sessionmaker[Session], owner: str = LOCAL.owner) -> owner_quotas.Standing:
    with sessions() as session:
        return standing(session, owner)


def study(points: int) -> dict[str, Any]:
    values = [25e3 + number for number in range(points)]
    return {"study": {"axes": [{"parameter": "span.horizontal_tension_n", "values": values}]}}


def test_so_many_jobs_of_an_owner_wait_and_no_more(sessions: sessionmaker[Session]) -> None:
    allowed = Quotas(Amount(waiting=3))
    assert post(sessions, allowed, orders(2)) == ["Job", "Job"]
    assert post(sessions, allowed, orders(2)) == ["Job", "OverQuota"]
    with sessions.begin() as session:
        (over,) = submissions.accept(session, orders(1), allowed)
        (stranger,) = submissions.accept(session, [Order(Submission(STRANGER, short_request()))], allowed)
    assert isinstance(over, OverQuota)
    assert (over.bounded, over.used, over.asked, over.most) == (Bounded.WAITING, 3, 1, 3)
    assert isinstance(stranger, Job), "another owner has a quota of its own"
    with sessions() as session:
        first = session.scalars(select(Job.id).order_by(Job.created_at, Job.id)).first()
    assert first is not None
    claim(sessions, first)
    assert used(sessions).waiting == 2
    assert post(sessions, allowed, orders(2)) == ["Job", "OverQuota"], "one that runs waits no more"


def test_a_study_counts_with_what_it_is_expected_to_leave(sessions: sessionmaker[Session]) -> None:
    (order,) = orders(1, **study(1000))
    expected = job_records.make(order.submission, datetime.now(UTC))
    size = expected.request_bytes + expected.result_bytes
    assert expected.result_bytes > 1000 * stored_bytes.ROW_BYTES
    allowed = Quotas(Amount(stored=3 * size - 1))
    assert post(sessions, allowed, orders(5, **study(1000))) == ["Job", "Job", "OverQuota", "OverQuota", "OverQuota"]
    assert used(sessions).stored == 2 * size
    assert used(sessions).expected == 2 * expected.result_bytes
    assert post(sessions, allowed, orders(1)) == ["Job"], "a small one still has room"


def test_what_is_left_counts_from_the_end_on_and_what_is_removed_no_more(sessions: sessionmaker[Session]) -> None:
    ended, failed, cancelled, lost = (add_job(sessions) for _ in range(4))
    requests = used(sessions).stored - used(sessions).expected
    points = [point_result(0), point_result(1), point_result(2, failure="It overflowed.")]
    held = claim(sessions, ended), claim(sessions, failed), claim(sessions, lost)
    with sessions.begin() as session:
        assert leases.finish(session, held[0], points)
        assert leases.fail(session, held[1], Failure(FailureKind.TIME_LIMIT, "too long"), points[:1])
        assert leases.dismiss(session, held[2])
        job_records.cancel(session, LOCAL, cancelled)
    assert stored(sessions, ended) == results(sessions, ended) > 3 * stored_bytes.ROW_BYTES
    assert stored(sessions, failed) == results(sessions, failed) > stored_bytes.ROW_BYTES
    assert stored(sessions, cancelled) == stored(sessions, lost) == 0
    assert used(sessions).stored == requests + results(sessions, ended) + results(sessions, failed)
    assert used(sessions).expected == 0
    with sessions.begin() as session:
        for job_id in (ended, failed, cancelled, lost):
            job_records.cancel(session, LOCAL, job_id)
    assert used(sessions) == owner_quotas.Standing(0, 0, 0, 0)


def stored(sessions: sessionmaker[Session], job_id: UUID) -> int:
    with sessions() as session:
        return session.scalars(select(Job.result_bytes).where(Job.id == job_id)).one()


def results(sessions: sessionmaker[Session], job_id: UUID) -> int:
    """Return the bytes of a job's results as they lie in the table of results."""
    with sessions() as session:
        return session.scalar(select(stored_bytes.of_stored_points(PointRow.job_id == job_id))) or 0


def test_a_batch_counts_with_all_its_lines_until_its_chunks_and_itself_are_removed(
    sessions: sessionmaker[Session],
) -> None:
    before = used(sessions).stored
    batch_id, chunks = add_batch(sessions, 3, 2)
    with sessions.begin() as session:
        lines = session.scalar(select(stored_bytes.of_lines(session, BatchItem.batch_id == batch_id)))
    assert lines == sum(len(f'{{"n":{number}}}') for number in range(1, 6))
    for chunk in chunks:
        run(sessions, chunk)
    whole = used(sessions).stored
    with sessions.begin() as session:
        job_records.cancel(session, LOCAL, chunks[1])
    gone = 2 * len('{"n":1}')
    document = stored_bytes.of_request({"batch_id": str(batch_id), "part": 2})
    assert whole - used(sessions).stored == gone + document + results_of_lines(2)
    with sessions.begin() as session:
        batch_records.cancel(session, LOCAL, batch_id)
    assert used(sessions).stored == before


def results_of_lines(count: int) -> int:
    return stored_bytes.of_points(stored_results.rows_of([point_result(number) for number in range(count)]))


def test_chunks_count_as_waiting_and_a_batch_over_a_quota_changes_nothing(sessions: sessionmaker[Session]) -> None:
    add_batch(sessions, 1, 1, 1)
    chunks = [Chunk(UUID(int=number), number, 10, 5000) for number in (1, 2)]
    with sessions.begin() as session, pytest.raises(OverQuota) as waiting:
        batch_records.require_room(session, LOCAL, chunks, Quotas(Amount(waiting=4)))
    assert (waiting.value.used, waiting.value.asked) == (3, 2)
    with sessions.begin() as session, pytest.raises(OverQuota) as size:
        batch_records.require_room(session, LOCAL, chunks, Quotas(Amount(stored=100_000)))
    assert size.value.asked == 2 * (10 * 5000 + stored_bytes.ROW_BYTES)
    with sessions.begin() as session:
        batch_records.require_room(session, LOCAL, chunks, Quotas(Amount(5, MEGABYTE)))


def test_failed_lines_are_put_into_new_chunks_if_there_is_room(sessions: sessionmaker[Session]) -> None:
    batch_id, (chunk,) = add_batch(sessions, 3)
    run(sessions, chunk, failing=frozenset({1, 2}))
    full = Quotas(Amount(stored=used(sessions).stored))
    with pytest.raises(OverQuota), sessions.begin() as session:
        batch_records.resubmit(session, LOCAL, batch_id, 1, full)
    before = used(sessions)
    assert before.waiting == 0
    with sessions.begin() as session:
        assert len(batch_records.resubmit(session, LOCAL, batch_id, 1, Quotas(Amount(2, MEGABYTE)))) == 2
    assert used(sessions).waiting == 2
    assert used(sessions).stored - before.stored == sum(sizes(sessions, batch_id)[1:])


def sizes(sessions: sessionmaker[Session], batch_id: UUID) -> list[int]:
    size = Job.request_bytes + Job.result_bytes
    with sessions() as session:
        return list(session.scalars(select(size).where(Job.batch_id == batch_id).order_by(Job.id)))


def test_copied_results_count_as_bytes_and_do_not_wait(sessions: sessionmaker[Session]) -> None:
    first = add_job(sessions, short_request())
    held = claim(sessions, first)
    line_hash = reuse.hash_of(LOCAL.owner, short_request())
    with sessions.begin() as session:
        point = replace(point_result(), input_hash=line_hash, engine_version=ENGINE_VERSION)
        assert leases.finish(session, held, [point])
    size = used(sessions).stored
    waiting_full, bytes_full = Quotas(Amount(waiting=1)), Quotas(Amount(stored=3 * size))
    add_waiting = orders(1, **study(1))
    assert post(sessions, waiting_full, add_waiting) == ["Job"]
    assert post(sessions, waiting_full, orders(1, may_reuse=True)) == ["Job"]
    with sessions.begin() as session:
        session.delete(session.scalars(select(Job).where(Job.status == "accepted")).one())
    assert used(sessions).stored == 2 * size
    assert post(sessions, bytes_full, orders(2, may_reuse=True)) == ["Job", "OverQuota"]
    assert used(sessions).stored == 3 * size


def keyed(value: str) -> Order:
    key = idempotency.new_key(LOCAL.owner, value)
    (order,) = orders(1)
    answer = Keyed(key, "print", lambda job: Answer(202, {}, f'"{job.id}"'))
    return Order(order.submission, may_reuse=False, keyed=answer)


def test_a_refused_post_leaves_its_key_free_and_a_repeated_one_gets_its_answer(
    sessions: sessionmaker[Session],
) -> None:
    allowed = Quotas(Amount(waiting=1))
    assert post(sessions, allowed, [keyed("a"), keyed("b")]) == ["Job", "OverQuota"]
    assert post(sessions, allowed, [keyed("a"), keyed("b")]) == [KeyTaken.__name__, "OverQuota"]
    assert post(sessions, Quotas(Amount(waiting=2)), [keyed("b")]) == ["Job"]


@pytest.mark.parametrize("most", [1, 7])
def test_processes_that_post_at_once_do_not_pass_the_last_place(sessions: sessionmaker[Session], most: int) -> None:
    made: list[str] = []

    def one(number: int) -> None:
        del number
        for _ in range(3):
            made.extend(post(sessions, Quotas(Amount(waiting=most)), orders(2)))

    at_once(one, 6)
    assert sorted(set(made)) == ["Job", "OverQuota"]
    assert made.count("Job") == used(sessions).waiting == most


def test_processes_that_post_studies_at_once_do_not_pass_the_last_bytes(sessions: sessionmaker[Session]) -> None:
    size = sum(sizes_of(sessions, orders(1, **study(500))))

    def one(number: int) -> None:
        del number
        post(sessions, Quotas(Amount(stored=5 * size)), orders(2, **study(500)))

    at_once(one, 6)
    assert used(sessions).stored == 5 * size


def sizes_of(sessions: sessionmaker[Session], asked: Sequence[Order]) -> list[int]:
    with sessions.begin() as session:
        made = submissions.accept(session, asked)
        found = [job.request_bytes + job.result_bytes for job in made if isinstance(job, Job)]
        session.rollback()
    return found


def test_little_posts_far_from_the_quota_cost_no_statement(sessions: sessionmaker[Session]) -> None:
    allowed = Quotas(Amount(waiting=100_000, stored=100_000 * MEGABYTE))
    post(sessions, allowed, orders(1))
    with counted() as bounded:
        post(sessions, allowed, orders(20))
    with counted() as unbounded:
        post(sessions, owner_quotas.NONE, orders(20))
    assert len(bounded) == len(unbounded)


def test_what_other_processes_accept_is_seen_near_the_quota(sessions: sessionmaker[Session]) -> None:
    here, there = (Quotas(Amount(waiting=2000)) for _ in range(2))
    assert post(sessions, here, orders(1)) == ["Job"]
    assert set(post(sessions, there, orders(1900))) == {"Job"}
    assert set(post(sessions, here, orders(90))) == {"Job"}
    assert post(sessions, here, orders(20)).count("Job") == 2000 - 1 - 1900 - 90
    assert post(sessions, there, orders(1)) == ["OverQuota"]


def test_every_owner_is_listed_with_what_it_has(sessions: sessionmaker[Session]) -> None:
    add_job(sessions)
    claim(sessions, add_job(sessions))
    add_batch(sessions, 2)
    with sessions.begin() as session:
        submissions.accept(session, [Order(Submission(STRANGER, short_request()))])
    with sessions() as session:
        found = owner_quotas.standings(session)
    assert list(found) == [LOCAL.owner, STRANGER.owner]
    assert found == {owner: used(sessions, owner) for owner in found}
    assert (found[LOCAL.owner].running, found[LOCAL.owner].waiting) == (1, 2)
