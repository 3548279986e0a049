"""PostgreSQL's processor time for a claim, a heartbeat and a sweep, besides that for the lines of a chunk."""

import statistics
from collections.abc import Callable, Iterator

from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.tables.jobs import Job, JobStatus
from benchmarks.processor import seconds_by_role
from worker.sweep import sweep

JOBS = 400
RUNS = 3


def lease_costs(settings: Settings) -> Iterator[tuple[str, float]]:
    """Yield the processor times [ms], on a database in which more than JOBS jobs wait for a worker."""
    engine = make_engine(settings)
    sessions = session_factory(engine)
    try:
        with sessions() as session:
            waiting = list(session.scalars(select(Job.id).where(Job.status == JobStatus.ACCEPTED).limit(JOBS)))
        held = []

        def claim(number: int) -> None:
            with sessions.begin() as session:
                taken = leases.claim(session, waiting[number], "measured", settings.lease_seconds)
            assert taken is not None
            held.append(taken)

        def beat(number: int) -> None:
            with sessions.begin() as session:
                leases.heartbeat(session, held[number], settings.lease_seconds, 0.5, "half")

        def end(number: int) -> None:
            with sessions.begin() as session:
                leases.finish(session, held[number], ())

        claiming = _database_ms(claim, len(waiting))
        yield "heartbeat_database_ms", statistics.median(_database_ms(beat, len(waiting)) for _ in range(RUNS))
        yield "claim_database_ms", claiming + _database_ms(end, len(waiting))
        yield (
            "sweep_database_ms",
            statistics.median(_database_ms(_sweeping(sessions, settings), 50) for _ in range(RUNS)),
        )
    finally:
        engine.dispose()


def _sweeping(sessions: sessionmaker[Session], settings: Settings) -> Callable[[int], None]:
    def once(_: int) -> None:
        sweep(sessions, settings)

    return once


def _database_ms(task: Callable[[int], None], count: int) -> float:
    """Return PostgreSQL's mean processor time for a task [ms] over a number of runs."""
    before = seconds_by_role()
    for number in range(count):
        task(number)
    return 1e3 * (seconds_by_role() - before)["postgres"] / count
