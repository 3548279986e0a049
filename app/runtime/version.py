"""The version of the installed distribution."""

from importlib.metadata import PackageNotFoundError, version


def _installed() -> str:
    try:
        return version("galloping")
    except PackageNotFoundError:  # run from a folder that was never installed
        return "unknown"


SERVICE_VERSION = _installed()
"""Version of the service, as its distribution declares it."""
