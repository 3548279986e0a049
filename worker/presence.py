"""The worker's place in the list of workers, for `galloping status`."""

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
    """Give a function that says, if it is time to, that the worker is there; at the end the worker has left."""
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
        _logger.warning("the list of workers cannot be written: %s", error)
