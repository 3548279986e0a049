"""Try whether the service can write where it must: into its database, and into the folder of an embedded one."""

import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

from sqlalchemy import Engine, text
from sqlalchemy.exc import InternalError, OperationalError

from app.storage.database import takes_no_changes

_OK = "ok"
_PAUSE_SECONDS = 2.0


class WriteProbe:
    """Writes a little, at most every two seconds however often it is asked."""

    def __init__(self, prober: Engine, clock: Callable[[], float] = time.monotonic) -> None:
        """Take an engine that opens a new connection for each use, and a clock [s]."""
        self._prober = prober
        self._clock = clock
        self._trying = threading.Lock()
        self._found, self._tried_at = _OK, float("-inf")

    def state(self) -> str:
        """Return "ok", or why the service cannot write.

        Raises
        ------
        sqlalchemy.exc.SQLAlchemyError
            If the database does not answer.
        """
        with self._trying:
            if self._clock() - self._tried_at > _PAUSE_SECONDS:
                self._found = self._try()
                self._tried_at = self._clock()
            return self._found

    def _try(self) -> str:
        embedded = self._prober.dialect.name == "sqlite"
        try:
            with self._prober.begin() as connection:
                if not embedded:
                    held = connection.scalar(text("SHOW transaction_read_only")) == "on"
                    return "takes no changes" if held else _OK
                version = connection.scalar(text("PRAGMA user_version"))
                connection.execute(text(f"PRAGMA user_version = {version}"))
        except (OperationalError, InternalError) as error:
            if takes_no_changes(error):
                return "takes no changes"
            raise
        return _folder_state(Path(self._prober.url.database)) if self._prober.url.database else _OK


def _folder_state(file: Path) -> str:
    """Tell whether files can be made beside a database, as its journal and the messages of the embedded broker are."""
    try:
        with tempfile.TemporaryFile(dir=file.parent) as probe:
            probe.write(b"can be written")
            probe.flush()
    except OSError as error:
        return f"its folder cannot be written to: {error.strerror}"
    return _OK
