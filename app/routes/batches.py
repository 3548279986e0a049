"""Read, list, resubmit and cancel batches."""

from typing import Annotated
from urllib.parse import urlencode
from uuid import UUID

from fastapi import APIRouter, Depends, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.orm import Session

from app import convert
from app.answers.batches import BatchDocument, BatchPage
from app.batches import batch_records, intake
from app.http import paging
from app.http.prefix import LinkedJSON
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.jobs import batch_progress, idempotency
from app.jobs.job_records import CancelOutcome
from app.routes import batch_documentation, documentation
from app.routes.batch_status import (
    BATCHES,
    accepted_batch,
    batch_address,
    batch_document,
    batch_summary,
    find_batch,
)
from app.routes.dependencies import RETRY_SECONDS, CallerOf, Readers, SenderOf, SettingsOf, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.routes.moments import Moment
from app.routes.own_quotas import QUOTA_PROBLEMS
from app.routes.waiting import APPLIED_HEADER, BatchWatch, Wait, applied, wait_for_end
from app.runtime.signing import signing_key
from app.security.caller import Owned
from app.tables import ENDED

router = APIRouter(prefix=BATCHES, tags=["batches"], route_class=KnownParametersRoute)


class BatchListQuery(BaseModel):
    """Filters of a list of batches, and where the page begins."""

    model_config = ConfigDict(extra="forbid")

    created_after: Moment | None = Field(
        default=None, description="Only batches created after this time, with a time zone"
    )
    created_before: Moment | None = Field(
        default=None, description="Only batches created before this time, with a time zone"
    )
    limit: int = Field(default=20, ge=1, le=100, description="Most batches on the page")
    cursor: str | None = Field(default=None, max_length=200, description="Cursor from a `next` address")


_COMMON = documentation.problems(ProblemKind.NOT_FOUND)


async def _wait_for_batch(batch_id: UUID, caller: CallerOf, watch: BatchWatch, wait: Wait) -> int | None:
    """Wait as long as the client prefers, and return those seconds."""
    await wait_for_end(watch, Owned(caller.owner, batch_id), wait)
    return wait


@router.get(
    "/{batch_id}",
    summary="Get the status of a batch",
    response_model=BatchDocument,
    responses={
        200: {
            **documentation.body("Status", ("application/json", batch_documentation.FINISHED)),
            "headers": APPLIED_HEADER,
        },
        **_COMMON,
    },
)
def batch_status(
    batch_id: UUID, caller: CallerOf, readers: Readers, wait: Annotated[int | None, Depends(_wait_for_batch)]
) -> LinkedJSON:
    """Return the progress of a batch: its lines by state, and the faults of the first rejected lines.

    With `Prefer: wait=N` the service answers when the batch ends, or after N seconds.
    """
    with readers() as session:
        batch = find_batch(session, caller, batch_id)
        counts = batch_progress.counts(session, [batch_id])[batch_id]
        headers = applied(wait) if counts.status in ENDED else {"Retry-After": RETRY_SECONDS, **applied(wait)}
        return LinkedJSON(batch_document(session, batch, counts), headers=headers)


@router.get(
    "",
    summary="List batches",
    response_model=BatchPage,
    responses={
        200: documentation.body("A page of batches, newest first", ("application/json", batch_documentation.PAGE)),
        **documentation.problems(ProblemKind.INVALID_PARAMETER),
    },
)
def list_batches(
    settings: SettingsOf, caller: CallerOf, readers: Readers, query: Annotated[BatchListQuery, Query()]
) -> LinkedJSON:
    """Return one page of the batches, newest first; `next` is the address of the next page."""
    key = signing_key(settings)
    after = _place(key, query.cursor) if query.cursor else None
    with readers() as session:
        created = query.created_after, query.created_before
        found = batch_records.page(session, caller.owner, after, query.limit + 1, created)
        shown = found[: query.limit]
        counts = batch_progress.counts(session, [batch.id for batch in shown])
    following = None
    if len(found) > query.limit:
        place = paging.encode(key, (shown[-1].created_at, shown[-1].id))
        kept = query.model_dump(mode="json", exclude_none=True) | {"cursor": place}
        following = f"{router.prefix}?{urlencode(kept)}"
    documents = [batch_summary(batch, counts[batch.id]) for batch in shown]
    return LinkedJSON({"batches": documents, "next": following})


