"""Results as text, written as they are read: JSON documents of the contract, and CSV that is safe in a spreadsheet."""

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, AnyStr, Literal, TypeVar

import orjson

Row = Mapping[str, Any]
Format = Literal["json", "csv", "parquet"]
Name = TypeVar("Name", bound=str)
PARQUET = "application/vnd.apache.parquet"
MEDIA_TYPES: Mapping[Format, str] = {
    "json": "application/json",
    "csv": "text/csv; charset=utf-8",
    "parquet": PARQUET,
}

# The wide forms count, too: spreadsheets of East Asian settings read them as the narrow ones.
_FORMULA_STARTS = (*"=+-@\t\r\n", *"\uff1d\uff0b\uff0d\uff20")
_BLOCK = 131_072  # bytes or characters: smaller blocks cost more in hand-overs, larger ones more in copies


def preferred_format(accept: str) -> Format | None:
    """Choose the format that an Accept header likes best, JSON in doubt; None if it takes neither."""
    return preferred(accept, {"json": "application/json", "csv": "text/csv", "parquet": PARQUET})


def preferred(accept: str, media_types: Mapping[Name, str]) -> Name | None:
    """Choose the format whose media type an Accept header likes best, the first in doubt; None if it takes none."""
    weights = {name: _weight(accept, media_type) for name, media_type in media_types.items()}
    best = max(weights, key=lambda name: weights[name])
    return best if weights[best] > 0.0 else None


def in_blocks(pieces: Iterable[AnyStr]) -> Iterator[AnyStr]:
    """Join small pieces of text or bytes into blocks, since each that is sent costs a hand-over between threads."""
    block: list[AnyStr] = []
    size = 0
    for piece in pieces:
        block.append(piece)
        size += len(piece)
        if size >= _BLOCK:
            yield _joined(block)
            block, size = [], 0
    if block:
        yield _joined(block)


def _joined(block: Sequence[AnyStr]) -> AnyStr:
    return block[0][:0].join(block)


def csv_text(columns: Sequence[str], rows: Iterable[Row]) -> Iterator[str]:
    """Yield the lines of a table, header first (RFC 4180); nothing in it can pass for a formula."""
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    writer.writerow([_harmless(name) for name in columns])
    yield _drain(buffer)
    for row in rows:
        writer.writerow([_harmless(row.get(name)) for name in columns])
        yield _drain(buffer)


def json_text(name: str, rows: Iterable[Row]) -> Iterator[str]:
    """Yield the pieces of a JSON object that holds one table under its name."""
    yield "{"
    yield from _member(name, rows)
    yield "}"


def ndjson_text(rows: Iterable[Row]) -> Iterator[str]:
    """Yield rows as JSON, one object a line."""
    for row in rows:
        yield _dump(row) + "\n"


def result_text(
    request: Row, points: Sequence[Row], tables: Mapping[str, Iterable[Row]], failure: Row | None = None
) -> Iterator[str]:
    """Yield the pieces of a whole result document.

    Parameters
    ----------
    request : mapping
        The request with all defaults, which is given back as `input`; with a study, or of a chunk of a batch, which
        has no line of its own, static and den_hartog are lists with a row for each point, else single objects.
    points : sequence of mappings
        With axes, static, den_hartog, warnings, engine_version and failure of each point.
    tables : mapping
        Rows by the name of their table; in a study they begin with the values of the axes.
    failure : mapping, optional
        Kind and detail of the job's failure.
    """
    several = "line" not in request or request.get("study") is not None
    yield f"{{{_dump('input')}:{_dump(request)},"
    for name in ("static", "den_hartog"):
        found = [{**point["axes"], **point[name]} for point in points if point[name]]
        yield f"{_dump(name)}:{_dump(found if several else next(iter(found), None))},"
    for name, rows in tables.items():
        yield from _member(name, rows)
        yield ","
    yield _dump(_ending(points, failure))[1:]


def _ending(points: Sequence[Row], failure: Row | None) -> dict[str, Any]:
    failed = [{**point["axes"], "failure": point["failure"]} for point in points if point["failure"]]
    return {
        "warnings": list(dict.fromkeys(warning for point in points for warning in point["warnings"])),
        "failures": failed,
        "failure": failure,
        "engine_version": next((point["engine_version"] for point in points), None),
    }


def _member(name: str, rows: Iterable[Row]) -> Iterator[str]:
    yield f"{_dump(name)}:["
    separator = ""
    for row in rows:
        yield separator + _dump(row)
        separator = ","
    yield "]"


def _dump(value: Any) -> str:
    return orjson.dumps(value).decode()


def _drain(buffer: io.StringIO) -> str:
    text = buffer.getvalue()
    buffer.seek(0)
    buffer.truncate()
    return text


def _harmless(cell: Any) -> Any:
    """Put an apostrophe before text that a spreadsheet would take for a formula; numbers stay as they are."""
    if isinstance(cell, str) and cell.startswith(_FORMULA_STARTS):
        return "'" + cell
    return cell


def _weight(accept: str, media_type: str) -> float:
    """Return the quality that an Accept header gives to a media type, the most specific range deciding (RFC 9110)."""
    ranges = dict(_range(part) for part in (accept or "*/*").split(","))
    major = media_type.partition("/")[0]
    return next((ranges[name] for name in (media_type, f"{major}/*", "*/*") if name in ranges), 0.0)


def _range(part: str) -> tuple[str, float]:
    name, *parameters = (piece.strip().lower() for piece in part.split(";"))
    quality = next((text[2:] for text in parameters if text.startswith("q=")), "1")
    try:
        return name, float(quality)
    except ValueError:
        return name, 0.0
