"""Notice that the file of an SQLite database was removed or replaced: a connection would write on into the old one."""

import sqlite3
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, event
from sqlalchemy.exc import DisconnectionError

_IDENTITY = "device and inode of the file"


def stay_with_file(engine: Engine, file: Path) -> None:
    """Let an engine use only connections to the file that now has this name, and make no new file in its place.

    While there is none, connecting raises `sqlalchemy.exc.OperationalError`.
    """

    def identity() -> tuple[int, int]:
        try:
            found = file.stat()
        except OSError as error:
            raise sqlite3.OperationalError(f"the file of the database is gone: {error}") from error
        return found.st_dev, found.st_ino

    def before_connect(*_: Any) -> None:
        identity()

    def after_connect(_: object, record: Any) -> None:
        record.info[_IDENTITY] = identity()

    def before_use(_: object, record: Any, __: object) -> None:
        try:
            same = record.info.get(_IDENTITY) == identity()
        except sqlite3.OperationalError as error:
            raise DisconnectionError(str(error)) from error
        if not same:
            raise DisconnectionError("the file of the database was replaced")

    event.listen(engine, "do_connect", before_connect)
    event.listen(engine, "connect", after_connect)
    event.listen(engine, "checkout", before_use)
