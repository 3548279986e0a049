import time
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime, timedelta

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.storage import steady_clock
from app.storage.database import database_time
from app.storage.steady_clock import Step, move_on, steady_time, unnoted_step
from app.tables import SteadyClock

HOUR = timedelta(hours=1)
SHORT = timedelta(seconds=60)  # longer than any test takes, and far shorter than a step


class Database:
    """The service's database with a clock that a test sets."""

    def __init__(self, sessions: sessionmaker[Session]) -> None:
        self.sessions, self.set_by = sessions, timedelta(0)
        self.since: float | None = None

    def time(self, session: Session) -> datetime:
        return database_time(session) + self.set_by

    def look(self) -> Step:
        with self.sessions.begin() as session:
            step = move_on(session, self.since)
        assert step is not None
        self.since = step.noted_at
        return step

    def read(self) -> datetime:
        with self.sessions() as session:
            return steady_time(session)


@pytest.fixture
def database(sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch) -> Database:
    """Give the database, whose sweeper has looked once."""
    found = Database(sessions)
    monkeypatch.setattr(steady_clock, "database_time", found.time)
    found.look()
    return found


def test_without_a_step_it_is_the_clock_of_the_database(sessions: sessionmaker[Session], database: Database) -> None:
    for _ in range(3):
        assert not database.look().is_known
    with sessions() as session:
        assert abs(steady_time(session) - database_time(session)) < timedelta(seconds=1)
        assert unnoted_step(session) == timedelta(0)
        assert session.scalars(select(SteadyClock.ahead_seconds)).one() == 0.0


def test_a_clock_set_back_holds_the_steady_one_until_a_sweeper_looks(database: Database) -> None:
    before = database.read()
    database.look()
    database.set_by = -HOUR
    held = database.read()
    assert before < held == database.read()
    with database.sessions() as session:
        assert HOUR - SHORT < unnoted_step(session) <= HOUR
    step = database.look()
    assert step.is_known and HOUR - SHORT < step.by <= HOUR
    after = database.read()
    assert held < after < held + SHORT
    with database.sessions() as session:
        assert unnoted_step(session) == timedelta(0)
    assert not database.look().is_known


def test_a_clock_set_ahead_is_not_followed_by_a_sweeper_that_knows_better(database: Database) -> None:
    before = database.read()
    database.set_by = HOUR
    step = database.look()
    assert step.is_known and -HOUR <= step.by < SHORT - HOUR
    assert before < database.read() < before + SHORT
    database.set_by = timedelta(0)
    assert database.look().by > HOUR - SHORT
    assert before < database.read() < before + SHORT


def test_time_in_which_no_sweeper_ran_has_passed(database: Database) -> None:
    before = database.read()
    database.set_by, database.since = HOUR, None
    assert database.look().by == timedelta(0)
    assert database.read() >= before + HOUR


def test_a_sweeper_that_was_stopped_takes_no_time_back(database: Database) -> None:
    """Its own last look is long ago, or its monotonic clock stood still with its machine; others have looked since."""
    before = database.read()
    assert database.since is not None
    for since in (database.since - 3600.0, time.monotonic()):
        database.since = since
        assert not database.look().is_known
        assert before < database.read() < before + SHORT


def test_many_sweepers_and_steps_never_take_it_back(database: Database) -> None:
    def sweep(number: int) -> list[datetime]:
        since, readings = None, []
        for turn in range(10):
            if number == 0:
                database.set_by = (turn % 3 - 1) * HOUR
            with database.sessions.begin() as session:
                step = move_on(session, since)
                since = step.noted_at if step is not None else since
                readings.append(session.scalars(select(SteadyClock.reading)).one())
        return readings

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(sweep, range(4)))
    assert all(readings == sorted(readings) for readings in found)


def test_a_row_that_another_sweeper_holds_is_left_to_it(sessions: sessionmaker[Session], database: Database) -> None:
    if sessions.kw["bind"].dialect.name == "sqlite":
        pytest.skip("a writer of SQLite holds the whole file")
    with sessions.begin() as holding, sessions.begin() as other:
        assert move_on(holding, database.since) is not None
        assert move_on(other, database.since) is None
