"""The one Hypothesis profile, and fixtures for tests that need a database, a broker, or the whole service."""

import math
import os
import sysconfig
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.runtime.signing import make_signing_key
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from tests import servers
from tests.documents import hasty_settings

# A busy machine makes any example slow, so none has a deadline; under CI every run draws the same examples.
hypothesis.settings.register_profile("galloping", deadline=None, derandomize="CI" in os.environ, print_blob=True)
hypothesis.settings.load_profile("galloping")


def pytest_configure() -> None:
    """Refuse kernels that are older than their sources: what they compute may be wrong without a word."""
    kernels = Path(__file__).parents[1] / "engine" / "kernels"
    built = kernels / f"_kernels{sysconfig.get_config_var('EXT_SUFFIX')}"
    since = built.stat().st_mtime if built.exists() else math.inf
    newer = [path.name for path in kernels.glob("*.[ch]") if path.stat().st_mtime > since]
    if newer:
        raise pytest.UsageError(f"{', '.join(newer)} changed after {built.name} was built: run `make setup`")


@pytest.fixture(scope="session")
def postgres_address() -> Iterator[str]:
    """Give a PostgreSQL of this test process's own."""
    with servers.postgres_server() as address:
        yield address


@pytest.fixture
def redis_address() -> Iterator[str]:
    """Give an empty Redis of this test's own."""
    with servers.redis_server() as address:
        yield address


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """Give an empty database of either kind."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path}/test.sqlite3"
        return
    with servers.postgres_database(request.getfixturevalue("postgres_address")) as address:
        yield address


@pytest.fixture
def settings(database_url: str, tmp_path: Path) -> Settings:
    """Give settings with short times, an empty database and the embedded broker."""
    found = Settings(data_dir=tmp_path, database_url=database_url, lease_seconds=3.0, heartbeat_seconds=0.1)
    make_signing_key(found)
    return found


@pytest.fixture
def sessions(settings: Settings) -> Iterator[sessionmaker[Session]]:
    """Give sessions on a database with all tables."""
    migrate(settings)
    engine = make_engine(settings)
    yield session_factory(engine)
    engine.dispose()


@pytest.fixture(params=["embedded", "production"])
def deployment(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Settings]:
    """Give settings of a migrated service with short times: SQLite and a folder, or PostgreSQL and Redis."""
    common = hasty_settings(tmp_path)
    make_signing_key(common)
    if request.param == "embedded":
        migrate(common)
        yield common
        return
    with servers.postgres_database(request.getfixturevalue("postgres_address")) as database:
        broker = request.getfixturevalue("redis_address")
        # Made anew rather than copied, since the address gets its driver in the making.
        settings = Settings.model_validate({**common.model_dump(), "database_url": database, "broker_url": broker})
        migrate(settings)
        yield settings


@pytest.fixture
def deployed(deployment: Settings) -> Iterator[sessionmaker[Session]]:
    """Give sessions on the database of the deployment."""
    engine = make_engine(deployment)
    yield session_factory(engine)
    engine.dispose()
