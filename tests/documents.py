"""Requests and results for tests of jobs."""

import json
from pathlib import Path
from typing import Any
from uuid import UUID

from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.convert import TABLES, PointResult
from app.jobs import job_records, submissions
from app.jobs.job_records import Submission
from app.jobs.submissions import Order
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.security.caller import LOCAL, Caller, Scope
from app.tables import Job, JobEvent, PointRow

STRANGER = Caller("stranger", frozenset(Scope))
"""Somebody else than the caller of a service without keys."""


def short_request() -> dict[str, Any]:
    """Return a request that takes a small part of a second."""
    analysis = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 5.0, 6.0]}
    return {"line": example("c11-twin"), "analysis": analysis}


def long_request(points: int) -> dict[str, Any]:
    """Return a study whose every point takes about half a second, so that a test can break in on it."""
    winds = {"start": 3.0, "stop": 12.0, "count": 20}
    analysis = {"loops": [1, 2], "models": ["hybrid", "finite_element"], "wind_speeds_m_per_s": winds}
    tensions = [25000.0 + 100.0 * number for number in range(points)]
    study = {"axes": [{"parameter": "span.horizontal_tension_n", "values": tensions}]}
    return {"line": example("c11-twin"), "analysis": analysis, "study": study}


def silent_request() -> dict[str, Any]:
    """Return a request whose step `SILENT_STEP` takes a minute or more without a word from the engine."""
    winds = {"start": 3.0, "stop": 20.0, "count": 60}
    analysis = {"loops": [1, 2, 3, 4, 5, 6], "models": ["finite_element"], "wind_speeds_m_per_s": winds}
    return {"line": example("c11-twin"), "analysis": analysis}


SILENT_STEP = "limit cycles of the finite element model"


def point_result(number: int = 0, *, tension: float = 30000.0, failure: str | None = None) -> PointResult:
    """Return a point with one frequency row, which carries the tension, or a failed one without rows."""
    row = {"model": "hybrid", "loops": 1, "vertical_hz": 0.48, "horizontal_hz": 0.45, "torsional_hz": None}
    found = [] if failure else [{**row, "outcome": "converged"}]
    return PointResult(
        point=number,
        axes={"span.horizontal_tension_n": tension},
        static={} if failure else {"horizontal_tension_n": tension, "catenary_parameter_m": 1285.5, "sag_m": 1.54},
        den_hartog={} if failure else {"coefficient": -3.2, "unstable": True},
        ranking_figures={},
        tables_json=json.dumps({name: found if name == "frequencies" else [] for name in TABLES}).encode(),
        orbits_json=b"[]",
        warnings=[],
        engine_version="9.9.9",
        failure=failure,
    )


def hasty_settings(directory: Path) -> Settings:
    """Return settings of an embedded service with short times, whose every file lies in a directory."""
    return Settings(
        data_dir=directory,
        lease_seconds=3.0,
        heartbeat_seconds=0.1,
        sweep_seconds=0.3,
        redispatch_seconds=1.5,
        shutdown_seconds=1.0,
        worker_processes=2,
    )


def create_job(session: Session, caller: Caller, document: dict[str, Any], **labels: Any) -> Job:
    """Make a job that waits for a worker, for the caller of this to commit."""
    (job,) = submissions.accept(session, [Order(Submission(caller, document, **labels), may_reuse=False)])
    assert isinstance(job, Job)
    return job


def add_job(sessions: sessionmaker[Session], document: dict[str, Any] | None = None) -> UUID:
    """Make a committed job and return its id."""
    with sessions.begin() as session:
        return create_job(session, LOCAL, document or {"line": {}}).id


def look(sessions: sessionmaker[Session], job_id: UUID) -> Job:
    """Return the job as the database has it now."""
    with sessions() as session:
        job = job_records.get(session, LOCAL.owner, job_id)
    assert job is not None
    return job


def history(sessions: sessionmaker[Session], job_id: UUID) -> list[tuple[str, int]]:
    """Return the kinds of the job's events with their attempts, in order."""
    statement = select(JobEvent.kind, JobEvent.attempt).where(JobEvent.job_id == job_id).order_by(JobEvent.id)
    with sessions() as session:
        return [(kind.value, attempt) for kind, attempt in session.execute(statement)]


def count_points(sessions: sessionmaker[Session], job_id: UUID) -> int:
    """Return how many points of the job have results."""
    with sessions() as session:
        found = session.scalar(select(func.count()).select_from(PointRow).where(PointRow.job_id == job_id))
    return found or 0
