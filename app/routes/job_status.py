"""What the routes of jobs share: finding a job, its status document and its links."""

from datetime import datetime
from typing import Any
from uuid import UUID

from sqlalchemy.orm import Session

from app import plots
from app.coalescing.grouped_calls import GroupedCalls
from app.http.problems import ProblemError, ProblemKind
from app.jobs import job_records
from app.routes.dependencies import PREFIX
from app.security.caller import Caller, Owned
from app.tables import Job, JobStatus

_TABLE_LINKS = ("frequencies", "internal-resonances", "critical-wind-speeds", "limit-cycles")


async def find_status(statuses: GroupedCalls[Owned, Job | None], caller: Caller, job_id: UUID) -> Job:
    """Return a job of the caller's owner without its document.

    Raises
    ------
    ProblemError
        404 if the owner has no job of that id, even if another owner has.
    """
    job = await statuses.call(Owned(caller.owner, job_id))
    if job is None:
        raise _no_job(job_id)
    return job


def find_job(session: Session, caller: Caller, job_id: UUID) -> Job:
    """Return a job of the caller's owner.

    Raises
    ------
    ProblemError
        404 if the owner has no job of that id, even if another owner has.
    """
    job = job_records.get(session, caller.owner, job_id)
    if job is None:
        raise _no_job(job_id)
    return job


def _no_job(job_id: UUID) -> ProblemError:
    return ProblemError(ProblemKind.NOT_FOUND, f"There is no job {job_id}.")


def job_address(job_id: UUID) -> str:
    """Return the address of a job's status."""
    return f"{PREFIX}/jobs/{job_id}"


def failure_of(job: Job) -> dict[str, Any] | None:
    """Return the kind and the sentence of a job's failure, None if it has not failed."""
    return {"kind": job.failure_kind.value, "detail": job.failure_detail} if job.failure_kind else None


def seconds_between(begin: datetime | None, end: datetime | None) -> float | None:
    """Return the time between two moments [s], None if one of them is not known."""
    return None if begin is None or end is None else (end - begin).total_seconds()


def job_document(job: Job) -> dict[str, Any]:
    """Return the status document of a job."""
    return {
        "id": str(job.id),
        "status": job.status.value,
        "progress": job.progress,
        "step": job.step,
        "name": job.name,
        "asset_id": job.asset_id,
        "tags": {tag.key: tag.value for tag in job.tags},
        "created_at": job.created_at.isoformat(),
        "started_at": job.started_at.isoformat() if job.started_at else None,
        "finished_at": job.finished_at.isoformat() if job.finished_at else None,
        "duration_seconds": seconds_between(job.started_at, job.finished_at),
        "attempt": job.attempt,
        "cancel_requested": job.cancel_requested,
        "failure": failure_of(job),
        "engine_version": job.engine_version,
        "reused_from": str(job.reused_from) if job.reused_from else None,
        "links": _links(job),
    }


def _links(job: Job) -> list[dict[str, str]]:
    address = job_address(job.id)
    links = [{"rel": "self", "href": address}]
    if job.status in {JobStatus.SUCCESSFUL, JobStatus.FAILED}:
        links.append({"rel": "results", "href": f"{address}/results"})
        links += [{"rel": name, "href": f"{address}/results/{name}"} for name in _TABLE_LINKS]
        links += [{"rel": f"{name}-plot", "href": f"{address}/plots/{name}.svg"} for name in plots.PICTURES]
    return links
