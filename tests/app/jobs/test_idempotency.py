from datetime import timedelta

import pytest
from sqlalchemy import func, select, update
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import idempotency
from app.jobs.idempotency import Answer, Kept, Key, KeyTaken, new_key
from app.runtime.settings import Settings
from app.storage import steady_clock
from app.storage.database import database_time
from app.tables import IdempotencyKey
from tests.servers import wait_until
from tests.statements import counted
from worker.sweep import ClockKeeper, sweep

HELD = timedelta(seconds=15)
ANSWER = Answer(202, {"location": "/v1/jobs/1"}, '{"id":"1"}')
OTHER = Answer(202, {}, '{"id":"2"}')


def age(sessions: sessionmaker[Session], by: timedelta) -> None:
    """Let time pass for all keys."""
    with sessions.begin() as session:
        (end,) = session.scalars(select(IdempotencyKey.expires_at))
        session.execute(update(IdempotencyKey).values(expires_at=end - by))


def keep(sessions: sessionmaker[Session], key: Key, request: str, answer: Answer) -> None:
    with sessions.begin() as session:
        if not idempotency.keep(session, [Kept(key, request, answer)]):
            raise KeyTaken


def found(sessions: sessionmaker[Session], key: Key) -> tuple[str, Answer] | None:
    with sessions() as session:
        return idempotency.find(session, key)


def test_the_first_answer_stays(sessions: sessionmaker[Session]) -> None:
    keep(sessions, new_key("a", "k"), "f", ANSWER)
    with pytest.raises(KeyTaken):
        keep(sessions, new_key("a", "k"), "g", OTHER)
    assert found(sessions, new_key("a", "k")) == ("f", ANSWER)


def test_of_many_keys_those_that_are_free_are_taken_in_one_statement(sessions: sessionmaker[Session]) -> None:
    keep(sessions, new_key("a", "used"), "f", ANSWER)
    keys = [new_key("a", "used"), new_key("b", "z"), new_key("a", "z"), new_key("b", "z")]
    with sessions.begin() as session, counted() as statements:
        taken = idempotency.keep(session, [Kept(key, key.holder.hex, OTHER) for key in keys])
    assert taken == {keys[1].holder, keys[2].holder}  # of two that are equal, the first
    assert len([text for text in statements if text.startswith("INSERT")]) == 1
    assert found(sessions, keys[0]) == ("f", ANSWER)
    assert found(sessions, keys[3]) == (keys[1].holder.hex, OTHER)


def test_keys_of_two_owners_are_two(sessions: sessionmaker[Session]) -> None:
    keep(sessions, new_key("a", "k"), "f", ANSWER)
    assert found(sessions, new_key("b", "k")) is None
    keep(sessions, new_key("b", "k"), "g", OTHER)
    assert found(sessions, new_key("b", "k")) == ("g", OTHER)


def test_a_key_is_free_again_after_a_day(sessions: sessionmaker[Session]) -> None:
    keep(sessions, new_key("a", "k"), "f", ANSWER)
    age(sessions, timedelta(hours=23, minutes=59))
    with pytest.raises(KeyTaken):
        keep(sessions, new_key("a", "k"), "g", OTHER)
    age(sessions, timedelta(minutes=2))
    keep(sessions, new_key("a", "k"), "g", OTHER)
    assert found(sessions, new_key("a", "k")) == ("g", OTHER)


def test_a_held_key_has_no_answer_until_it_is_finished(sessions: sessionmaker[Session]) -> None:
    key = new_key("a", "k")
    with sessions.begin() as session:
        idempotency.hold(session, key, HELD)
    assert found(sessions, key) is None
    with pytest.raises(KeyTaken), sessions.begin() as session:
        idempotency.hold(session, new_key("a", "k"), HELD)
    with sessions.begin() as session:
        idempotency.finish(session, key, "f", ANSWER)
    assert found(sessions, key) == ("f", ANSWER)


def test_who_comes_back_late_finds_the_key_taken(sessions: sessionmaker[Session]) -> None:
    late, next_one = new_key("a", "k"), new_key("a", "k")
    with sessions.begin() as session:
        idempotency.hold(session, late, HELD)
    age(sessions, HELD + timedelta(seconds=1))
    with sessions.begin() as session:
        idempotency.hold(session, next_one, HELD)
    with pytest.raises(KeyTaken), sessions.begin() as session:
        idempotency.renew(session, late, HELD)
    with pytest.raises(KeyTaken), sessions.begin() as session:
        idempotency.finish(session, late, "f", ANSWER)
    with sessions.begin() as session:
        idempotency.release(session, late)
        idempotency.finish(session, next_one, "g", OTHER)
    assert found(sessions, late) == ("g", OTHER)


def test_who_shows_life_keeps_the_key(sessions: sessionmaker[Session]) -> None:
    slow = new_key("a", "k")
    with sessions.begin() as session:
        idempotency.hold(session, slow, HELD)
    age(sessions, HELD + timedelta(seconds=1))
    with sessions.begin() as session:
        idempotency.renew(session, slow, HELD)
    with pytest.raises(KeyTaken), sessions.begin() as session:
        idempotency.hold(session, new_key("a", "k"), HELD)


def test_the_key_of_a_dead_request_is_free_though_the_clock_was_set_back(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    keeper = ClockKeeper(sessions, settings)
    keeper.look()
    with sessions.begin() as session:
        idempotency.hold(session, new_key("a", "k"), timedelta(seconds=0.2))
    monkeypatch.setattr(steady_clock, "database_time", lambda session: database_time(session) - timedelta(hours=1))

    def taken_over() -> bool:
        keeper.look()
        try:
            with sessions.begin() as session:
                idempotency.hold(session, new_key("a", "k"), HELD)
        except KeyTaken:
            return False
        return True

    wait_until(taken_over, 10.0, "the end of the key")


def test_the_sweeper_forgets_what_is_over(sessions: sessionmaker[Session], settings: Settings) -> None:
    def kept() -> int:
        with sessions() as session:
            return session.scalar(select(func.count()).select_from(IdempotencyKey)) or 0

    slow = new_key("a", "k")
    with sessions.begin() as session:
        idempotency.hold(session, slow, HELD)
    age(sessions, HELD + timedelta(seconds=1))
    sweep(sessions, settings)
    assert kept() == 1  # nobody else has wanted it, so the slow sender may go on
    with sessions.begin() as session:
        idempotency.finish(session, slow, "f", ANSWER)
    sweep(sessions, settings)
    assert kept() == 1
    age(sessions, idempotency.KEPT + timedelta(seconds=1))
    sweep(sessions, settings)
    assert kept() == 0
