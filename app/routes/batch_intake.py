"""Submit batches: bodies of any size, read as they arrive."""

import hashlib
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, TypeVar
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field
from sqlalchemy.orm import Session, sessionmaker
from starlette.requests import ClientDisconnect

from app.answers.batches import BatchCheck, BatchDocument
from app.batches import intake
from app.batches.intake import BodyTooLarge, Incoming, Places
from app.export.formats import GEOJSON, RDF_XML, XLSX
from app.http.problems import ProblemError, ProblemKind, invalid_document, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.interactive import Busy
from app.jobs import idempotency, webhooks
from app.jobs.idempotency import Key
from app.jobs.owner_quotas import Amount, OverQuota, Quotas
from app.jobs.webhooks import Subscription
from app.routes import batch_documentation, documentation
from app.routes.batch_status import BATCHES, accepted_batch
from app.routes.dependencies import CallerOf, MayReuse, Readers, SenderOf, Writers, vet_webhook
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_holding_key, stored_answer
from app.routes.own_quotas import QUOTA_PROBLEMS
from app.routes.own_quotas import problem as over_quota
from app.runtime.settings import Settings
from app.schemas.faults import BadInput, Fault, parse_json
from app.security.caller import Caller

if TYPE_CHECKING:
    from hashlib import _Hash

Answer = TypeVar("Answer")

router = APIRouter(prefix=BATCHES, tags=["batches"], route_class=KnownParametersRoute)

ADDRESSES = (BATCHES, f"{BATCHES}/estimate")
"""Where the bodies of batches come in."""

_RETRY_SECONDS = "5"
_LEAST = Amount(waiting=1)  # that the smallest batch needs
# Bodies that have no room for an analysis and for defaults, or need not have it.
_ADDRESSED = ("text/csv", XLSX, GEOJSON, RDF_XML)
_BODY_PROBLEMS = (
    ProblemKind.TOO_SLOW,
    ProblemKind.TOO_LARGE,
    ProblemKind.UNSUPPORTED_MEDIA_TYPE,
    ProblemKind.INVALID_DOCUMENT,
    ProblemKind.BUSY,
)
_TYPES = ("application/json", "application/x-ndjson", *_ADDRESSED)


class IntakeQuery(BaseModel):
    """How to receive a batch."""

    atomic: bool = Field(default=False, description="Reject the whole batch if any line is wrong")
    analysis: str | None = Field(
        default=None, max_length=20_000, description="The analysis of a sheet, of features or of CIM, as JSON"
    )
    defaults: str | None = Field(
        default=None,
        max_length=20_000,
        description="What the lines of a sheet, of features or of CIM leave open, as a JSON object of their fields",
    )
    validate_only: bool = Field(default=False, description="Check the lines, and store nothing")
    webhook_url: str | None = Field(
        default=None,
        max_length=2000,
        description="https address to which the service posts a signed message when the batch ends; an address in the "
        "body takes precedence",
    )


@dataclass(frozen=True, slots=True)
class _Posted:
    """A body that is still arriving, how to receive it, and a running digest of the body."""

    request: Request
    settings: Settings
    how: IntakeQuery
    may_reuse: bool
    places: Places
    allowed: Quotas
    digest: "_Hash" = field(default_factory=hashlib.sha256)


async def _posted(request: Request, how: Annotated[IntakeQuery, Query()], may_reuse: MayReuse) -> _Posted:
    state = request.app.state
    return _Posted(request, state.settings, how, may_reuse, state.places, state.quotas)


PostedBatch = Annotated[_Posted, Depends(_posted)]


