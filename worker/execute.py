"""Run one job from claim to end: compute it under a lease, and store its results in one transaction."""

import itertools
import logging
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextvars import copy_context
from dataclasses import replace
from types import TracebackType
from typing import Self
from uuid import UUID

from celery.exceptions import SoftTimeLimitExceeded
from pydantic import ValidationError
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app import convert
from app.batches import batch_records
from app.convert import Advance, PointResult
from app.jobs import leases, reuse, turns
from app.jobs.leases import Beat, Claim, Failure
from app.runtime import correlation, telemetry
from app.runtime.settings import Settings
from app.tables import FailureKind
from engine.outcome import InvalidSpec

_logger = logging.getLogger(__name__)
_STOPS = (SoftTimeLimitExceeded,)  # raised wherever the computation is


def execute(
    sessions: sessionmaker[Session],
    settings: Settings,
    job_id: UUID,
    owner: str,
    end_process: Callable[[], None] | None = None,
) -> str | None:
    """Claim a job, compute it, and end it: the job itself or, if it is another owner's turn, one of that owner's.

    Return whose job it was. Do nothing and return None if no job waits that may run, as after a repeated message.

    A step of the engine may take minutes. If a job that was cancelled or given to another worker does not stop within
    `stop_seconds`, it is ended as it stands, and `end_process` is called from another thread, to stop the computation.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If the database fails at the claim or at the end; the lease then expires, and the job runs again.
    """
    with sessions.begin() as session:
        chosen = turns.in_turn(session, job_id, settings.running_jobs_per_owner)
        held = leases.claim(session, chosen, owner, settings.lease_seconds) if chosen is not None else None
        steps = _steps(session, held) if held is not None else None
    if held is None or steps is None:
        _logger.info("no job is waiting that may run, nor is %s, whose message came", job_id)
        return None
    with correlation.bound(held.ids), telemetry.job_span(held.ids):
        _work(sessions, settings, held, steps, end_process)
    return held.owner


def _work(
    sessions: sessionmaker[Session],
    settings: Settings,
    held: Claim,
    steps: Iterator[Advance | PointResult],
    end_process: Callable[[], None] | None,
) -> None:
    _logger.info("job begins")
    begin = time.monotonic()
    points: list[PointResult] = []
    with Pulse(sessions, held, settings, end_process) as pulse:
        failure = _compute(steps, held, settings, pulse, points)
    seconds = time.monotonic() - begin
    with sessions.begin() as session:
        ended = _conclude(session, held, pulse.verdict, failure, points)
    if not ended:
        _logger.warning("another worker has the job; the results of this attempt are dropped")
        return
    facts = {"verdict": pulse.verdict.value, "failure": failure and failure.kind.value, "points": len(points)}
    _logger.info("job ends", extra={**facts, "engine_seconds": round(seconds, 3)})


