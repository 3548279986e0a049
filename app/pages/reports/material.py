"""What a report is made of, as plain values that may go to another process."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy.orm import Session

from app.convert import PointResult
from app.pages.findings import Findings, Row
from app.pages.motions import Motion, motions
from app.tables import Job


@dataclass(frozen=True, slots=True)
class Material:
    """A result at one point, and whose it is.

    `job` maps the facts of the job, as they are shown, to their words; it is empty for a result without a job.
    """

    name: str | None
    found: Findings
    motions: Sequence[Motion]
    orbits: Sequence[Row]
    made: datetime
    job: Mapping[str, str]


def job_material(session: Session, job: Job, found: Findings, orbits: Sequence[Row]) -> Material:
    """Return the material of a job that has ended, with the Fourier coefficients of the point's motions."""
    facts = {
        "job": str(job.id),
        "asset": job.asset_id,
        "submitted": _moment(job.created_at),
        "finished": _moment(job.finished_at),
        "input": job.input_hash[:16],
    }
    told = {name: text for name, text in facts.items() if text}
    return Material(job.name, found, motions(session, job, found), orbits, job.finished_at or job.created_at, told)


def computed_material(request: Mapping[str, Any], point: PointResult, made: datetime) -> Material:
    """Return the material of a result that was computed without a service."""
    here = {
        "point": point.point,
        "axes": point.axes,
        "static": point.static,
        "warnings": point.warnings,
        "engine_version": point.engine_version,
        "failure": point.failure,
    }
    found = Findings(point.point, [here], request["line"], request["analysis"], point.tables)
    cycles = point.tables["limit_cycles"]
    seen = [Motion(orbit["cycle"], cycles[orbit["cycle"]], orbit) for orbit in point.orbits]
    return Material(request["line"].get("name"), found, seen, point.orbits, made, {})


def _moment(moment: datetime | None) -> str | None:
    return None if moment is None else f"{moment:%Y-%m-%d %H:%M:%S} UTC"
