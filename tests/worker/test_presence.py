from sqlalchemy import text
from sqlalchemy.orm import Session, sessionmaker

from app.operation import workers
from app.runtime.settings import Settings
from worker.presence import presence


def names(sessions: sessionmaker[Session]) -> list[str]:
    with sessions() as session:
        return [worker.name for worker in workers.listed(session)]


def test_a_worker_is_listed_from_its_start_to_its_end(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with presence(sessions, settings, "one"), presence(sessions, settings, "two"):
        assert names(sessions) == ["one", "two"]
    assert names(sessions) == []


def test_a_worker_reports_no_more_often_than_it_must(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with presence(sessions, settings.model_copy(update={"lease_seconds": 3600.0}), "one") as show:
        with sessions.begin() as session:
            workers.leave(session, "one")
        show()
        assert names(sessions) == []
    with presence(sessions, settings.model_copy(update={"lease_seconds": 0.0}), "one") as show:
        with sessions.begin() as session:
            workers.leave(session, "one")
        show()
        assert names(sessions) == ["one"]


def test_a_database_that_fails_does_not_end_the_worker(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        session.execute(text("DROP TABLE workers"))
    with presence(sessions, settings, "one") as show:
        show()