@router.post(
    "/{batch_id}/resubmit",
    summary="Resubmit the failed lines of a batch",
    status_code=202,
    response_model=BatchDocument,
    responses={
        202: batch_documentation.ACCEPTED_ANSWER,
        **documentation.problems(ProblemKind.NOT_FOUND, *KEY_PROBLEMS, *QUOTA_PROBLEMS),
    },
)
def resubmit_failed_lines(
    request: Request, batch_id: UUID, caller: CallerOf, key: KeyOf, writers: Writers, sender: SenderOf
) -> Response:
    """Run the failed lines again under their numbers; without failed lines, change nothing."""

    def make(session: Session) -> PostOutcome:
        batch = find_batch(session, caller, batch_id)
        size = intake.lines_a_chunk(request.app.state.settings, convert.read_analysis(batch.analysis))
        chunk_ids = batch_records.resubmit(session, caller, batch_id, size, request.app.state.quotas)
        return PostOutcome(accepted_batch(session, caller, batch_id), chunk_ids)

    made = run_once(writers, key, lambda: idempotency.fingerprint(batch_address(batch_id), "resubmit"), make)
    sender.send(made.job_ids, chunk=True)
    return made.answer


@router.delete(
    "/{batch_id}",
    summary="Cancel or remove a batch",
    response_model=None,
    responses={
        200: {
            **documentation.body("No line runs any more", ("application/json", batch_documentation.DISMISSED)),
            "model": BatchDocument,
        },
        202: {
            **documentation.body("Running lines will stop", ("application/json", batch_documentation.STOPPING)),
            "model": BatchDocument,
        },
        204: {"description": "The finished batch and its results are removed"},
        **_COMMON,
        **documentation.problems(ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_READY),
    },
)
def cancel_or_remove_batch(
    batch_id: UUID,
    caller: CallerOf,
    writers: Writers,
    if_ended: Annotated[
        bool, Query(description="Remove only: 409 if it has not ended, instead of cancelling it")
    ] = False,
) -> Response:
    """Cancel the lines of a batch that have not ended, or remove a finished batch.

    What has just ended is removed, too: `POST .../cancel` never removes, and `?if_ended=true` never cancels.
    """
    with writers.begin() as session:
        batch = find_batch(session, caller, batch_id)
        if if_ended and batch_progress.counts(session, [batch_id])[batch_id].status not in ENDED:
            raise ProblemError(ProblemKind.NOT_READY, "The batch has not ended, so it was not removed.")
        outcome = batch_records.cancel(session, caller, batch_id)
        if outcome is CancelOutcome.REMOVED:
            return Response(status_code=204)
        document = batch_document(session, batch, batch_progress.counts(session, [batch_id])[batch_id])
    if outcome is CancelOutcome.REQUESTED:
        return LinkedJSON(document, 202, headers={"Retry-After": RETRY_SECONDS})
    return LinkedJSON(document)


@router.post(
    "/{batch_id}/cancel",
    summary="Cancel a batch",
    response_model=BatchDocument,
    responses={
        200: {
            **documentation.body("No line runs any more", ("application/json", batch_documentation.DISMISSED)),
            "model": BatchDocument,
        },
        202: {
            **documentation.body("Running lines will stop", ("application/json", batch_documentation.STOPPING)),
            "model": BatchDocument,
        },
        **_COMMON,
        **documentation.problems(*KEY_PROBLEMS),
    },
)
def cancel_batch(batch_id: UUID, caller: CallerOf, key: KeyOf, writers: Writers) -> Response:
    """Cancel the lines of a batch that have not ended; what has ended keeps its results."""

    def make(session: Session) -> PostOutcome:
        batch = find_batch(session, caller, batch_id)
        outcome = batch_records.cancel(session, caller, batch_id, may_remove=False)
        document = batch_document(session, batch, batch_progress.counts(session, [batch_id])[batch_id])
        if outcome is CancelOutcome.REQUESTED:
            return PostOutcome(LinkedJSON(document, 202, headers={"Retry-After": RETRY_SECONDS}))
        return PostOutcome(LinkedJSON(document))

    return run_once(writers, key, lambda: idempotency.fingerprint(batch_address(batch_id), "cancel"), make).answer


def _place(key: bytes, cursor: str) -> paging.Place:
    try:
        return paging.decode(key, cursor)
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error
