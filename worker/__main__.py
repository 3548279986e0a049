"""A worker: `python -m worker` keeps a pool of processes running, and sweeps."""

import logging
import os
import signal
import socket
import sys
import time
from uuid import uuid4

from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.runtime import logs, processes
from app.runtime.settings import Settings, get_settings
from app.runtime.signing import make_signing_key
from app.storage.database import make_engine, session_factory
from worker.courier import courier
from worker.health import show_life
from worker.presence import presence
from worker.sweep import ClockKeeper, release, sweep
from worker.tasks import OWNER

_POLL_SECONDS = 0.2

_logger = logging.getLogger(__name__)


def main() -> int:
    """Run until SIGTERM or SIGINT arrives; replace a pool that dies, and return its jobs to the queue at once."""
    processes.end_with_parent()
    settings = get_settings()
    logs.configure(settings)
    make_signing_key(settings)  # for webhooks
    engine = make_engine(settings, idle_seconds=settings.lease_seconds)
    try:
        _supervise(session_factory(engine), settings, f"{socket.gethostname()}:{os.getpid()}:{uuid4().hex[:8]}")
    finally:
        engine.dispose()
    return 0


def _supervise(sessions: sessionmaker[Session], settings: Settings, owner: str) -> None:
    with (
        processes.until_stopped() as wait,
        presence(sessions, settings, owner) as show_presence,
        courier(sessions, settings),
    ):
        clock = ClockKeeper(sessions, settings)
        pool = _start_pool(settings, owner)
        while not wait(settings.sweep_seconds):
            if pool.poll() is not None:
                _logger.warning("the pool exited with code %s; starting it again", pool.returncode)
                _give_back(sessions, settings, owner)
                pool = _start_pool(settings, owner)
            _repair(sessions, settings, clock)
            show_presence()
        _drain(sessions, settings, owner, pool)
        _give_back(sessions, settings, owner)
        _repair(sessions, settings, clock)  # sends the released jobs now, before another worker's sweep finds them


def _drain(sessions: sessionmaker[Session], settings: Settings, owner: str, pool: processes.Child) -> None:
    """Let the pool finish its jobs without taking more; kill it after the time limit, for the caller to release them.

    Do not wait for an idle pool: Celery takes seconds to end one, and it has nothing to lose.
    """
    pool.send_signal(signal.SIGTERM)
    deadline = time.monotonic() + settings.shutdown_seconds
    time.sleep(_POLL_SECONDS)  # for a job whose message arrived but which is not claimed yet
    while pool.poll() is None and time.monotonic() < deadline and _holds_jobs(sessions, owner):
        time.sleep(_POLL_SECONDS)
    processes.stop([pool], signal.SIGKILL, settings.shutdown_seconds)


def _holds_jobs(sessions: sessionmaker[Session], owner: str) -> bool:
    try:
        with sessions() as session:
            return leases.holds_jobs(session, owner)
    except SQLAlchemyError:
        return True


def _start_pool(settings: Settings, owner: str) -> processes.Child:
    return processes.start(settings, f"{__package__}.tasks", extra={OWNER: owner})


def _repair(sessions: sessionmaker[Session], settings: Settings, clock: ClockKeeper) -> None:
    try:
        clock.look()
        sweep(sessions, settings)
        show_life(settings)
    except SQLAlchemyError as error:
        _logger.warning("the database failed; the next sweep tries again: %s", error)


def _give_back(sessions: sessionmaker[Session], settings: Settings, owner: str) -> None:
    try:
        release(sessions, settings, owner)
    except SQLAlchemyError as error:
        _logger.warning("the database failed; the next sweep tries again: %s", error)


if __name__ == "__main__":
    sys.exit(main())