@router.post(
    "",
    summary="Submit a batch",
    status_code=202,
    response_model=BatchDocument,
    responses={
        202: batch_documentation.ACCEPTED_ANSWER,
        **documentation.problems(*KEY_PROBLEMS, *QUOTA_PROBLEMS, *_BODY_PROBLEMS),
    },
    openapi_extra=batch_documentation.request_body(),
)
async def submit_batch(
    posted: PostedBatch,
    caller: CallerOf,
    key: KeyOf,
    writers: Writers,
    sender: SenderOf,
) -> Response:
    """Accept many lines under one analysis. Wrong lines are stored with their faults, and the other lines run.

    Each line may have a `reference` beside its own fields; the results repeat it, as they repeat `asset_id`. If the
    service has stored results of a line's input, the line gets those, unless `Cache-Control: no-cache` requests a new
    computation. `?validate_only=true` answers as `POST /v1/batches/estimate` does, and stores nothing.
    """
    made = await _in_turn(posted, caller, partial(_receive, writers, caller, key, posted))
    if made.job_ids:
        await to_thread.run_sync(partial(sender.send, made.job_ids, chunk=True))
    return made.answer


@router.post(
    "/estimate",
    summary="Check a batch and estimate its cost",
    response_model=BatchCheck,
    responses={
        200: documentation.body("What would become of it", ("application/json", batch_documentation.CHECKED)),
        **documentation.problems(*_BODY_PROBLEMS),
    },
    openapi_extra=batch_documentation.request_body(),
)
async def estimate_batch(posted: PostedBatch, caller: CallerOf, readers: Readers) -> Response:
    """Check every line of what would be a batch, and estimate the computing time. Nothing is stored."""
    return await _in_turn(posted, caller, partial(_checked, readers, caller, posted))


async def _in_turn(posted: _Posted, caller: Caller, work: Callable[[], Answer]) -> Answer:
    try:
        return await posted.places.run(caller.owner, work)
    except Busy as error:
        detail = "Too many batches are coming in; send this one when others have arrived."
        headers = {"Retry-After": _RETRY_SECONDS, "Connection": "close"}
        raise ProblemError(ProblemKind.BUSY, detail, headers=headers) from error


def _receive(writers: sessionmaker[Session], caller: Caller, key: Key | None, posted: _Posted) -> PostOutcome:
    take_in, lease_seconds = partial(_take_in, writers, caller, key, posted), posted.settings.key_lease_seconds
    if posted.how.validate_only:
        return PostOutcome(_checked(writers, caller, posted))
    with _refusals():
        return run_holding_key(writers, key, partial(_fingerprint, posted), take_in, lease_seconds)


@contextmanager
def _refusals() -> Iterator[None]:
    """Answer what a body can be refused for with its problem."""
    try:
        yield
    except BodyTooLarge as error:
        raise ProblemError(ProblemKind.TOO_LARGE, str(error), headers={"Connection": "close"}) from error
    except BadInput as error:
        raise invalid_document(error.faults) from error
    except OverQuota as error:
        raise over_quota(error, {"Connection": "close"}) from error


def _take_in(writers: sessionmaker[Session], caller: Caller, key: Key | None, posted: _Posted) -> PostOutcome:
    answers: list[Response] = []

    def on_accept(session: Session, batch_id: UUID) -> None:
        if webhook_url is not None:
            webhooks.register(session, caller.owner, Subscription(webhook_url), batch_id=batch_id)
        answers.append(accepted_batch(session, caller, batch_id))
        if key is not None:
            idempotency.finish(session, key, _digest_so_far(posted), stored_answer(answers[0]))

    with writers.begin() as session:  # before the body is read
        posted.allowed.require(session, caller.owner, _LEAST)
    with closing(replace(_incoming(posted), anew=not posted.may_reuse, allowed=posted.allowed)) as incoming:
        webhook_url = _webhook_url(posted, incoming)
        receipt = intake.receive(writers, posted.settings, caller, incoming, on_accept, atomic=posted.how.atomic)
    return PostOutcome(answers[0], receipt.chunk_ids)


def _checked(sessions: sessionmaker[Session], caller: Caller, posted: _Posted) -> JSONResponse:
    with _refusals(), closing(_incoming(posted)) as incoming:
        _webhook_url(posted, incoming)
        found = intake.examine(sessions, posted.settings, caller, incoming, atomic=posted.how.atomic)
    return JSONResponse(asdict(found))


