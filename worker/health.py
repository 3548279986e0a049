"""A sign of life: the worker touches a file after every sweep, and `galloping worker --check` fails if it is old."""

import sys
import time
from pathlib import Path

from app.runtime.private_files import make_private_folder
from app.runtime.settings import Settings, get_settings

_SWEEPS = 15.0
_LEAST_SECONDS = 30.0


def show_life(settings: Settings) -> None:
    """Touch the worker's file.

    Raises
    ------
    OSError
        If the data directory cannot be written to.
    """
    make_private_folder(settings.data_dir)
    _file(settings).touch()


def is_alive(settings: Settings, now: float) -> bool:
    """Tell whether the worker of this data directory swept recently; `now` is in seconds since the epoch."""
    patience = max(_LEAST_SECONDS, _SWEEPS * settings.sweep_seconds)
    return _file(settings).exists() and abs(now - _file(settings).stat().st_mtime) < patience


def _file(settings: Settings) -> Path:
    return settings.data_dir / "worker-alive"


if __name__ == "__main__":
    sys.exit(0 if is_alive(get_settings(), time.time()) else 1)
