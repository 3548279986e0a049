"""Pieces of a body -> an analysis and its lines, one after another, however large the body is."""

import codecs
import csv
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from app.batches.intake.csv_columns import Columns
from app.schemas.faults import BadInput, Fault, parse_json

_GZIP_WINDOW = 16 + zlib.MAX_WBITS
_INFLATED_A_STEP = 1 << 18
_KNOWN = frozenset({"lines", "analysis", "webhook_url"})


class BodyTooLarge(Exception):
    """Raised when a body, or one line of it, is larger than it may be; the text says what and how much."""


@dataclass(frozen=True, slots=True)
class Incoming:
    """An analysis document, and the documents of the lines; a `BadInput` stands for a line that cannot be read.

    With `anew` the lines are computed even if their results are stored already.
    """

    analysis: object
    lines: Iterator[object]
    webhook_url: object = None
    anew: bool = False


def gunzipped(pieces: Iterable[bytes], most_bytes: int) -> Iterator[bytes]:
    """Yield what compressed pieces stand for, in small parts, so that a bomb is noticed before it takes memory.

    Raises
    ------
    BodyTooLarge
        If more comes out than is allowed.
    BadInput
        If it is no gzip, or ends too early.
    """
    inflater, taken = zlib.decompressobj(_GZIP_WINDOW), 0
    try:
        for piece in pieces:
            rest = piece
            while rest:
                if inflater.eof:  # files that are compressed one by one and joined are one file by RFC 1952
                    inflater = zlib.decompressobj(_GZIP_WINDOW)
                part = inflater.decompress(rest, _INFLATED_A_STEP)
                rest = inflater.unconsumed_tail or inflater.unused_data
                taken += len(part)
                if taken > most_bytes:
                    raise BodyTooLarge(f"The body is larger than {most_bytes} bytes when it is decompressed.")
                yield part
    except zlib.error as error:
        raise BadInput([Fault("", "gzip_invalid", f"not valid gzip: {error}")]) from error
    if not inflater.eof:
        raise BadInput([Fault("", "gzip_invalid", "the gzip stream ends too early")])


def read_json(pieces: Iterable[bytes], most_bytes: int) -> Incoming:
    """Read `{"lines": [...], "analysis": {...}}` whole.

    Raises
    ------
    BodyTooLarge
        If it is larger than may be held in memory.
    BadInput
        If it is not such an object.
    """
    body = bytearray()
    for piece in pieces:
        body += piece
        if len(body) > most_bytes:
            raise BodyTooLarge(f"A JSON batch may have {most_bytes} bytes; send NDJSON or CSV, which may have more.")
    document = parse_json(bytes(body))
    if not isinstance(document, dict):
        raise BadInput([Fault("", "not_an_object", "must be an object with lines and analysis")])
    faults = [Fault(f"/{name[:200]}", "unknown_field", "unknown field") for name in document if name not in _KNOWN]
    if not isinstance(document.get("lines"), list):
        faults.append(Fault("/lines", "list_type", "must be a list of lines"))
    if faults:
        raise BadInput(faults)
    return Incoming(document.get("analysis", {}), iter(document["lines"]), document.get("webhook_url"))


def read_ndjson(pieces: Iterable[bytes], most_line_bytes: int) -> Incoming:
    """Read `{"analysis": {...}}` and then one line document a text line; empty text lines are passed over.

    Raises
    ------
    BodyTooLarge
        If a text line is too long, now or as the lines are taken.
    BadInput
        If the first object is another one.
    """
    texts = (text for text in _text_lines(pieces, most_line_bytes) if not text.isspace())
    first = parse_json(next(texts, b"{}"))
    if not isinstance(first, dict) or first.keys() - {"webhook_url"} != {"analysis"}:
        raise BadInput(
            [
                Fault(
                    "",
                    "missing",
                    'the first object must be {"analysis": {...}}, perhaps with a webhook_url',
                )
            ]
        )
    return Incoming(first["analysis"], map(_parsed, texts), first.get("webhook_url"))


def read_csv(pieces: Iterable[bytes], analysis: object, most_line_bytes: int) -> Incoming:
    """Read a table whose header holds dotted field names; cells that are empty are absent.

    Raises
    ------
    BodyTooLarge
        If a text line is too long, now or as the lines are taken.
    BadInput
        If the header is missing or at fault, or, as the lines are taken, the text is no UTF-8 or no CSV.
    """
    rows = _rows(csv.reader(_decoded(_text_lines(pieces, most_line_bytes)), strict=True))
    columns = Columns.of(next(rows, []))
    return Incoming(analysis, (columns.document(row) for row in rows))


def _parsed(text: bytes) -> Any:
    try:
        return parse_json(text)
    except BadInput as error:
        return error


def _text_lines(pieces: Iterable[bytes], most_bytes: int) -> Iterator[bytes]:
    """Yield text lines with their ends."""
    rest = b""
    for piece in pieces:
        *whole, rest = (rest + piece).split(b"\n")
        for text in whole:
            yield text + b"\n"
        if len(rest) > most_bytes:
            raise BodyTooLarge(f"A line is longer than {most_bytes} bytes.")
    if rest:
        yield rest


def _decoded(texts: Iterable[bytes]) -> Iterator[str]:
    decoder = codecs.getincrementaldecoder("utf-8-sig")()
    try:
        for text in texts:
            yield decoder.decode(text)
    except UnicodeDecodeError as error:
        raise BadInput([Fault("", "not_utf8", f"not valid UTF-8: {error.reason}")]) from error


def _rows(reader: Iterator[list[str]]) -> Iterator[list[str]]:
    try:
        yield from (row for row in reader if row)
    except csv.Error as error:
        raise BadInput([Fault("", "csv_invalid", f"not valid CSV: {error}")]) from error
