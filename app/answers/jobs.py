"""States of jobs."""

from datetime import datetime
from typing import Annotated, Literal
from uuid import UUID

from pydantic import Field

from app.schemas.fields import Answer, example_of, told

Status = Literal["accepted", "running", "successful", "failed", "dismissed"]


class Failure(Answer):
    """Why a job failed: its input or model, or the service."""

    kind: Literal["input", "no_convergence", "time_limit", "worker_lost", "internal"] = told(
        "Who is to act: input, no_convergence and time_limit concern the line, the others the service", "time_limit"
    )
    detail: str | None = told("Why, in a sentence", "The job ran longer than 3600 s.")


class Link(Answer):
    """Where to go on."""

    rel: str = told("What lies there", "self")
    href: str = told("Address", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")


class JobDocument(Answer):
    """State of a job."""

    id: UUID = told("Identity of the job", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")
    status: Status = told("State; the last three are final", "running")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = told("How much is done, 0 to 1 [1]", 0.4)
    step: str = told("What is being done", "limit cycles, hybrid, 1 loop")
    name: str | None = told("Name of the line", "C11 twin, 126 m")
    asset_id: str | None = told("Identity of the line in the owner's records", "L204-S017")
    tags: dict[str, str] = told("Labels of the line", {"region": "north"})
    created_at: datetime = told("When the job was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = told("When its last attempt began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = told("When it ended", "2026-11-22T10:00:05+00:00")
    attempt: int = told("Attempts so far; another follows if a worker is lost [1]", 1)
    cancel_requested: bool = told("Whether the running job was asked to stop", False)
    failure: Failure | None = told("Why it failed; null if it did not", example_of(Failure))
    engine_version: str | None = told("Version of the computation; null before it", "0.1.0")
    reused_from: UUID | None = told(
        "Job, or chunk of a batch, whose stored results of the same input these are; null if they were computed",
        "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d80",
    )
    links: list[Link] = told("Where to go on", [example_of(Link)])


class JobPage(Answer):
    """Some jobs, newest first."""

    jobs: list[JobDocument] = told("The jobs of the page", [example_of(JobDocument)])
    next: str | None = told(
        "Address of the next page; null on the last", "/v1/jobs?limit=50&cursor=AZmjxFt-fBqdLj9KW2x9jg"
    )
