from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from threading import Barrier
from types import SimpleNamespace
from uuid import UUID, uuid4

import pytest
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import job_records, leases
from app.jobs.leases import Beat, Claim, Failure
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage import counters, steady_clock, stored_results
from app.storage.counters import CounterName
from app.storage.database import database_time
from app.tables import FailureKind, JobStatus
from tests.documents import add_job, count_points, history, look, point_result
from tests.servers import wait_until
from worker.sweep import ClockKeeper

LONG = 60.0
OVER = -1.0  # a lease that has run out as it is given


def take(sessions: sessionmaker[Session], job_id: UUID, seconds: float = LONG, owner: str = "here") -> Claim:
    with sessions.begin() as session:
        held = leases.claim(session, job_id, owner, seconds)
    assert held is not None
    return held


def give_back(sessions: sessionmaker[Session], settings: Settings, owner: str | None = None) -> int:
    with sessions.begin() as session:
        steady_clock.move_on(session, None)
        return leases.release_expired(session, settings, owner)


def test_claim_gives_document_attempt_and_lease(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions, {"line": {"b": 1, "a": [2.5]}})
    held = take(sessions, job_id)
    job = look(sessions, job_id)
    assert held is not None
    assert (held.job_id, held.attempt, held.document) == (job_id, 1, {"line": {"b": 1, "a": [2.5]}})
    assert (job.status, job.attempt, job.lease_owner) == (JobStatus.RUNNING, 1, "here")
    assert job.claimed_at is not None and job.lease_expires_at is not None
    assert (job.lease_expires_at - job.claimed_at).total_seconds() == LONG
    assert history(sessions, job_id) == [("accepted", 0), ("running", 1)]


def test_one_of_many_claims_at_once_succeeds(sessions: sessionmaker[Session]) -> None:
    job_id, racers = add_job(sessions), 6
    start = Barrier(racers)

    def race(number: int) -> Claim | None:
        start.wait()
        with sessions.begin() as session:
            return leases.claim(session, job_id, f"racer {number}", LONG)

    with ThreadPoolExecutor(racers) as pool:
        claims = list(pool.map(race, range(racers)))
    winners = [number for number, held in enumerate(claims) if held is not None]
    assert len(winners) == 1
    assert look(sessions, job_id).lease_owner == f"racer {winners[0]}"
    assert history(sessions, job_id) == [("accepted", 0), ("running", 1)]


def test_running_ended_and_missing_jobs_are_not_to_be_claimed(sessions: sessionmaker[Session]) -> None:
    running, ended = add_job(sessions), add_job(sessions)
    take(sessions, running)
    with sessions.begin() as session:
        job_records.cancel(session, LOCAL, ended)
        claims = [leases.claim(session, job_id, "other", LONG) for job_id in (running, ended, uuid4())]
    assert claims == [None, None, None]


