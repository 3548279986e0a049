"""The generators of clients, installed by `make test-clients` into a folder of their own."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).parent
FOLDER = HERE.parents[1] / ".clients"
PROGRAMS = HERE / "programs"


def tool(path: str, needs: str | None = None) -> str:
    """Return the path of a tool; without it the test is skipped.

    Under CI it fails, unless the tool `needs` a program that this machine does not have.
    """
    if needs is not None and shutil.which(needs) is None:
        pytest.skip(f"{path} needs {needs}, which is not installed")
    found = FOLDER / path
    if not found.exists():
        reason = f"{path} is not installed: `make test-clients` does it"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return str(found)


def run(*arguments: str | Path, folder: Path, **environment: str) -> str:
    """Run a command in a folder and return what it printed; fail the test with it if the command fails."""
    done = subprocess.run(
        [str(argument) for argument in arguments],
        cwd=folder,
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        check=False,
    )
    if done.returncode != 0:
        pytest.fail(f"{arguments[0]} ended with {done.returncode}:\n{done.stdout[-5000:]}")
    return done.stdout
