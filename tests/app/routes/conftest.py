"""A service on either kind of database."""

from collections.abc import Iterator

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app import service


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service on either kind of database."""
    with service.running(settings) as running:
        yield running
