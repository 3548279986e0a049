"""Convert the pieces of a body to an analysis and its lines, one after another, however large the body is."""

import tempfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from typing import IO, Any

from app.convert.known.wrapping import without_wrapper
from app.exchange.cim import read_segments
from app.exchange.feature_texts import cut_features
from app.exchange.features import read_features
from app.jobs import owner_quotas
from app.jobs.owner_quotas import Quotas
from app.schemas.faults import BadInput, BodyTooLarge, Fault, parse_json
from app.sheets.columns import Columns
from app.sheets.delimited import read_delimited
from app.sheets.encodings import as_utf8

_GZIP_WINDOW = 16 + zlib.MAX_WBITS
_INFLATED_A_STEP = 1 << 18
_IN_MEMORY_BYTES = 4_000_000
_LENGTH_BYTES = 8
_WRAPPER = '{"lines": [<the lines>], "analysis": {...}}, where analysis may be absent'
_KNOWN = frozenset({"lines", "analysis", "defaults", "webhook_url"})


@dataclass(frozen=True, slots=True)
class Incoming:
    """An analysis document and the documents of the lines; a `BadInput` stands for an unreadable line.

    `defaults` is a document of what the lines leave open. With `anew`, workers compute the lines even if their results
    are stored. `notes` tells how the body was read; its sentences are complete when the last line was taken. `allowed`
    are the quotas of its owner. `close` it when no more lines are taken.
    """

    analysis: object
    lines: Iterator[object]
    webhook_url: object = None
    anew: bool = False
    notes: Callable[[], list[str]] = list
    file: IO[bytes] | None = None
    defaults: object = None
    allowed: Quotas = owner_quotas.NONE

    def close(self) -> None:
        """Close the file from which the lines come, if they come from one."""
        if self.file is not None:
            self.file.close()


def gunzipped(pieces: Iterable[bytes], most_bytes: int) -> Iterator[bytes]:
    """Yield decompressed pieces in small parts, so that a decompression bomb is noticed before it takes memory.

    Raises
    ------
    BodyTooLarge
        If the decompressed body exceeds the limit.
    BadInput
        If the body is not gzip, or ends too early.
    """
    inflater, taken = zlib.decompressobj(_GZIP_WINDOW), 0
    try:
        for piece in pieces:
            remaining = piece
            while remaining:
                if inflater.eof:  # RFC 1952 allows several compressed members in one file
                    inflater = zlib.decompressobj(_GZIP_WINDOW)
                part = inflater.decompress(remaining, _INFLATED_A_STEP)
                remaining = inflater.unconsumed_tail or inflater.unused_data
                taken += len(part)
                if taken > most_bytes:
                    raise BodyTooLarge(f"The decompressed body is larger than {most_bytes} bytes.")
                yield part
    except zlib.error as error:
        raise BadInput([Fault("", "gzip_invalid", f"not valid gzip: {error}")]) from error
    if not inflater.eof:
        raise BadInput([Fault("", "gzip_invalid", "the gzip stream ends too early")])


def read_json(pieces: Iterable[bytes], most_bytes: int) -> Incoming:
    """Read a body `{"lines": [...], "analysis": {...}}` whose members may have any order.

    Each line is cut out as it comes in, and kept in a file until the members are known, which may stand behind it:
    parsed in one piece, the body would hold up the event loop.

    Raises
    ------
    BodyTooLarge
        If the body is larger than `most_bytes`.
    BadInput
        If the body is not such an object.
    """
    with ExitStack() as until_read:
        file = until_read.enter_context(tempfile.SpooledTemporaryFile(_IN_MEMORY_BYTES))
        cut = cut_features(_of_object(_bounded(as_utf8(pieces), most_bytes)), most_bytes, "lines")
        for text in cut.texts:
            file.write(len(text).to_bytes(_LENGTH_BYTES, "big") + text)
        document = {name: parse_json(text) for name, text in cut.members.items()}
        _check_members(document)
        lines = map(_parsed, _texts_of(file))
        until_read.pop_all()  # the lines are read from the file
    analysis, url = document.get("analysis", {}), document.get("webhook_url")
    return Incoming(analysis, lines, url, file=file, defaults=document.get("defaults"))


def _bounded(pieces: Iterable[bytes], most_bytes: int) -> Iterator[bytes]:
    taken = 0
    for piece in pieces:
        taken += len(piece)
        if taken > most_bytes:
            raise BodyTooLarge(f"A JSON batch may have at most {most_bytes} bytes; send a larger one as NDJSON or CSV.")
        yield piece


def _of_object(pieces: Iterator[bytes]) -> Iterator[bytes]:
    """Yield the pieces of a text that is an object, or name the fault of another one, which is read whole for that."""
    first = next((piece for piece in map(bytes.lstrip, pieces) if piece), b"")
    if not first.startswith(b"{"):
        bare = without_wrapper(parse_json(first + b"".join(pieces)), _WRAPPER)
        raise BadInput([bare or Fault("", "not_an_object", "must be an object with lines and analysis")])
    yield first
    yield from pieces


def _texts_of(file: IO[bytes]) -> Iterator[bytes]:
    """Yield the texts of a file, each of which stands behind its length."""
    file.seek(0)
    while length := file.read(_LENGTH_BYTES):
        yield file.read(int.from_bytes(length, "big"))


