"""Batches: their list, a file to upload, and the lines of one batch with what was found."""

import json
from typing import Annotated
from urllib.parse import urlencode
from uuid import UUID

from fastapi import APIRouter, Depends, Header, Query, Request, Response

from app.batches import batch_records, line_results
from app.http import paging
from app.http.problems import ProblemError, ProblemKind, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.jobs import batch_progress
from app.jobs.job_records import CancelOutcome
from app.pages.batches.histograms import histogram
from app.pages.batches.maps import batch_map
from app.pages.batches.overviews import ANSWERS, Wanted, overview
from app.pages.forms import Fields
from app.pages.frame import address, check_form, moved, page, units_of
from app.pages.wording import words
from app.routes.batch_intake import PostedBatch, submit_batch
from app.routes.batch_results import MEDIA_TYPES, BatchFormat, result_pieces
from app.routes.batch_status import batch_document, batch_summary, find_batch, require_results
from app.routes.dependencies import CallerOf, Readers, SenderOf, Writers
from app.routes.streaming import streamed
from app.runtime.signing import signing_key
from app.security.caller import Scope
from app.tables import ENDED

router = APIRouter(include_in_schema=False, prefix="/pages/batches", route_class=KnownParametersRoute)

FILES = f"{router.prefix}/file"
_ON_PAGE = 40
_MOST_LINES = 200  # the downloads have all of them


async def _marked(request: Request, mark: Annotated[str, Header(alias="X-Form-Mark")] = "") -> None:
    """Check that a page of this service sends a file; a header cannot come from the form of another site."""
    check_form(request, {"mark": mark})


def _wanted(
    gallops: Annotated[str, Query(max_length=20)] = "",
    name: Annotated[str, Query(max_length=200)] = "",
    tag: Annotated[str, Query(max_length=400)] = "",
) -> Wanted:
    """Return which lines the address of a page asks for; the filters stay in it, so that it can be kept and sent."""
    return Wanted(gallops if gallops in ANSWERS else "", name.strip(), tag.strip())


WantedLines = Annotated[Wanted, Depends(_wanted)]


@router.get("")
def list_of_batches(
    request: Request, caller: CallerOf, readers: Readers, cursor: Annotated[str, Query(max_length=200)] = ""
) -> Response:
    """Return the owner's batches, newest first, with what uploads another.

    Raises
    ------
    ProblemError
        400 if the cursor is not one of this service.
    """
    key = signing_key(request.app.state.settings)
    try:
        after = paging.decode(key, cursor) if cursor else None
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error
    with readers() as session:
        found = batch_records.page(session, caller.owner, after, _ON_PAGE + 1)
        counts = batch_progress.counts(session, [batch.id for batch in found])
    older = None
    if len(found) > _ON_PAGE:
        last = found[_ON_PAGE - 1]
        older = f"/pages/batches?{urlencode({'cursor': paging.encode(key, (last.created_at, last.id))})}"
    batches = [batch_summary(batch, counts[batch.id]) for batch in found[:_ON_PAGE]]
    return page(
        request, "batches.html", batches=batches, older=older, script_words=json.dumps(vars(words().batch.script))
    )


@router.post("/file", dependencies=[Depends(_marked)])
async def take_in(posted: PostedBatch, caller: CallerOf, writers: Writers, sender: SenderOf) -> Response:
    """Check or accept the lines of a file, as `POST /v1/batches` does."""
    return await submit_batch(posted, caller, None, writers, sender)


@router.get("/{batch_id}")
def batch_page(
    request: Request,
    batch_id: UUID,
    caller: CallerOf,
    readers: Readers,
    wanted: WantedLines,
) -> Response:
    """Return a batch: its counts, and its lines as far as they are computed."""
    units = units_of(request)
    with readers() as session:
        batch = find_batch(session, caller, batch_id)
        counts = batch_progress.counts(session, [batch_id])[batch_id]
        document = batch_document(session, batch, counts)
        seen = overview(line_results.tagged_features(session, batch_id), wanted)
    said = words().batch
    place = address(request)
    return page(
        request,
        "batch.html",
        batch=document,
        ended=counts.status in ENDED,
        wanted=wanted,
        answers=seen.answers,
        tags=seen.tags,
        lines=seen.lines[:_MOST_LINES],
        count=len(seen.lines),
        spreads=[
            histogram(said.amplitude, seen.values("vertical_peak_to_peak_m"), "m", units),
            histogram(said.onset, seen.values("onset_m_per_s"), "m/s", units),
        ],
        map=batch_map(seen.features, units, lambda number: place(f"/pages/batches/{batch_id}/lines/{number}")),
    )


@router.get("/{batch_id}/results")
def wanted_results(
    batch_id: UUID,
    caller: CallerOf,
    readers: Readers,
    wanted: WantedLines,
    form: Annotated[BatchFormat, Query(alias="format")],
) -> Response:
    """Return the results of the wanted lines as a file, as `GET /v1/batches/{id}/results` does of all lines."""
    require_results(readers, caller, batch_id, partial=False)
    with readers() as session:
        numbers = overview(line_results.tagged_features(session, batch_id), wanted).numbers
    return streamed(
        readers, lambda session: result_pieces(session, batch_id, (form, "plain"), None, numbers), MEDIA_TYPES[form], {}
    )


@router.get("/{batch_id}/progress")
def progress(request: Request, batch_id: UUID, caller: CallerOf, readers: Readers) -> Response:
    """Return the part of the page that counts the lines; when the batch has ended, the whole page is to be read."""
    with readers() as session:
        batch = find_batch(session, caller, batch_id)
        counts = batch_progress.counts(session, [batch_id])[batch_id]
    ended = counts.status in ENDED
    headers = {"HX-Refresh": "true"} if ended else {}
    summary = batch_summary(batch, counts)
    return page(request, "parts/batch_progress.html", headers=headers, batch=summary, ended=ended)


@router.get("/{batch_id}/lines/{number}")
def line_of_batch(request: Request, batch_id: UUID, number: int, caller: CallerOf, readers: Readers) -> Response:
    """Lead to the result of a line.

    Raises
    ------
    ProblemError
        404 if there is no such line, or it was rejected.
    """
    with readers() as session:
        find_batch(session, caller, batch_id)
        chunk = batch_records.chunk_of_line(session, batch_id, number)
    if chunk is None:
        raise ProblemError(ProblemKind.NOT_FOUND, words().batch.no_line)
    return moved(request, f"/pages/jobs/{chunk}?point={number}")


@router.post("/{batch_id}/cancel")
def cancel_batch(request: Request, batch_id: UUID, caller: CallerOf, writers: Writers, fields: Fields) -> Response:
    """Cancel the lines that have not ended, or remove a batch that has where the form says so.

    Raises
    ------
    ProblemError
        403 if the key may not cancel.
    """
    if Scope.CANCEL not in caller.scopes:
        raise ProblemError(ProblemKind.FORBIDDEN, words().result.may_not_cancel)
    with writers.begin() as session:
        find_batch(session, caller, batch_id)
        outcome = batch_records.cancel(session, caller, batch_id, may_remove=fields.get("remove") == "yes")
    return moved(request, "/pages/batches" if outcome is CancelOutcome.REMOVED else f"/pages/batches/{batch_id}")
