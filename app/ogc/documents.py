"""Documents about jobs, as OGC API - Processes writes them."""

from collections.abc import Iterator
from typing import Any

from sqlalchemy.orm import Session

from app import convert
from app.export import formats
from app.http.problems import ProblemError, ProblemKind
from app.ogc.descriptions import BASE, PROCESS, link
from app.routes.job_status import failure_of
from app.storage import stored_results
from app.tables import ENDED, FailureKind, Job, JobStatus

_EXCEPTIONS = "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0"
_OF_THE_LINE = frozenset({FailureKind.INPUT, FailureKind.NO_CONVERGENCE, FailureKind.TIME_LIMIT})


def missing(name: str, detail: str) -> ProblemError:
    """Return the 404 problem under the name that the standard gives it."""
    return ProblemError(ProblemKind.NOT_FOUND, detail, type_address=f"{_EXCEPTIONS}/{name}")


def status_info(job: Job) -> dict[str, Any]:
    """Return the status document of a job."""
    address = f"{BASE}/jobs/{job.id}"
    moments = {"created": job.created_at, "started": job.started_at, "finished": job.finished_at}
    links = [link("self", address, "Status of the job"), link("alternate", f"/v1/jobs/{job.id}", "The job under /v1")]
    if job.status is JobStatus.SUCCESSFUL:
        links.append(link("http://www.opengis.net/def/rel/ogc/1.0/results", f"{address}/results", "Results"))
    return {
        "processID": PROCESS,
        "type": "process",
        "jobID": str(job.id),
        "status": job.status.value,
        "message": job.failure_detail or job.step or job.status.value,
        "progress": 100 if job.status in ENDED else int(100 * job.progress),
        **{name: moment.isoformat() for name, moment in moments.items() if moment is not None},
        "links": links,
    }


def require_success(job: Job) -> None:
    """Check that a job has results.

    Raises
    ------
    ProblemError
        404 while they are not ready, 410 after dismissal, 422 or 500 with the reason of a failure.
    """
    if job.status is JobStatus.DISMISSED:
        raise ProblemError(ProblemKind.DISMISSED, "The job was cancelled and has no results.")
    if job.status is JobStatus.FAILED:
        kind = ProblemKind.INVALID_DOCUMENT if job.failure_kind in _OF_THE_LINE else ProblemKind.INTERNAL
        raise ProblemError(kind, job.failure_detail or "The job failed.")
    if job.status is not JobStatus.SUCCESSFUL:
        raise missing("result-not-ready", f"The job is {job.status.value}, {job.progress:.0%} done.")


def results(session: Session, job: Job, *, raw: bool) -> Iterator[str]:
    """Yield the pieces of the results: those of `/v1` themselves, or in an object under the output's name."""
    points = list(stored_results.points(session, job.id))
    tables = {name: stored_results.rows(session, job.id, name) for name in convert.TABLES}
    text = formats.result_text(job.document, points, tables, failure_of(job))
    if raw:
        yield from text
        return
    yield '{"result":{"mediaType":"application/json","value":'
    yield from text
    yield "}}"
