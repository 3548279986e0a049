import threading

from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.storage import counters
from app.storage.counters import CounterName
from app.tables import CounterIncrement, FailureKind, JobStatus


def rows(sessions: sessionmaker[Session]) -> int:
    with sessions() as session:
        return session.scalar(select(func.count()).select_from(CounterIncrement)) or 0


def totals(sessions: sessionmaker[Session]) -> dict[tuple[str, str], tuple[int, float]]:
    with sessions() as session:
        return counters.totals(session)


def test_totals_are_the_same_before_and_after_folding(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        for _ in range(150):
            counters.add_end(session, JobStatus.SUCCESSFUL, chunk=False, seconds=0.5)
            counters.add_end(session, JobStatus.FAILED, FailureKind.TIME_LIMIT, chunk=True, count=2)
        counters.add(session, CounterName.LEASES, "expired", count=7)
    expected = {
        ("jobs", "successful"): (150, 75.0),
        ("chunks", "failed/time_limit"): (300, 0.0),
        ("leases", "expired"): (7, 0.0),
    }
    assert totals(sessions) == expected
    with sessions.begin() as session:
        assert counters.fold(session) == 301
    assert (totals(sessions), rows(sessions)) == (expected, 3)
    with sessions.begin() as session:
        assert counters.fold(session) == 0


def test_folding_and_counting_at_once_loses_nothing(sessions: sessionmaker[Session]) -> None:
    def count() -> None:
        for _ in range(30):
            with sessions.begin() as session:
                for _ in range(10):
                    counters.add(session, CounterName.LEASES, "expired")
                counters.fold(session)

    threads = [threading.Thread(target=count) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert totals(sessions) == {("leases", "expired"): (900, 0.0)}
    assert rows(sessions) < 500


def test_what_was_rolled_back_was_never_counted(sessions: sessionmaker[Session]) -> None:
    with sessions() as session:
        counters.add(session, CounterName.LEASES, "expired")
        session.flush()
        session.rollback()
    assert totals(sessions) == {}
