"""A served instance with its worker, and its OpenAPI document as a generator finds it."""

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.documents import hasty_settings, short_request
from tests.embedded import serving
from tests.servers import free_port


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """Give a client of the whole service, which computes what is posted."""
    with serving(hasty_settings(tmp_path_factory.mktemp("served")), free_port()) as (_, client):
        yield client


@pytest.fixture
def work(tmp_path: Path, served: httpx.Client) -> Path:
    """Give a folder with the document and with a request to submit."""
    (tmp_path / "openapi.json").write_bytes(served.get("/openapi.json", timeout=60.0).raise_for_status().content)
    (tmp_path / "request.json").write_text(json.dumps(short_request()))
    return tmp_path
