"""Status documents of jobs."""

from datetime import datetime
from typing import Annotated, Literal
from uuid import UUID

from pydantic import Field

from app.schemas.fields import Answer, described, example_of

Status = Literal["accepted", "running", "successful", "failed", "dismissed"]


class Failure(Answer):
    """Why a job failed: its input or model, or the service."""

    kind: Literal["input", "no_convergence", "time_limit", "worker_lost", "internal"] = described(
        "Cause: input, no_convergence and time_limit come from the line, the others from the service", "time_limit"
    )
    detail: str | None = described("Cause in a sentence", "The job ran longer than 3600 s.")


class Link(Answer):
    """A link to a related address."""

    rel: str = described("Relation of the address", "self")
    href: str = described("Address", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")


class JobDocument(Answer):
    """Status of a job."""

    id: UUID = described("Identity of the job", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")
    status: Status = described("State; the last three are final", "running")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = described("Share of the work done, 0 to 1 [1]", 0.4)
    step: str = described("Current step", "limit cycles, hybrid, 1 loop")
    name: str | None = described("Name of the line", "C11 twin, 126 m")
    asset_id: str | None = described("Identity of the line in the owner's records", "L204-S017")
    tags: dict[str, str] = described("Labels of the line", {"region": "north"})
    created_at: datetime = described("When the job was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = described("When its last attempt began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = described("When it ended", "2026-11-22T10:00:05+00:00")
    duration_seconds: float | None = described(
        "Time from the begin of its last attempt to its end; null unless it has both [s]", 4.0
    )
    attempt: int = described("Attempts so far; the service starts another if a worker is lost [1]", 1)
    cancel_requested: bool = described("Whether the running job was asked to stop", False)
    failure: Failure | None = described("Why it failed; null if it did not", example_of(Failure))
    engine_version: str | None = described("Version of the engine; null before the computation", "0.1.0")
    reused_from: UUID | None = described(
        "Job, or chunk of a batch, from which the results of the same input were copied; null if computed",
        "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d80",
    )
    links: list[Link] = described("Links to related addresses", [example_of(Link)])


class JobEstimate(Answer):
    """What a valid request would cost as a job; nothing was stored."""

    valid: bool = described("Always true: a request with faults gets a problem that lists them", True)
    points: int = described("Points of the study; 1 without a study [1]", 1)
    seconds: float | None = described(
        "Computing time on one core, estimated; null for a placement or remedies, where searches decide it [s]", 0.65
    )


class JobPage(Answer):
    """One page of jobs, newest first."""

    jobs: list[JobDocument] = described("The jobs of the page", [example_of(JobDocument)])
    next: str | None = described(
        "Address of the next page; null on the last", "/v1/jobs?limit=50&cursor=AZmjxFt-fBqdLj9KW2x9jg"
    )