def _webhook_url(posted: _Posted, incoming: Incoming) -> str | None:
    url = posted.how.webhook_url if incoming.webhook_url is None else incoming.webhook_url
    if url is None:
        return None
    if not isinstance(url, str):
        raise BadInput([Fault("/webhook_url", "string_type", "must be a text with an address")])
    posted.places.awaited(vet_webhook, posted.settings, url)
    return url


def _fingerprint(posted: _Posted) -> str:
    """Read the body to its end and return its fingerprint."""
    for _ in _inflated(posted):
        pass
    return _digest_so_far(posted)


def _digest_so_far(posted: _Posted) -> str:
    """Return the fingerprint of a body that was read to its end, taken before compression."""
    return idempotency.fingerprint(
        BATCHES, _media_type(posted), posted.how.model_dump_json(), posted.digest.hexdigest()
    )


def _media_type(posted: _Posted) -> str:
    return posted.request.headers.get("content-type", "").partition(";")[0].strip().lower()


def _incoming(posted: _Posted) -> Incoming:
    media_type, settings = _media_type(posted), posted.settings
    if media_type not in _TYPES:
        detail = f"The body is {media_type[:100]!r}, not one of {', '.join(_TYPES)}."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, detail, headers={"Accept-Post": ", ".join(_TYPES)})
    said = _said(posted, media_type)
    pieces = _inflated(posted)
    if media_type == "application/json":
        return intake.read_json(pieces, settings.max_body_bytes)
    if media_type == "application/x-ndjson":
        return intake.read_ndjson(pieces, settings.max_batch_line_bytes)
    if media_type == XLSX:
        return intake.read_xlsx(pieces, said, settings.max_batch_bytes, settings.max_body_bytes)
    if media_type == GEOJSON:
        return intake.read_geojson(pieces, said, settings.max_batch_line_bytes)
    if media_type == RDF_XML:
        return intake.read_rdf_xml(pieces, said, settings.max_body_bytes, settings.max_batch_line_bytes)
    return intake.read_csv(pieces, said, settings.max_batch_line_bytes)


def _said(posted: _Posted, media_type: str) -> dict[str, Any]:
    """Return the analysis and the defaults in the address, which only some bodies leave there."""
    texts = {"analysis": posted.how.analysis, "defaults": posted.how.defaults}
    given = {name: text for name, text in texts.items() if text is not None}
    if given and media_type not in _ADDRESSED:
        raise query_fault(next(iter(given)), f"is not for a body of {media_type}; put it into the body")
    return {name: _parsed(name, text) for name, text in given.items()}


def _parsed(name: str, text: str) -> Any:
    try:
        return parse_json(text.encode())
    except BadInput as error:
        raise query_fault(name, error.faults[0].detail) from error


def _inflated(posted: _Posted) -> Iterator[bytes]:
    encoding = posted.request.headers.get("content-encoding", "identity").strip().lower()
    pieces = _pieces(posted)
    if encoding == "gzip":
        return _digested(posted, intake.gunzipped(pieces, posted.settings.max_batch_bytes))
    if encoding != "identity":
        detail = f"The content encoding {encoding[:100]!r} is not supported; gzip is."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, detail, headers={"Accept-Encoding": "gzip"})
    return _digested(posted, pieces)


def _digested(posted: _Posted, pieces: Iterator[bytes]) -> Iterator[bytes]:
    for piece in pieces:
        posted.digest.update(piece)
        yield piece


def _pieces(posted: _Posted) -> Iterator[bytes]:
    """Yield the body in this thread as the event loop receives it; request a piece only when the last one is used."""
    stream = posted.request.stream()

    async def following() -> bytes | None:
        return await anext(stream, None)

    try:
        while (piece := posted.places.awaited(following)) is not None:
            yield piece
    except ClientDisconnect as error:
        raise ProblemError(ProblemKind.INVALID_DOCUMENT, "The body ended early.") from error  # seen in the log only