def _check_members(document: Mapping[str, Any]) -> None:
    """Refuse unknown members of a JSON batch and one without a list of lines."""
    bare = without_wrapper(document, _WRAPPER)
    if bare is not None:
        raise BadInput([bare])
    faults = [Fault(f"/{name[:200]}", "unknown_field", "unknown field") for name in document if name not in _KNOWN]
    if not isinstance(document.get("lines"), list):
        faults.append(Fault("/lines", "list_type", "must be a list of lines"))
    if faults:
        raise BadInput(faults)


def read_ndjson(pieces: Iterable[bytes], most_line_bytes: int) -> Incoming:
    """Read `{"analysis": {...}}` and then one line document on each line of text; skip blank lines.

    Raises
    ------
    BodyTooLarge
        If a line of text is too long; raised now or while the lines are read.
    BadInput
        If the first object is not of this form.
    """
    texts = (text for text in _text_lines(as_utf8(pieces), most_line_bytes) if not text.isspace())
    first = parse_json(next(texts, b"{}"))
    if not isinstance(first, dict) or first.keys() - {"webhook_url", "defaults"} != {"analysis"}:
        rule = 'the first object must be {"analysis": {...}}, optionally with defaults and a webhook_url'
        raise BadInput([Fault("", "missing", rule)])
    return Incoming(first["analysis"], map(_parsed, texts), first.get("webhook_url"), defaults=first.get("defaults"))


def read_csv(pieces: Iterable[bytes], said: Mapping[str, object], most_line_bytes: int) -> Incoming:
    """Read a table whose header holds dotted field names; an empty cell means an absent field.

    `said` holds the analysis and the defaults. Cells are apart by commas, semicolons or tabs, in UTF-8, UTF-16 or
    Windows-1252 (`app.sheets.delimited`).

    Raises
    ------
    BodyTooLarge
        If a line of text is too long; raised now or while the lines are read.
    BadInput
        If the header is missing or wrong; while the lines are read, if a text in UTF-16 breaks its rules.
    """
    table = read_delimited(pieces, partial(_text_lines, most_bytes=most_line_bytes))
    lines = map(Columns.of(table.header).line, table.rows)
    return Incoming(said.get("analysis", {}), lines, notes=table.notes.sentences, defaults=said.get("defaults"))


def read_xlsx(pieces: Iterable[bytes], said: Mapping[str, object], most_bytes: int, most_other_bytes: int) -> Incoming:
    """Read the first sheet of a workbook like a CSV; `app.sheets.workbooks` says what the bounds are for.

    Raises
    ------
    BodyTooLarge
        If the body is larger than `most_bytes`.
    BadInput
        If it is no workbook, or its header is wrong; also while the lines are read.
    """
    from app.sheets.workbooks import read_workbook  # noqa: PLC0415 - openpyxl loads slowly, and only workbooks need it

    with ExitStack() as until_read:
        file = until_read.enter_context(tempfile.SpooledTemporaryFile(_IN_MEMORY_BYTES))
        for piece in pieces:
            if file.tell() + len(piece) > most_bytes:
                raise BodyTooLarge(f"The workbook is larger than {most_bytes} bytes.")
            file.write(piece)
        file.seek(0)
        table = read_workbook(file, most_bytes, most_other_bytes)
        lines = map(Columns.of(table.header).line, table.rows)
        until_read.pop_all()  # the lines are read from the file
    analysis, defaults = said.get("analysis", {}), said.get("defaults")
    return Incoming(analysis, lines, notes=table.notes.sentences, file=file, defaults=defaults)


def read_geojson(pieces: Iterable[bytes], said: Mapping[str, object], most_line_bytes: int) -> Incoming:
    """Read a FeatureCollection whose features are lines (`app.exchange.features`).

    `said` holds the analysis and the defaults that the address names; else they stand before the features.

    Raises
    ------
    BodyTooLarge
        If a feature is too long; raised now or while the lines are read.
    BadInput
        If it is no such collection, or a part is given twice; also while the lines are read.
    """
    found = read_features(as_utf8(pieces), most_line_bytes)
    twice = [name for name in said if name in found.members]
    if twice:
        detail = "is given twice: in the body and in the address"
        raise BadInput([Fault(f"/{name}", "given_twice", detail) for name in twice])
    parts = {**found.members, **said}
    return Incoming(
        parts.get("analysis", {}),
        found.lines,
        parts.get("webhook_url"),
        notes=found.notes.sentences,
        defaults=parts.get("defaults"),
    )


def read_rdf_xml(pieces: Iterable[bytes], said: Mapping[str, object], most_kept: int, most_line_bytes: int) -> Incoming:
    """Read the line segments of IEC CIM (`app.exchange.cim`), of which up to `most_kept` characters are held in memory.

    `said` holds the analysis and the defaults.

    Raises
    ------
    BodyTooLarge
        If more would be held, or a tag is too long.
    BadInput
        If it is no CIM in RDF/XML, or has no line segment.
    """
    found = read_segments(pieces, said.get("defaults"), most_kept, most_line_bytes)
    notes, defaults = found.notes.sentences, said.get("defaults")
    return Incoming(said.get("analysis", {}), found.lines, notes=notes, defaults=defaults)


def _parsed(text: bytes) -> Any:
    try:
        return parse_json(text)
    except BadInput as error:
        return error


def _text_lines(pieces: Iterable[bytes], most_bytes: int) -> Iterator[bytes]:
    """Yield lines of text with their line ends."""
    remaining = b""
    for piece in pieces:
        *complete, remaining = (remaining + piece).split(b"\n")
        for text in complete:
            yield text + b"\n"
        if len(remaining) > most_bytes:
            raise BodyTooLarge(f"A line is longer than {most_bytes} bytes.")
    if remaining:
        yield remaining
