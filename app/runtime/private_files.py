"""Folders and files that other users of the machine cannot read."""

import errno
import os
import stat
from contextlib import suppress
from pathlib import Path

_FOLDER, _FILE = 0o700, 0o600
_OURS = ("galloping.sqlite3", "signing-secret", "cursor-secret", "worker-alive", "broker", "metrics-")


def make_private_folder(folder: Path) -> None:
    """Make a folder that only this user can use, and take it from other users if it was made earlier.

    An existing folder keeps its mode if it belongs to another user or holds what is not the service's.

    Raises
    ------
    OSError
        If the folder cannot be made, or if this user may not write in it; the error names the folder.
    """
    folder.mkdir(_FOLDER, parents=True, exist_ok=True)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission to write in this folder", str(folder))
    if all(entry.name.startswith(_OURS) for entry in folder.iterdir()):
        _narrow(folder, _FOLDER)


def make_private_file(file: Path) -> None:
    """Make an empty file that only this user can read, and take it from other users if it was made earlier.

    Raises
    ------
    OSError
        If the file cannot be made.
    """
    with suppress(FileExistsError):  # an open file of SQLite must not be closed here: its locks would go
        os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, _FILE))
    keep_private(file)


def keep_private(file: Path) -> None:
    """Take a file from other users, if it is still there."""
    with suppress(FileNotFoundError):
        _narrow(file, _FILE)


def _narrow(path: Path, mode: int) -> None:
    found = path.stat()
    present = stat.S_IMODE(found.st_mode)
    if present & ~mode and hasattr(os, "geteuid") and os.geteuid() == found.st_uid:
        path.chmod(present & mode)
