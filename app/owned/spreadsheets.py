"""Read the rows of a spreadsheet that was saved as text, as Excel writes it anywhere.

Comma, semicolon or tab between cells, decimal comma or point, byte order mark, UTF-8 or Windows-1252: the text shows
which, and the answer names them. Rows keep the numbers that the spreadsheet shows; blank rows are left out.
"""

import csv
import re
from dataclasses import dataclass

from app.schemas.faults import BadInput, Fault

_DELIMITERS = (";", "\t", ",")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class Row:
    """Cells of one row, stripped, and the row's number as the spreadsheet shows it, from 1."""

    number: int
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Sheet:
    """The rows that are not blank, and sentences about how the text was read."""

    rows: tuple[Row, ...]
    notes: tuple[str, ...]


def read_sheet(raw: bytes) -> Sheet:
    """Return the rows of a text.

    Raises
    ------
    BadInput
        If it is no text, or has no rows.
    """
    text, encoding = _decoded(raw)
    if not text.strip(' ";,\t\r\n'):
        raise BadInput([Fault("", "csv_empty", "the text has no rows")])
    delimiter = _delimiter(text)
    try:
        rows = tuple(_rows(text, delimiter))
    except csv.Error as error:
        raise BadInput([Fault("", "csv_invalid", f"the text is no table of cells: {error}")]) from error
    names = {";": "semicolons", "\t": "tabs", ",": "commas"}
    notes = [f"read as {encoding}, cells apart by {names[delimiter]}"]
    if delimiter != ",":
        found = [row for row in rows if any(map(_DECIMAL_COMMA.fullmatch, row.cells))]
        rows = tuple(Row(row.number, tuple(map(_with_point, row.cells))) for row in rows)
        notes += ["decimal commas were read as decimal points"] if found else []
    return Sheet(rows, tuple(notes))


def _decoded(raw: bytes) -> tuple[str, str]:
    if b"\0" in raw:
        raise BadInput(
            [Fault("", "csv_invalid", "the body is no text in UTF-8 or Windows-1252; save the sheet as CSV")]
        )
    try:
        return raw.decode("utf-8-sig"), "UTF-8"
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace"), "Windows-1252"


def _delimiter(text: str) -> str:
    """Return what stands between the cells of the first line: semicolons if there are any, else tabs, else commas."""
    first = next((line for line in text.splitlines() if line.strip(" \t;,")), "")
    outside = re.sub(r'"[^"]*"', "", first)
    return next((mark for mark in _DELIMITERS if mark in outside), ",")


def _rows(text: str, delimiter: str) -> list[Row]:
    reader = csv.reader(text.splitlines(keepends=True), delimiter=delimiter, strict=True)
    cells = [tuple(cell.strip() for cell in row) for row in reader]
    return [Row(number, row) for number, row in enumerate(cells, start=1) if any(row)]


def _with_point(cell: str) -> str:
    return cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell
