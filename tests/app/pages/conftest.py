"""A service with one finished job that has every part that a result page can have, shared by all tests of pages."""

from collections.abc import Iterator

import httpx
import pytest
from sqlalchemy import select

from app.pages.findings import Findings, findings
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.tables import Job
from tests.app import service
from tests.app.pages.known_jobs import known_request


@pytest.fixture(scope="session")
def shared_settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Give settings of a service with SQLite and the embedded broker."""
    return service.sqlite_settings(tmp_path_factory.mktemp("pages"), preview_seconds=60.0)


@pytest.fixture(scope="session")
def shared_client(shared_settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service that all tests of pages share."""
    with service.running(shared_settings) as client:
        yield client


@pytest.fixture(scope="session")
def known_job(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the id of a finished job."""
    return service.finished(shared_client, shared_settings, known_request()).rpartition("/")[2]


@pytest.fixture(scope="session")
def found(known_job: str, shared_settings: Settings) -> Findings:
    """Give what that job found."""
    engine = make_engine(shared_settings)
    with session_factory(engine)() as session:
        job = next(job for job in session.scalars(select(Job)) if str(job.id) == known_job)
        result = findings(session, job, 0)
    engine.dispose()
    assert result is not None
    return result
