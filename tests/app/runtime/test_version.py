from importlib.metadata import version

from app.runtime.version import SERVICE_VERSION


def test_it_is_that_of_the_distribution() -> None:
    assert version("galloping") == SERVICE_VERSION