class Pulse:
    """A thread that renews the lease and stores the progress, however long a step of the engine takes.

    `verdict` is the answer to the last heartbeat. If it says stop and the computation goes on, the process is ended.
    """

    def __init__(
        self,
        sessions: sessionmaker[Session],
        held: Claim,
        settings: Settings,
        end_process: Callable[[], None] | None = None,
    ) -> None:
        """Take what the heartbeats need; they begin with the `with` statement."""
        self.verdict = Beat.GO_ON
        self._sessions, self._held, self._settings = sessions, held, settings
        self._end_process = end_process
        self._latest = Advance(0.0, "")
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=copy_context().run, args=(self._run,), name="heartbeat", daemon=True)

    def report(self, advance: Advance) -> None:
        """Set the progress for the next heartbeat."""
        self._latest = advance

    def __enter__(self) -> Self:
        """Start the heartbeats."""
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop the heartbeats, before the end of the job is written."""
        self._stopped.set()
        self._thread.join()

    def _run(self) -> None:
        while self.verdict is Beat.GO_ON and not self._stopped.wait(self._settings.heartbeat_seconds):
            try:
                self._beat()
            except SQLAlchemyError as error:
                _logger.warning("the job missed a heartbeat: %s", error)
        if self._end_process is not None and not self._stopped.wait(self._settings.stop_seconds):
            self._give_up(self._end_process)

    def _give_up(self, end_process: Callable[[], None]) -> None:
        _logger.warning("the job did not stop within %g s; its process ends", self._settings.stop_seconds)
        try:
            with self._sessions.begin() as session:
                _conclude(session, self._held, self.verdict, None, [])
        except SQLAlchemyError as error:
            _logger.warning("the job ends with its lease: %s", error)
        end_process()

    def _beat(self) -> None:
        latest = self._latest
        with self._sessions.begin() as session:
            lease = self._settings.lease_seconds
            self.verdict = leases.heartbeat(session, self._held, lease, latest.fraction, latest.step)


def _steps(session: Session, held: Claim) -> Iterator[Advance | PointResult]:
    """Return the computation of a job or a chunk, not yet started."""
    if held.batch_id is None:
        line_hash = reuse.hash_of(held.owner, held.document)
        steps = convert.run(held.document, _STOPS)
        return steps if line_hash is None else _with_hashes(steps, {0: line_hash})
    analysis, lines = batch_records.lines_of_chunk(session, held.job_id, held.batch_id)
    hashes = reuse.hashes(held.owner, analysis, lines)
    known = [] if held.document.get("anew") else reuse.stored(session, hashes, convert.ENGINE_VERSION)
    known_numbers = {point.point for point in known}
    unknown = [line for line in lines if line.number not in known_numbers]
    return itertools.chain(known, _with_hashes(convert.run_stack(analysis, unknown, _STOPS), hashes))


def _with_hashes(steps: Iterator[Advance | PointResult], hashes: Mapping[int, str]) -> Iterator[Advance | PointResult]:
    for item in steps:
        yield replace(item, input_hash=hashes[item.point]) if isinstance(item, PointResult) else item


def _compute(
    steps: Iterator[Advance | PointResult], held: Claim, settings: Settings, pulse: Pulse, points: list[PointResult]
) -> Failure | None:
    """Run the engine and collect the points until it ends, fails, exceeds the time limit, or a heartbeat says stop."""
    try:
        _collect(steps, settings, pulse, points)
    except (InvalidSpec, ValidationError) as error:
        return Failure(FailureKind.INPUT, str(error))
    except SoftTimeLimitExceeded:
        return Failure(FailureKind.TIME_LIMIT, leases.time_limit_sentence(settings))
    except Exception as error:
        _logger.exception("the engine failed")
        sentence = f"The computation stopped on an internal error ({type(error).__name__}); the log has the details."
        return Failure(FailureKind.INTERNAL, sentence)
    failures = [point.failure for point in points if point.failure is not None]
    if failures and len(failures) == len(points):
        internal = any(point.failed_internally for point in points)
        return Failure(FailureKind.INTERNAL if internal else FailureKind.NO_CONVERGENCE, failures[0])
    return None


def _collect(
    steps: Iterator[Advance | PointResult], settings: Settings, pulse: Pulse, points: list[PointResult]
) -> None:
    deadline = time.monotonic() + settings.soft_time_limit_seconds
    for item in steps:
        if isinstance(item, PointResult):
            points.append(item)
        else:
            pulse.report(item)
        if pulse.verdict is not Beat.GO_ON:
            return
        if time.monotonic() > deadline:
            raise SoftTimeLimitExceeded


def _conclude(session: Session, held: Claim, verdict: Beat, failure: Failure | None, points: list[PointResult]) -> bool:
    """Write the end of the job; return False if a later attempt has the job."""
    if verdict is Beat.LOST:
        return False
    if verdict is Beat.CANCEL:
        return leases.dismiss(session, held)
    if failure is not None:
        return leases.fail(session, held, failure, points)
    return leases.finish(session, held, points)
