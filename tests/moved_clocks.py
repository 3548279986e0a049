"""Clocks of processes that are set ahead or back while the processes run, as an operator or NTP sets a machine's."""

import shutil
import struct
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).with_name("moved_clock.c")


class MovedClock:
    """The time of day of the processes that are started with its `environment`."""

    def __init__(self, folder: Path, seconds: int = 0) -> None:
        """Compile the library that moves the clock; without Linux or a compiler the test is skipped."""
        compiler = shutil.which("cc") or shutil.which("gcc")
        if compiler is None or not sys.platform.startswith("linux"):
            pytest.skip("a clock is moved by a library that is compiled and preloaded")
        folder.mkdir(exist_ok=True)
        self._file, library = folder / "seconds", folder / "moved_clock.so"
        subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", library, SOURCE], check=True)
        self.set(seconds)
        self.environment = {"LD_PRELOAD": str(library), "MOVED_CLOCK": str(self._file)}

    def set(self, seconds: int) -> None:
        """Set the clock to so many seconds ahead of the machine's."""
        with self._file.open("r+b" if self._file.exists() else "wb") as file:
            file.write(struct.pack("=q", seconds))
