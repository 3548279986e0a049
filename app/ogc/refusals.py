"""Refusals about jobs, as OGC API - Processes names them."""

from app.http.problems import ProblemError, ProblemKind
from app.tables import FailureKind, Job, JobStatus

_EXCEPTIONS = "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0"
_OF_THE_LINE = frozenset({FailureKind.INPUT, FailureKind.NO_CONVERGENCE, FailureKind.TIME_LIMIT})


def missing(name: str, detail: str) -> ProblemError:
    """Return the 404 problem under the name that the standard gives it."""
    return ProblemError(ProblemKind.NOT_FOUND, detail, type_address=f"{_EXCEPTIONS}/{name}")


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
