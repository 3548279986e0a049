"""A result with every part, computed without a service."""

from datetime import UTC, datetime

import pytest

from app import convert
from app.convert import PointResult
from app.pages.reports import Material, computed_material
from tests.app.pages.known_jobs import known_request


@pytest.fixture(scope="session")
def material() -> Material:
    """Give the material of a report."""
    request = convert.read(convert.explicit_request(known_request())).kept()
    (point,) = (item for item in convert.run(request) if isinstance(item, PointResult))
    return computed_material(request, point, datetime(2026, 1, 31, 12, 0, tzinfo=UTC))
