"""The dependency of results and pictures: a finished job, and the entity tags that the client has."""

from dataclasses import dataclass
from typing import Annotated
from uuid import UUID

from fastapi import Depends, Header

from app.http.conditional import strong_tag, unless_known
from app.http.problems import ProblemError, ProblemKind
from app.routes.dependencies import RETRY_SECONDS, CallerOf, Readers
from app.routes.job_status import find_job, job_address
from app.tables import Job, JobStatus

KnownTags = Annotated[
    str,
    Header(alias="If-None-Match", description="Entity tags of the answers that the client has", examples=['"4f1d"']),
]


@dataclass(frozen=True, slots=True)
class _FinishedJob:
    """A finished job, and the entity tags of the answers that the client has."""

    job: Job
    known: str

    def headers(self, form: str) -> dict[str, str]:
        """Return the headers of an answer in this format.

        Raises
        ------
        Bodiless
            304 if the client has this answer.
        """
        job = self.job
        return unless_known(self.known, strong_tag(job.input_hash, job.engine_version, job.status, form))


def _finished_job(job_id: UUID, caller: CallerOf, readers: Readers, known: KnownTags = "") -> _FinishedJob:
    with readers() as session:
        job = find_job(session, caller, job_id)
    if job.status is JobStatus.DISMISSED:
        raise ProblemError(ProblemKind.DISMISSED, "The job was cancelled and has no results.")
    if job.status in {JobStatus.ACCEPTED, JobStatus.RUNNING}:
        raise ProblemError(
            ProblemKind.NOT_READY,
            f"The job is {job.status.value}, {job.progress:.0%} done.",
            links=[{"rel": "status", "href": job_address(job_id)}],
            headers={"Retry-After": RETRY_SECONDS},
        )
    return _FinishedJob(job, known)


FinishedJob = Annotated[_FinishedJob, Depends(_finished_job)]
