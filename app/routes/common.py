"""What several routes share: the state of the application, finding a job, and its status document."""

from collections.abc import Callable, Generator, Iterator, Mapping
from typing import Annotated, Any
from uuid import UUID

from fastapi import Depends, Header, Request
from fastapi.responses import StreamingResponse
from sqlalchemy.orm import Session, sessionmaker
from starlette.types import Receive, Scope, Send

from app.coalescing.grouped_calls import Groups
from app.http.problems import ProblemError, ProblemKind, invalid_document
from app.jobs import job_records
from app.jobs.dispatch import Sender
from app.jobs.job_records import Draft
from app.runtime.settings import Settings
from app.schemas.faults import Fault
from app.security import webhook_addresses
from app.security.caller import Caller, Owned
from app.security.webhook_addresses import RefusedAddress
from app.tables import Job, JobStatus

PREFIX = "/v1"
RETRY_SECONDS = "1"

_TABLE_LINKS = ("frequencies", "internal-resonances", "critical-wind-speeds", "limit-cycles")
_PLOT_LINKS = ("amplitude", "orbit", "modes", "study")


# The dependencies are coroutines, since a plain function would be called in a thread of its own at every request.
async def _settings(request: Request) -> Settings:
    settings: Settings = request.app.state.settings
    return settings


async def _readers(request: Request) -> sessionmaker[Session]:
    factory: sessionmaker[Session] = request.app.state.readers
    return factory


async def _writers(request: Request) -> sessionmaker[Session]:
    factory: sessionmaker[Session] = request.app.state.writers
    return factory


async def _sender(request: Request) -> Sender:
    sender: Sender = request.app.state.sender
    return sender


async def _caller(request: Request) -> Caller:
    caller: Caller = request.state.caller  # the gate lets nobody through without
    return caller


SettingsOf = Annotated[Settings, Depends(_settings)]
Readers = Annotated[sessionmaker[Session], Depends(_readers)]
Writers = Annotated[sessionmaker[Session], Depends(_writers)]
SenderOf = Annotated[Sender, Depends(_sender)]
CallerOf = Annotated[Caller, Depends(_caller)]


async def find_status(statuses: Groups[Owned, Job | None], caller: Caller, job_id: UUID) -> Job:
    """Return a job of the caller's owner with all but its document.

    Raises
    ------
    ProblemError
        404 if the owner has none of that id, whoever else may have one.
    """
    job = await statuses.ask(Owned(caller.owner, job_id))
    if job is None:
        raise _no_job(job_id)
    return job


class _ClosedStream(StreamingResponse):
    """A stream whose generator is closed when the answer ends, also where the client leaves before its end."""

    def __init__(self, pieces: Generator[str | bytes, None, None], media_type: str, headers: Mapping[str, str]) -> None:
        """Take the generator of the pieces."""
        super().__init__(pieces, media_type=media_type, headers=headers)
        self._pieces = pieces

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the pieces, and let go of what they hold."""
        try:
            await super().__call__(scope, receive, send)
        finally:
            self._pieces.close()


def streamed(
    readers: sessionmaker[Session],
    pieces: Callable[[Session], Iterator[str] | Iterator[bytes]],
    media_type: str,
    headers: Mapping[str, str],
) -> StreamingResponse:
    """Answer with pieces that are read from the database while they are sent, in one session that is closed after."""

    def stream() -> Generator[str | bytes, None, None]:
        with readers() as session:
            yield from pieces(session)

    return _ClosedStream(stream(), media_type, headers)


def find_job(session: Session, caller: Caller, job_id: UUID) -> Job:
    """Return a job of the caller's owner.

    Raises
    ------
    ProblemError
        404 if the owner has none of that id, whoever else may have one.
    """
    job = job_records.get(session, caller.owner, job_id)
    if job is None:
        raise _no_job(job_id)
    return job


def _no_job(job_id: UUID) -> ProblemError:
    return ProblemError(ProblemKind.NOT_FOUND, f"There is no job {job_id}.")


async def _may_reuse(
    cache_control: Annotated[
        str, Header(description="`no-cache` computes even what is stored already", examples=["no-cache"])
    ] = "",
) -> bool:
    return "no-cache" not in cache_control.lower()


MayReuse = Annotated[bool, Depends(_may_reuse)]


async def vet_webhook(settings: Settings, url: str) -> None:
    """See to it that a webhook may be sent to an address.

    Raises
    ------
    ProblemError
        422 if nothing is sent there.
    """
    try:
        await webhook_addresses.vet(url, private=settings.webhook_private_networks)
    except RefusedAddress as error:
        raise invalid_document([Fault("/webhook_url", "refused_address", str(error))]) from error


def job_address(job_id: UUID) -> str:
    """Return the address of a job's status."""
    return f"{PREFIX}/jobs/{job_id}"


def failure_of(job: Job | Draft) -> dict[str, Any] | None:
    """Return kind and sentence of a job's failure, None if it has not failed."""
    return {"kind": job.failure_kind.value, "detail": job.failure_detail} if job.failure_kind else None


def job_document(job: Job | Draft) -> dict[str, Any]:
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
        "attempt": job.attempt,
        "cancel_requested": job.cancel_requested,
        "failure": failure_of(job),
        "engine_version": job.engine_version,
        "reused_from": str(job.reused_from) if job.reused_from else None,
        "links": _links(job),
    }


def _links(job: Job | Draft) -> list[dict[str, str]]:
    address = job_address(job.id)
    links = [{"rel": "self", "href": address}]
    if job.status in {JobStatus.SUCCESSFUL, JobStatus.FAILED}:
        links.append({"rel": "results", "href": f"{address}/results"})
        links += [{"rel": name, "href": f"{address}/results/{name}"} for name in _TABLE_LINKS]
        links += [{"rel": f"{name}-plot", "href": f"{address}/plots/{name}.svg"} for name in _PLOT_LINKS]
    return links
