"""Server-sent events: changes of a job or a batch, as they happen."""

import re
from collections.abc import AsyncIterator
from contextlib import aclosing
from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Depends, Header
from fastapi.sse import EventSourceResponse, ServerSentEvent
from sqlalchemy import func, select

from app.http.conditional import Bodiless
from app.http.problems import ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.jobs import batch_progress
from app.jobs.watched_states import BatchSeen, Happening
from app.routes import documentation
from app.routes.batch_status import find_batch, line_counts
from app.routes.dependencies import PREFIX, CallerOf, Readers, SettingsOf
from app.routes.job_status import find_job
from app.routes.waiting import BatchWatch, JobWatch
from app.security.caller import Owned
from app.tables import ENDED, JobEvent, JobEventKind

router = APIRouter(prefix=PREFIX, route_class=KnownParametersRoute)

_NUMBER = re.compile(r"[0-9]{1,18}")
_KINDS_WITH_DETAIL = frozenset({JobEventKind.FAILED, JobEventKind.RELEASED})
_LastId = Annotated[
    str | None,
    Header(
        alias="Last-Event-ID",
        description="Id of the last event received; the stream continues after it",
        examples=["17"],
    ),
]
_STREAM: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "Events until the final state, by default for an hour at most; "
        "a comment every 15 s keeps the connection alive",
        "content": {
            "text/event-stream": {
                "schema": {"type": "string"},
                "example": 'event: running\ndata: {"status": "running", "at": "2026-11-22T10:00:01+00:00", '
                '"attempt": 1, "detail": null}\nid: 17\n\n',
            }
        },
    },
    204: {"description": "The client has all events; a browser then stops reconnecting"},
    **documentation.problems(ProblemKind.NOT_FOUND),
}


def _last_job_event(job_id: UUID, caller: CallerOf, readers: Readers, last_event_id: _LastId = None) -> int:
    """Return the id of the last event that the client received, 0 if none.

    Raises
    ------
    ProblemError
        404 if there is no such job.
    Bodiless
        204 if the job has ended and the client received its last event.
    """
    last = int(last_event_id) if last_event_id and _NUMBER.fullmatch(last_event_id) else 0
    with readers() as session:
        job = find_job(session, caller, job_id)
        newest = session.scalar(select(func.max(JobEvent.id)).where(JobEvent.job_id == job_id)) or 0
    if job.status in ENDED and last >= newest:
        raise Bodiless(204)
    return last


def _last_batch_event(batch_id: UUID, caller: CallerOf, readers: Readers, last_event_id: _LastId = None) -> str:
    """Return the id of the last event that the client received; 404 and 204 as for jobs."""
    with readers() as session:
        find_batch(session, caller, batch_id)
        counts = batch_progress.counts(session, [batch_id])[batch_id]
    if counts.status in ENDED and last_event_id == _batch_event_id(counts):
        raise Bodiless(204)
    return last_event_id or ""


@router.get(
    "/jobs/{job_id}/events",
    summary="Follow a job",
    response_class=EventSourceResponse,
    responses=_STREAM,
    tags=["jobs"],
)
async def job_events(
    job_id: UUID,
    caller: CallerOf,
    settings: SettingsOf,
    watch: JobWatch,
    last: Annotated[int, Depends(_last_job_event)],
) -> AsyncIterator[ServerSentEvent]:
    """Stream the events of a job: one with an id for each change of state, and its progress in between.

    A client that reconnects with `Last-Event-ID` receives the events that it missed. The stream ends with the final
    state, or by default after an hour; the client then reconnects.
    """
    async with aclosing(watch.follow(Owned(caller.owner, job_id), settings.stream_seconds)) as states:
        async for job in states:
            for happening in job.events:
                if happening.id > last:
                    last = happening.id
                    yield _job_event(happening)
            if job.ended:
                return
            if job.progress:
                yield ServerSentEvent(event="progress", data={"progress": job.progress, "step": job.step})


@router.get(
    "/batches/{batch_id}/events",
    summary="Follow a batch",
    response_class=EventSourceResponse,
    responses=_STREAM,
    tags=["batches"],
)
async def batch_events(
    batch_id: UUID,
    caller: CallerOf,
    settings: SettingsOf,
    watch: BatchWatch,
    last: Annotated[str, Depends(_last_batch_event)],
) -> AsyncIterator[ServerSentEvent]:
    """Stream the state of a batch and its lines by state at every change, until no line waits or runs.

    By default a stream ends after an hour at the latest; the client then reconnects.
    """
    async with aclosing(watch.follow(Owned(caller.owner, batch_id), settings.stream_seconds)) as states:
        async for batch in states:
            if _batch_event_id(batch.counts) != last:
                yield _batch_event(batch)
            if batch.ended:
                return


def _job_event(happening: Happening) -> ServerSentEvent:
    data = {
        "status": happening.kind.value,
        "at": happening.at.isoformat(),
        "attempt": happening.attempt,
        # The details of other events concern the operator only.
        "detail": happening.detail if happening.kind in _KINDS_WITH_DETAIL else None,
    }
    return ServerSentEvent(id=str(happening.id), event=happening.kind.value, data=data)


def _batch_event(batch: BatchSeen) -> ServerSentEvent:
    counts = batch.counts
    lines = line_counts(counts, batch.rejected_lines)
    data = {"status": counts.status.value, "progress": counts.progress, "lines": lines}
    return ServerSentEvent(id=_batch_event_id(counts), event=counts.status.value, data=data)


def _batch_event_id(counts: batch_progress.Counts) -> str:
    """Return an id that equal states of a batch share."""
    lines = counts.accepted, counts.running, counts.successful, counts.failed, counts.dismissed
    return "-".join(map(str, (*lines, f"{counts.progress:.6f}")))
