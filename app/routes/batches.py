"""Batches: many lines sent at once, looked at, listed, resubmitted, cancelled."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Annotated, Any
from urllib.parse import urlencode
from uuid import UUID

import anyio
from anyio import CapacityLimiter, from_thread, to_thread
from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field
from sqlalchemy.orm import Session, sessionmaker

from app import batches, convert, intake, paging
from app.auth import Caller
from app.errors import ProblemError, ProblemKind, invalid_document, query_fault
from app.faults import BadInput, parse_json
from app.intake import BodyTooLarge, Incoming, Receipt
from app.jobs import CancelOutcome
from app.queue import Sender
from app.routes import batch_documentation, documentation
from app.routes.batch_common import batch_address, batch_document, batch_summary, find_batch
from app.routes.common import ENDED, PREFIX, RETRY_SECONDS, CallerOf, Readers, SenderOf, SettingsOf, Writers
from app.schemas.batch import BatchDocument, BatchPage
from app.settings import Settings, cursor_key

router = APIRouter(prefix=f"{PREFIX}/batches", tags=["batches"])

_SILENT_SECONDS = 60.0
_TYPES = ("application/json", "application/x-ndjson", "text/csv")
_COMMON = documentation.problems(ProblemKind.NOT_FOUND)
_HEADERS = {
    "Location": {"description": "Address of the status", "schema": {"type": "string"}},
    "Retry-After": {"description": "Seconds to wait before looking", "schema": {"type": "integer"}},
}
_ACCEPTED = {
    **documentation.body("Accepted; Location leads to its status", ("application/json", batch_documentation.ACCEPTED)),
    "headers": _HEADERS,
}


def _limiter(request: Request) -> CapacityLimiter:
    """Return what bounds the threads that take in batches, so that slow senders leave the others to other requests."""
    state = request.app.state
    if not hasattr(state, "batch_limiter"):
        state.batch_limiter = CapacityLimiter(state.settings.batches_at_once)
    limiter: CapacityLimiter = state.batch_limiter
    return limiter


class IntakeQuery(BaseModel):
    """How a batch is taken in."""

    atomic: bool = Field(default=False, description="Take all lines or, if any is at fault, none")
    analysis: str | None = Field(default=None, max_length=20_000, description="Analysis of a CSV batch, as JSON")


@router.post(
    "",
    status_code=202,
    response_model=BatchDocument,
    responses={
        202: _ACCEPTED,
        **documentation.problems(
            ProblemKind.INVALID_PARAMETER,
            ProblemKind.TOO_LARGE,
            ProblemKind.UNSUPPORTED_MEDIA_TYPE,
            ProblemKind.INVALID_DOCUMENT,
        ),
    },
    openapi_extra=batch_documentation.request_body(),
)
async def submit(
    request: Request,
    caller: CallerOf,
    writers: Writers,
    sender: SenderOf,
    limiter: Annotated[CapacityLimiter, Depends(_limiter)],
    how: Annotated[IntakeQuery, Query()],
) -> JSONResponse:
    """Accept many lines under one analysis. Lines at fault are kept with their faults, the others run.

    Each line may hold a `reference` beside its own fields; it is given back with the results, as is `asset_id`.
    """
    settings: Settings = request.app.state.settings
    read = partial(_incoming, request, settings, how.analysis)
    receipt = await to_thread.run_sync(partial(_receive, writers, settings, caller, read, how.atomic), limiter=limiter)
    return await to_thread.run_sync(partial(_accepted, writers, sender, caller, receipt.batch_id, receipt.chunk_ids))


@router.get(
    "/{batch_id}",
    response_model=BatchDocument,
    responses={200: documentation.body("Status", ("application/json", batch_documentation.FINISHED)), **_COMMON},
)
def status(batch_id: UUID, caller: CallerOf, readers: Readers) -> JSONResponse:
    """Tell how far a batch is: its lines by state, and what is wrong with the first that were rejected."""
    with readers() as session:
        batch = find_batch(session, caller, batch_id)
        counts = batches.counts(session, [batch_id])[batch_id]
        headers = {} if counts.status in ENDED else {"Retry-After": RETRY_SECONDS}
        return JSONResponse(batch_document(session, batch, counts), headers=headers)


@router.get(
    "",
    response_model=BatchPage,
    responses={
        200: documentation.body("A page of batches, newest first", ("application/json", batch_documentation.PAGE)),
        **documentation.problems(ProblemKind.INVALID_PARAMETER),
    },
)
def list_batches(
    settings: SettingsOf,
    caller: CallerOf,
    readers: Readers,
    limit: Annotated[int, Query(ge=1, le=100, description="Batches on a page")] = 20,
    cursor: Annotated[str | None, Query(max_length=200, description="Place that a `next` address holds")] = None,
) -> JSONResponse:
    """List batches, newest first, a page at a time; `next` is the address of the following page."""
    key = cursor_key(settings)
    after = _place(key, cursor) if cursor else None
    with readers() as session:
        found = batches.page(session, caller.owner, after, limit + 1)
        shown = found[:limit]
        counts = batches.counts(session, [batch.id for batch in shown])
    following = None
    if len(found) > limit:
        place = paging.encode(key, (shown[-1].created_at, shown[-1].id))
        following = f"{router.prefix}?{urlencode({'limit': limit, 'cursor': place})}"
    documents = [batch_summary(batch, counts[batch.id]) for batch in shown]
    return JSONResponse({"batches": documents, "next": following})


@router.post(
    "/{batch_id}/resubmit", status_code=202, response_model=BatchDocument, responses={202: _ACCEPTED, **_COMMON}
)
def resubmit(
    batch_id: UUID, settings: SettingsOf, caller: CallerOf, writers: Writers, sender: SenderOf
) -> JSONResponse:
    """Run the lines that failed once more, under their numbers; if none has failed nothing changes."""
    with writers.begin() as session:
        batch = find_batch(session, caller, batch_id)
        size = intake.lines_a_chunk(settings, convert.read_analysis(batch.analysis))
        chunk_ids = batches.resubmit(session, caller, batch_id, size)
    return _accepted(writers, sender, caller, batch_id, chunk_ids)


@router.delete(
    "/{batch_id}",
    response_model=None,
    responses={
        200: {
            **documentation.body("Nothing runs any more", ("application/json", batch_documentation.DISMISSED)),
            "model": BatchDocument,
        },
        202: {
            **documentation.body("What runs will stop", ("application/json", batch_documentation.STOPPING)),
            "model": BatchDocument,
        },
        204: {"description": "A batch that had ended is removed with its results"},
        **_COMMON,
    },
)
def cancel(batch_id: UUID, caller: CallerOf, writers: Writers) -> Response:
    """Cancel what has not ended of a batch, or remove one that has ended."""
    with writers.begin() as session:
        batch = find_batch(session, caller, batch_id)
        outcome = batches.cancel(session, caller, batch_id)
        if outcome is CancelOutcome.REMOVED:
            return Response(status_code=204)
        document = batch_document(session, batch, batches.counts(session, [batch_id])[batch_id])
    if outcome is CancelOutcome.REQUESTED:
        return JSONResponse(document, 202, headers={"Retry-After": RETRY_SECONDS})
    return JSONResponse(document)


def _receive(
    writers: sessionmaker[Session], settings: Settings, caller: Caller, read: partial[Incoming], atomic: bool
) -> Receipt:
    try:
        return intake.receive(writers, settings, caller, read(), atomic=atomic)
    except BodyTooLarge as error:
        raise ProblemError(ProblemKind.TOO_LARGE, str(error), headers={"Connection": "close"}) from error
    except BadInput as error:
        raise invalid_document(error.faults) from error


def _incoming(request: Request, settings: Settings, analysis: str | None) -> Incoming:
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type not in _TYPES:
        said = f"The body is {media_type[:100]!r}, not one of {', '.join(_TYPES)}."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, said, headers={"Accept-Post": ", ".join(_TYPES)})
    if analysis is not None and media_type != "text/csv":
        raise query_fault("analysis", "only a CSV batch has its analysis in the query")
    pieces = _inflated(request, settings)
    if media_type == "application/json":
        return intake.read_json(pieces, settings.max_body_bytes)
    if media_type == "application/x-ndjson":
        return intake.read_ndjson(pieces, settings.max_batch_line_bytes)
    return intake.read_csv(pieces, _asked(analysis), settings.max_batch_line_bytes)


def _asked(analysis: str | None) -> Any:
    try:
        return parse_json((analysis or "{}").encode())
    except BadInput as error:
        raise query_fault("analysis", error.faults[0].detail) from error


def _inflated(request: Request, settings: Settings) -> Iterator[bytes]:
    encoding = request.headers.get("content-encoding", "identity").strip().lower()
    pieces = _pieces(request)
    if encoding == "gzip":
        return intake.gunzipped(pieces, settings.max_batch_bytes)
    if encoding != "identity":
        said = f"The content encoding {encoding[:100]!r} is not taken; gzip is."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, said, headers={"Accept-Encoding": "gzip"})
    return pieces


def _pieces(request: Request) -> Iterator[bytes]:
    """Yield the body in this thread as the event loop receives it: no piece is asked for before the last is used."""
    stream = request.stream()

    async def following() -> bytes | None:
        with anyio.fail_after(_SILENT_SECONDS):
            return await anext(stream, None)

    try:
        while (piece := from_thread.run(following)) is not None:
            yield piece
    except TimeoutError as error:
        said = f"Nothing of the body came for {_SILENT_SECONDS:g} s."
        raise ProblemError(ProblemKind.INVALID_DOCUMENT, said, headers={"Connection": "close"}) from error


def _accepted(
    writers: sessionmaker[Session], sender: Sender, caller: Caller, batch_id: UUID, chunk_ids: Sequence[UUID]
) -> JSONResponse:
    sender.send(chunk_ids, chunk=True)
    with writers() as session:
        batch = find_batch(session, caller, batch_id)
        document = batch_document(session, batch, batches.counts(session, [batch_id])[batch_id])
    return JSONResponse(document, 202, headers={"Location": batch_address(batch_id), "Retry-After": RETRY_SECONDS})


def _place(key: bytes, cursor: str) -> paging.Place:
    try:
        return paging.decode(key, cursor)
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error
