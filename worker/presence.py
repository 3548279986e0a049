"""Report the worker to the list of workers, for `galloping status`."""

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.operation import workers
from app.runtime.settings import Settings

_logger = logging.getLogger(__name__)


@contextmanager
def presence(sessions: sessionmaker[Session], settings: Settings, name: str) -> Iterator[Callable[[], None]]:
    """Yield a function that reports the worker when a report is due; at the end, remove the worker from the list."""
    due = 0.0

    def show() -> None:
        nonlocal due
        if time.monotonic() < due:
            return
        due = time.monotonic() + workers.report_seconds(settings)
        _change(sessions, lambda session: workers.report(session, settings, name))

    show()
    try:
        yield show
    finally:
        _change(sessions, lambda session: workers.leave(session, name))


def _change(sessions: sessionmaker[Session], change: Callable[[Session], None]) -> None:
    try:
        with sessions.begin() as session:
            change(session)
    except SQLAlchemyError as error:
        _logger.warning("could not update the list of workers: %s", error)
