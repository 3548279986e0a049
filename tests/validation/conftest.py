"""What the tests against outside codes share."""

import ctypes.util
import os
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def peer() -> ModuleType:
    """Give the module that calls OpenSees; without its system libraries tests are skipped, and under CI they fail."""
    if os.environ.get("CI") != "true" and ctypes.util.find_library("lapack") is None:
        pytest.skip("OpenSees needs the system's BLAS and LAPACK (libblas3, liblapack3)")
    from benchmarks import opensees  # noqa: PLC0415 - it loads the outside code

    return opensees
