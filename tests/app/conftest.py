"""Services for tests of the API: one for a whole file, and a fresh one for tests that count jobs."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app import service


@pytest.fixture(scope="module")
def shared_settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Give settings of a service with SQLite and the embedded broker, and a small limit on bodies."""
    return service.sqlite_settings(tmp_path_factory.mktemp("service"), max_body_bytes=2_000_000)


@pytest.fixture(scope="module")
def shared_client(shared_settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service that all tests of a file share."""
    with service.running(shared_settings) as client:
        yield client


@pytest.fixture
def own_settings(tmp_path: Path) -> Settings:
    """Give settings of a service of this test's own."""
    return service.sqlite_settings(tmp_path)


@pytest.fixture
def own_client(own_settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service of this test's own."""
    with service.running(own_settings) as client:
        yield client
