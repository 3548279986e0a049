"""Results as text, streamed: JSON documents, and CSV that is safe in a spreadsheet."""

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, AnyStr, Literal, TypeVar

import orjson

Row = Mapping[str, Any]
Format = Literal["json", "csv", "parquet", "xlsx"]
Dialect = Literal["plain", "excel", "excel_semicolon"]
Name = TypeVar("Name", bound=str)
PARQUET = "application/vnd.apache.parquet"
GEOJSON = "application/geo+json"
RDF_XML = "application/rdf+xml"
XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
MEDIA_TYPES: Mapping[Format, str] = {
    "json": "application/json",
    "csv": "text/csv; charset=utf-8",
    "parquet": PARQUET,
    "xlsx": XLSX,
}

# Include the full-width forms, which spreadsheets with East Asian settings treat like the narrow ones.
_FORMULA_STARTS = (*"=+-@\t\r\n", *"\uff1d\uff0b\uff0d\uff20")
_BLOCK = 131_072  # bytes or characters: smaller blocks cost more thread switches, larger ones more copying


def preferred_format(accept: str) -> Format | None:
    """Return the format that an Accept header prefers, JSON in a tie; None if it accepts none."""
    return preferred(accept, {"json": "application/json", "csv": "text/csv", "parquet": PARQUET, "xlsx": XLSX})


def preferred(accept: str, media_types: Mapping[Name, str]) -> Name | None:
    """Return the format whose media type an Accept header prefers, the first in a tie; None if it accepts none."""
    weights = {name: _weight(accept, media_type) for name, media_type in media_types.items()}
    best = max(weights, key=lambda name: weights[name])
    return best if weights[best] > 0.0 else None


def in_blocks(pieces: Iterable[AnyStr]) -> Iterator[AnyStr]:
    """Join small pieces of text or bytes into blocks, because each piece sent costs a switch between threads."""
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


def csv_text(columns: Sequence[str], rows: Iterable[Row], dialect: Dialect = "plain") -> Iterator[str]:
    """Yield the lines of a table, header first (RFC 4180); no cell can act as a spreadsheet formula.

    Excel's dialects begin with a byte order mark, without which it takes UTF-8 for another encoding;
    `excel_semicolon` has semicolons between cells and decimal commas, as Excel expects in most of Europe.
    """
    buffer = io.StringIO()
    if dialect != "plain":
        buffer.write("\ufeff")
    european = dialect == "excel_semicolon"
    writer = csv.writer(buffer, delimiter=";" if european else ",")
    writer.writerow([_harmless(name) for name in columns])
    yield _drain(buffer)
    for row in rows:
        cells = (_harmless(row.get(name)) for name in columns)
        writer.writerow([_with_comma(cell) for cell in cells] if european else list(cells))
        yield _drain(buffer)


def json_text(name: str, rows: Iterable[Row]) -> Iterator[str]:
    """Yield the pieces of a JSON object that contains one table under its name."""
    yield "{"
    yield from _member(name, rows)
    yield "}"


def ndjson_text(rows: Iterable[Row]) -> Iterator[str]:
    """Yield rows as JSON, one object on each line."""
    for row in rows:
        yield _dump(row) + "\n"


def geojson_text(features: Iterable[Row]) -> Iterator[str]:
    """Yield the pieces of a FeatureCollection (RFC 7946) of these features."""
    yield '{"type":"FeatureCollection",'
    yield from _member("features", features)
    yield "}"


def result_text(
    request: Row, points: Sequence[Row], tables: Mapping[str, Iterable[Row]], failure: Row | None = None
) -> Iterator[str]:
    """Yield the pieces of a complete result document.

    Parameters
    ----------
    request : mapping
        The request with all defaults, which the document repeats as `input`. For a study, or a chunk of a batch (which
        has no line), static and den_hartog are lists with a row for each point, otherwise single objects.
    points : sequence of mappings
        The axes, static, den_hartog, warnings, engine_version and failure of each point.
    tables : mapping
        Rows by the name of their table; in a study each row begins with the values of the axes.
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
    """Put an apostrophe before text that a spreadsheet would take for a formula; leave numbers unchanged."""
    if isinstance(cell, str) and cell.startswith(_FORMULA_STARTS):
        return "'" + cell
    return cell


def _with_comma(cell: Any) -> Any:
    return repr(cell).replace(".", ",") if isinstance(cell, float) else cell


def _weight(accept: str, media_type: str) -> float:
    """Return the quality that an Accept header gives a media type; the most specific range decides (RFC 9110)."""
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