def test_finish_stores_results_and_state(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    held = take(sessions, job_id)
    with sessions.begin() as session:
        assert leases.finish(session, held, [point_result(0), point_result(1)])
    job = look(sessions, job_id)
    assert (job.status, job.progress, job.engine_version) == (JobStatus.SUCCESSFUL, 1.0, "9.9.9")
    assert job.finished_at is not None and job.lease_expires_at is None and job.lease_owner is None
    assert count_points(sessions, job_id) == 2
    assert history(sessions, job_id)[-1] == ("successful", 1)


def test_results_that_cannot_be_stored_leave_the_job_running_with_none(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    held = take(sessions, job_id)
    with pytest.raises(SQLAlchemyError), sessions.begin() as session:
        leases.finish(session, held, [point_result(0), point_result(0)])
    assert look(sessions, job_id).status is JobStatus.RUNNING
    assert count_points(sessions, job_id) == 0


def test_zombie_finds_nothing_to_end_and_its_results_are_dropped(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    job_id = add_job(sessions)
    zombie = take(sessions, job_id, OVER)
    assert give_back(sessions, settings) == 1
    successor = take(sessions, job_id)
    with sessions.begin() as session:
        assert leases.heartbeat(session, zombie, LONG, 0.9, "late") is Beat.LOST
        assert not leases.finish(session, zombie, [point_result(tension=1.0)])
        assert not leases.fail(session, zombie, Failure(FailureKind.INTERNAL, "late"), [point_result(tension=1.0)])
        assert not leases.dismiss(session, zombie)
    assert count_points(sessions, job_id) == 0
    with sessions.begin() as session:
        assert leases.finish(session, successor, [point_result(tension=2.0)])
        assert not leases.finish(session, zombie, [point_result(tension=1.0)])
    with sessions() as session:
        tensions = [row["span.horizontal_tension_n"] for row in stored_results.rows(session, job_id, "frequencies")]
    assert tensions == [2.0]
    assert look(sessions, job_id).attempt == 2
    assert history(sessions, job_id) == [
        ("accepted", 0),
        ("running", 1),
        ("released", 1),
        ("running", 2),
        ("successful", 2),
    ]


def test_heartbeat_renews_the_lease_and_writes_the_progress(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    job_id = add_job(sessions)
    held = take(sessions, job_id, OVER)
    with sessions.begin() as session:
        assert leases.heartbeat(session, held, LONG, 0.25, "modes") is Beat.GO_ON
    assert give_back(sessions, settings) == 0
    job = look(sessions, job_id)
    assert (job.status, job.progress, job.step) == (JobStatus.RUNNING, 0.25, "modes")


def test_heartbeat_tells_of_a_cancel(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    held = take(sessions, job_id)
    with sessions.begin() as session:
        job_records.cancel(session, LOCAL, job_id)
        assert leases.heartbeat(session, held, LONG, 0.5, "") is Beat.CANCEL
        assert leases.dismiss(session, held)
    assert look(sessions, job_id).status is JobStatus.DISMISSED
    assert history(sessions, job_id)[-2:] == [("cancel_requested", 1), ("dismissed", 1)]


def test_failed_job_keeps_document_attempt_sentence_and_rows(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions, {"line": {"kept": True}})
    held = take(sessions, job_id)
    with sessions.begin() as session:
        leases.fail(session, held, Failure(FailureKind.NO_CONVERGENCE, "It did not converge."), [point_result()])
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind) == (JobStatus.FAILED, FailureKind.NO_CONVERGENCE)
    assert (job.failure_detail, job.attempt, job.document) == ("It did not converge.", 1, {"line": {"kept": True}})
    assert count_points(sessions, job_id) == 1


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Give the clock of the database, which a test sets by its `set_by`."""
    found = SimpleNamespace(set_by=timedelta(0))
    for module in (steady_clock, leases):
        monkeypatch.setattr(module, "database_time", lambda session: database_time(session) + found.set_by)
    return found


def sweep(keeper: ClockKeeper, sessions: sessionmaker[Session], settings: Settings) -> int:
    keeper.look()
    with sessions.begin() as session:
        return leases.release_expired(session, settings)


@pytest.mark.parametrize("hours", [-1, 2])
def test_a_clock_that_is_set_ends_no_lease_of_a_living_worker(
    sessions: sessionmaker[Session], settings: Settings, clock: SimpleNamespace, hours: int
) -> None:
    strict = settings.model_copy(update={"hard_time_limit_seconds": 3700.0})
    keeper = ClockKeeper(sessions, strict)
    keeper.look()
    job_id = add_job(sessions)
    held = take(sessions, job_id)
    clock.set_by = timedelta(hours=hours)
    assert sweep(keeper, sessions, strict) == 0
    with sessions.begin() as session:
        assert leases.heartbeat(session, held, LONG, 0.5, "") is Beat.GO_ON
    assert sweep(keeper, sessions, strict) == 0
    with sessions.begin() as session:
        assert leases.finish(session, held, [point_result()])
        _, seconds = counters.totals(session)[CounterName.JOBS.value, "successful"]
    assert 0.0 <= seconds < LONG
    assert history(sessions, job_id) == [("accepted", 0), ("running", 1), ("successful", 1)]


@pytest.mark.parametrize("hours", [-1, 2])
def test_a_lease_of_a_lost_worker_ends_though_the_clock_is_set(
    sessions: sessionmaker[Session], settings: Settings, clock: SimpleNamespace, hours: int
) -> None:
    keeper = ClockKeeper(sessions, settings)
    keeper.look()
    job_id = add_job(sessions)
    take(sessions, job_id, 0.2)
    clock.set_by = timedelta(hours=hours)
    wait_until(lambda: sweep(keeper, sessions, settings) == 1, 10.0, "the release")
    assert look(sessions, job_id).status is JobStatus.ACCEPTED


def test_a_step_that_another_sweeper_is_just_noting_ends_no_lease(
    sessions: sessionmaker[Session], settings: Settings, clock: SimpleNamespace
) -> None:
    ClockKeeper(sessions, settings).look()
    job_id = add_job(sessions)
    take(sessions, job_id)
    clock.set_by = timedelta(hours=2)
    with sessions.begin() as session:  # without a look of its own, which another one's may have taken the place of
        assert leases.release_expired(session, settings) == 0
    assert look(sessions, job_id).status is JobStatus.RUNNING


def test_time_in_which_no_sweeper_ran_ends_no_lease_and_is_no_work(
    sessions: sessionmaker[Session], settings: Settings, clock: SimpleNamespace
) -> None:
    """It may be a step of the clock, or the service was off: a job of a living worker runs on, one of a dead waits."""
    ClockKeeper(sessions, settings).look()
    living, lost = add_job(sessions), add_job(sessions)
    held = take(sessions, living)
    take(sessions, lost, 1.0)
    clock.set_by = timedelta(hours=2)
    keeper = ClockKeeper(sessions, settings)
    assert sweep(keeper, sessions, settings) == 0
    with sessions.begin() as session:
        assert leases.heartbeat(session, held, LONG, 0.5, "") is Beat.GO_ON
        assert steady_clock.steady_time(session) > database_time(session) + timedelta(hours=1)
    wait_until(lambda: sweep(keeper, sessions, settings) == 1, 10.0, "the release")
    assert look(sessions, lost).status is JobStatus.ACCEPTED
    assert look(sessions, living).status is JobStatus.RUNNING


def test_a_lease_given_while_the_clock_was_ahead_is_shortened(
    sessions: sessionmaker[Session], settings: Settings, clock: SimpleNamespace
) -> None:
    keeper = ClockKeeper(sessions, settings)
    keeper.look()
    clock.set_by = timedelta(hours=2)
    ahead, before = add_job(sessions), add_job(sessions)
    take(sessions, ahead)  # after the step, and before a sweeper looks
    clock.set_by = timedelta(0)
    take(sessions, before, 1.0)
    clock.set_by = timedelta(hours=2)
    keeper.look()
    ends = [look(sessions, job_id).lease_expires_at for job_id in (ahead, before)]
    with sessions() as session:
        now = steady_clock.steady_time(session)
    left = [(end - now).total_seconds() for end in ends if end is not None]
    assert 0.0 < left[0] <= settings.lease_seconds and left[1] <= 1.0


def test_messages_of_a_time_that_the_clock_was_set_back_from_are_sent_again(
    sessions: sessionmaker[Session], settings: Settings, clock: SimpleNamespace
) -> None:
    unsent, sent = add_job(sessions), add_job(sessions)
    with sessions.begin() as session:
        leases.mark_dispatched(session, [sent])
    clock.set_by = timedelta(hours=-1)
    with sessions.begin() as session:
        assert leases.take_undispatched(session, settings, queue_is_empty=False) == [unsent]
        assert leases.take_undispatched(session, settings, queue_is_empty=True) == [sent]


def test_three_lost_attempts_end_a_job(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions)
    for attempt in (1, 2, 3):
        assert take(sessions, job_id, OVER).attempt == attempt
        assert look(sessions, job_id).status is JobStatus.RUNNING
        assert give_back(sessions, settings) == 1
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind, job.attempt) == (JobStatus.FAILED, FailureKind.WORKER_LOST, 3)
    assert job.failure_detail == "The service gave up the job because its worker was lost in each of 3 attempts."
    assert [kind for kind, _ in history(sessions, job_id)].count("released") == 2


def test_released_job_waits_for_sending_again(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions)
    take(sessions, job_id, OVER)
    give_back(sessions, settings)
    job = look(sessions, job_id)
    assert (job.status, job.dispatched_at, job.progress) == (JobStatus.ACCEPTED, None, 0.0)
    with sessions.begin() as session:
        assert leases.take_undispatched(session, settings, queue_is_empty=False) == [job_id]
        assert leases.take_undispatched(session, settings, queue_is_empty=False) == []


def test_lost_job_with_a_cancel_is_dismissed(sessions: sessionmaker[Session], settings: Settings) -> None:
    job_id = add_job(sessions)
    take(sessions, job_id, OVER)
    with sessions.begin() as session:
        job_records.cancel(session, LOCAL, job_id)
    give_back(sessions, settings)
    assert look(sessions, job_id).status is JobStatus.DISMISSED


def test_lost_job_past_the_hard_limit_fails_by_it(sessions: sessionmaker[Session], settings: Settings) -> None:
    strict = settings.model_copy(update={"soft_time_limit_seconds": 1e-6, "hard_time_limit_seconds": 1e-5})
    job_id = add_job(sessions)
    take(sessions, job_id, 0.01)
    wait_until(lambda: give_back(sessions, strict) == 1, 10.0, "the release")
    job = look(sessions, job_id)
    assert (job.status, job.failure_kind, job.attempt) == (JobStatus.FAILED, FailureKind.TIME_LIMIT, 1)
    assert job.failure_detail == "The job ran longer than the limit of 1e-06 s."


def test_a_dead_owners_jobs_come_back_before_their_leases_end(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    of_dead, of_living = add_job(sessions), add_job(sessions)
    take(sessions, of_dead, LONG, "dead")
    take(sessions, of_living, LONG, "living")
    assert give_back(sessions, settings) == 0
    with sessions() as session:
        assert [leases.holds_jobs(session, owner) for owner in ("dead", "living", "other")] == [True, True, False]
    assert give_back(sessions, settings, "dead") == 1
    with sessions() as session:
        assert [leases.holds_jobs(session, owner) for owner in ("dead", "living")] == [False, True]
    assert look(sessions, of_dead).status is JobStatus.ACCEPTED
    assert look(sessions, of_living).status is JobStatus.RUNNING


def test_many_sweepers_release_and_take_every_job_once(sessions: sessionmaker[Session], settings: Settings) -> None:
    expected = {add_job(sessions) for _ in range(12)}
    for job_id in expected:
        take(sessions, job_id, OVER)
    start = Barrier(4)

    def sweep(_: int) -> tuple[int, list[UUID]]:
        start.wait()
        released = give_back(sessions, settings)
        start.wait()
        with sessions.begin() as session:
            return released, leases.take_undispatched(session, settings, queue_is_empty=False)

    with ThreadPoolExecutor(4) as pool:
        swept = list(pool.map(sweep, range(4)))
    assert sum(released for released, _ in swept) == 12
    taken = [job_id for _, ids in swept for job_id in ids]
    assert sorted(taken) == sorted(expected)


def test_new_jobs_have_a_grace_before_the_sweeper_sends_them(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    at_once = settings.model_copy(update={"sweep_seconds": 1e-9})
    job_id = add_job(sessions)
    with sessions.begin() as session:
        assert leases.take_undispatched(session, settings, queue_is_empty=True) == []
        assert leases.take_undispatched(session, at_once, queue_is_empty=True) == [job_id]


def test_a_message_counts_as_lost_only_if_the_queue_is_empty(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    impatient = settings.model_copy(update={"redispatch_seconds": 1e-9})
    job_id = add_job(sessions)
    with sessions.begin() as session:
        leases.mark_dispatched(session, [job_id])
        assert leases.take_undispatched(session, impatient, queue_is_empty=False) == []
        assert leases.take_undispatched(session, settings, queue_is_empty=True) == []
        assert leases.take_undispatched(session, impatient, queue_is_empty=True) == [job_id]


def test_unsent_jobs_are_taken_again(sessions: sessionmaker[Session], settings: Settings) -> None:
    at_once = settings.model_copy(update={"sweep_seconds": 1e-9})
    job_id = add_job(sessions)
    with sessions.begin() as session:
        leases.mark_dispatched(session, [job_id])
        leases.mark_undispatched(session, [job_id])
        assert leases.take_undispatched(session, at_once, queue_is_empty=False) == [job_id]
