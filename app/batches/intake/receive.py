"""Check lines one by one and store them in blocks; the batch becomes visible when the last line is stored.

No transaction lasts longer than one block, so a slow sender blocks nobody.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any
from uuid import UUID

import orjson
from pydantic import TypeAdapter, ValidationError
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker
from uuid_utils.compat import uuid7

from app import convert, schemas
from app.batches import batch_records
from app.batches.batch_records import Chunk
from app.batches.intake.body_formats import Incoming
from app.exchange.defaults import checked_defaults, filled
from app.jobs.owner_quotas import Amount
from app.owned import records
from app.runtime.settings import Settings
from app.schemas.faults import MOST_FAULTS, BadInput, Fault, json_pointer
from app.schemas.fields import Reference
from app.security.caller import Caller
from app.sheets.columns import Computed, PlacedLine

_LINES_A_BLOCK = 500
_BYTES_A_BLOCK = 4_000_000  # of JSON, which takes some ten times as much as values
_FAULTS_A_LINE = 20
_FAULTS_SHOWN = 100
_REFERENCE: TypeAdapter[str] = TypeAdapter(Reference)


@dataclass(frozen=True, slots=True)
class Receipt:
    """An accepted batch, and its chunks to send to the workers."""

    batch_id: UUID
    chunk_ids: tuple[UUID, ...]


@dataclass(slots=True)
class _Draft:
    """A batch whose lines are still arriving."""

    batch_id: UUID
    analysis: schemas.Analysis
    chunk_lines: int
    atomic: bool
    own: convert.OwnRows
    defaults: Mapping[str, Any]
    chunks: list[Chunk] = field(default_factory=list)
    taken: int = 0
    rejected: int = 0
    faults: list[Fault] = field(default_factory=list)


def _nothing(*_: object) -> None:
    """Do nothing when the batch is accepted."""


def receive(
    sessions: sessionmaker[Session],
    settings: Settings,
    caller: Caller,
    incoming: Incoming,
    on_accept: Callable[[Session, UUID], object] = _nothing,
    *,
    atomic: bool,
) -> Receipt:
    """Check and store the lines of a batch; accept it if any line can run, or, if atomic, only if all can.

    `on_accept` runs in the transaction that accepts the batch; if it raises, the batch is removed.

    Raises
    ------
    BadInput
        If the analysis is wrong, if no line can run, or if a line of an atomic batch cannot; nothing is stored then.
    BodyTooLarge
        If reading the lines raises it; nothing is stored then.
    OverQuota
        If the owner may not have so much more; nothing is stored then.
    sqlalchemy.exc.SQLAlchemyError
        If the database fails; stored lines are removed now or by a later sweep.
    """
    analysis = convert.read_analysis(incoming.analysis)
    defaults = checked_defaults(incoming.defaults)
    with sessions.begin() as session:
        batch_id = batch_records.begin(session, caller, convert.kept_analysis(analysis))
        own = records.own_rows(session, caller.owner)
    draft = _Draft(batch_id, analysis, lines_a_chunk(settings, analysis), atomic, own, defaults)
    try:
        for block in _blocks(settings, draft, incoming.lines):
            with sessions.begin() as session:
                batch_records.add_items(session, block)
                incoming.allowed.require(session, caller.owner, Amount())  # the block is stored already
        _refuse_hopeless(draft)
        with sessions.begin() as session:
            batch_records.require_room(session, caller, draft.chunks, incoming.allowed)
            batch_records.accept(session, caller, batch_id, draft.chunks, draft.rejected, anew=incoming.anew)
            batch_records.note(session, batch_id, incoming.notes())
            on_accept(session, batch_id)
    except BaseException:
        with suppress(SQLAlchemyError), sessions.begin() as session:
            batch_records.discard(session, batch_id)
        raise
    return Receipt(batch_id, tuple(chunk.id for chunk in draft.chunks))


@dataclass(frozen=True, slots=True)
class Examined:
    """What would become of a batch: its lines, those rejected, seconds of the others on one core, faults, and notes."""

    total: int
    rejected: int
    seconds: float
    errors: list[dict[str, Any]]
    notes: list[str]


def examine(
    sessions: sessionmaker[Session], settings: Settings, caller: Caller, incoming: Incoming, *, atomic: bool
) -> Examined:
    """Check the lines of a batch as `receive` does, and store nothing.

    Raises
    ------
    BadInput, BodyTooLarge
        As in `receive`.
    """
    analysis, defaults = convert.read_analysis(incoming.analysis), checked_defaults(incoming.defaults)
    with sessions() as session:
        own = records.own_rows(session, caller.owner)
    draft = _Draft(uuid7(), analysis, lines_a_chunk(settings, analysis), atomic, own, defaults)
    errors: list[dict[str, Any]] = []
    for block in _blocks(settings, draft, incoming.lines):
        named = ((item["number"], item["reference"], fault) for item in block for fault in item["faults"] or ())
        found = ({"number": number, "reference": reference, **fault} for number, reference, fault in named)
        errors += islice(found, _FAULTS_SHOWN - len(errors))
    _refuse_hopeless(draft)
    seconds = (draft.taken - draft.rejected) * convert.seconds_a_line(analysis)
    return Examined(draft.taken, draft.rejected, seconds, errors, incoming.notes())


def lines_a_chunk(settings: Settings, analysis: schemas.Analysis) -> int:
    """Return the number of lines for one chunk: about the configured time of work, and whole stacks of the engine."""
    lines = max(1, min(settings.most_chunk_lines, round(settings.chunk_seconds / convert.seconds_a_line(analysis))))
    return lines - lines % convert.STACK if lines > convert.STACK else lines


def _blocks(settings: Settings, draft: _Draft, lines: Iterator[object]) -> Iterator[list[dict[str, Any]]]:
    """Yield the rows of the lines in blocks; stop early if an atomic batch has too many faults."""
    items_found = (_item(draft, document) for document in lines)  # one document is held, not those of a block
    while items := _block(items_found):
        if draft.taken > settings.max_batch_lines:
            raise BadInput([Fault("/lines", "too_long", f"a batch may have at most {settings.max_batch_lines} lines")])
        if draft.atomic and len(draft.faults) >= MOST_FAULTS:
            return
        yield items


def _block(items: Iterator[dict[str, Any]]) -> list[dict[str, Any]]:
    """Take the rows of a block: so many, or fewer where their documents are large."""
    taken, size = [], 0
    for item in islice(items, _LINES_A_BLOCK):
        taken.append(item)
        size += len(orjson.dumps((item["document"], item["known"], item["geometry"])))
        if size > _BYTES_A_BLOCK:
            break
    return taken


def _item(draft: _Draft, sent: object) -> dict[str, Any]:
    draft.taken += 1
    placed = sent if isinstance(sent, PlacedLine) else PlacedLine("", sent)
    reference, faults = None, []
    line, known = None, None
    computed: list[Computed] = []
    try:
        reference, fields = _split(placed.document)
        if placed.faults:
            raise BadInput(placed.faults)
        if isinstance(fields, dict):
            fields, computed = filled(fields, placed.computed, draft.defaults)
        explicit, known = convert.explicit_line(fields, draft.own)
        line = convert.read_line(explicit, draft.analysis)
    except BadInput as error:
        faults = [_with_source(fault, placed, computed) for fault in error.faults[:_FAULTS_A_LINE]]
    if line is None:
        draft.rejected += 1
        room = max(0, MOST_FAULTS - len(draft.faults))
        draft.faults += [_placed(draft.taken, placed.place, fault) for fault in faults[:room]]
    return {
        "batch_id": draft.batch_id,
        "number": draft.taken,
        "chunk_id": _chunk_id(draft) if line is not None else None,
        "reference": reference,
        "asset_id": line.asset_id if line is not None else None,
        "document": line.model_dump(mode="json", by_alias=True) if line is not None else None,
        "known": known if line is not None else None,
        "geometry": placed.geometry,
        "computed": [_as_row(value) for value in computed] or None,
        "faults": None if line is not None else [_stored(placed, fault) for fault in faults],
    }


def _with_source(fault: Fault, placed: PlacedLine, computed: Iterable[Computed]) -> Fault:
    """Return a fault of a value that the body does not name like the line, with its name or origin there."""
    sources = {**placed.sources, **{json_pointer(value.path): value.source for value in computed}}
    source = sources.get(fault.pointer)
    return fault if source is None else Fault(fault.pointer, fault.code, f"{fault.detail} ({source})")


def _stored(placed: PlacedLine, fault: Fault) -> dict[str, Any]:
    place = {"row": placed.row, "place": placed.place or None}
    return {**place, "pointer": fault.pointer, "code": fault.code, "detail": fault.detail}


def _as_row(value: Computed) -> dict[str, Any]:
    """Return a computed value as a row of the table `assumptions`."""
    row = {"path": value.name, "value": value.value, "unit": value.unit, "origin": "computed", "source": value.source}
    return {**row, "lowest": None, "highest": None}


def _split(document: object) -> tuple[str | None, object]:
    """Separate the caller's reference from the fields of the line.

    Raises
    ------
    BadInput
        If the line could not be read, or the reference is not a valid label.
    """
    if isinstance(document, BadInput):
        raise document
    if not isinstance(document, dict) or document.get("reference") is None:
        fields = {k: v for k, v in document.items() if k != "reference"} if isinstance(document, dict) else document
        return None, fields
    try:
        reference = _REFERENCE.validate_python(document["reference"], strict=True)
    except ValidationError as error:
        detail = "must be a text of 1 to 200 characters without control characters"
        raise BadInput([Fault("/reference", "label", detail)]) from error
    return reference, {key: value for key, value in document.items() if key != "reference"}


def _chunk_id(draft: _Draft) -> UUID:
    """Return the chunk for the next line; begin a new one if the last is full."""
    if not draft.chunks or draft.chunks[-1].lines == draft.chunk_lines:
        line_bytes = convert.bytes_a_line(draft.analysis)
        draft.chunks.append(Chunk(uuid7(), len(draft.chunks) + 1, 0, line_bytes))
    last = draft.chunks[-1]
    draft.chunks[-1] = replace(last, lines=last.lines + 1)
    return last.id


def _placed(number: int, place: str, fault: Fault) -> Fault:
    """Return a fault of the whole batch; a row of a spreadsheet is named as the spreadsheet shows it."""
    return Fault(f"/lines/{number - 1}{fault.pointer}", fault.code, f"{place or f'line {number}'}: {fault.detail}")


def _refuse_hopeless(draft: _Draft) -> None:
    if not draft.taken:
        raise BadInput([Fault("/lines", "too_short", "a batch needs at least one line")])
    if not draft.chunks or (draft.atomic and draft.rejected):
        raise BadInput(draft.faults)
