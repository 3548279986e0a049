"""The rows of a spreadsheet that was saved as text, with numbers as text with a point, all in memory."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice

from app.schemas.faults import MOST_FAULTS, BadInput, Fault, json_pointer
from app.sheets.delimited import SheetRow, read_delimited

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class Row:
    """Cells of one row, stripped, and the row's number as the spreadsheet shows it, from 1."""

    number: int
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Sheet:
    """The names of the columns, the rows below that are not blank, and sentences about how the text was read."""

    header: tuple[str, ...]
    rows: tuple[Row, ...]
    notes: tuple[str, ...]


def read_sheet(raw: bytes, most_rows: int | None = None) -> Sheet:
    """Return the rows of a text, so many at most.

    Raises
    ------
    BadInput
        If it is no text, has no names of columns, or a row cannot be read.
    """
    table = read_delimited([raw], _lines)
    header, found = tuple(name.strip() for name in table.header), list(islice(table.rows, most_rows))
    if not any(header):
        raise BadInput([Fault("", "csv_empty", "the text has no rows")])
    faults = [Fault(json_pointer(["rows", row.number]), "csv_row", row.fault) for row in found if row.fault]
    if faults:
        raise BadInput(faults[:MOST_FAULTS])
    return Sheet(header, tuple(map(_row, found)), tuple(table.notes.sentences()))


def _lines(pieces: Iterable[bytes]) -> Iterator[bytes]:
    yield from b"".join(pieces).splitlines(keepends=True)


def _row(row: SheetRow) -> Row:
    cells = (str(cell).strip() for cell in row.cells)
    return Row(row.number, tuple(_with_point(cell) if row.comma else cell for cell in cells))


def _with_point(cell: str) -> str:
    return cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell
