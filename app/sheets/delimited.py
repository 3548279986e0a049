"""Read a table of text as spreadsheet programs write it anywhere: comma, semicolon or tab, UTF-8 or not."""

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from app.schemas.faults import BadInput, Fault
from app.sheets.cells import has_decimal_comma
from app.sheets.encodings import Encodings, as_utf8, decoded

_DELIMITERS = {";": "semicolons", "\t": "tabs", ",": "commas"}
_BLANK = ' ";,\t\r\n'
_SEPARATOR_LINE = re.compile(r"sep=([;,\t])\s*", re.IGNORECASE)
_ROWS_NAMED = 5


class Split(Protocol):
    """What splits pieces of a body into lines of text, each with its end."""

    def __call__(self, pieces: Iterable[bytes], /) -> Iterator[bytes]:
        """Yield lines."""


@dataclass(frozen=True, slots=True)
class SheetRow:
    """The cells of a row, its number as the spreadsheet shows it, and a sentence if it could not be read."""

    number: int
    cells: Sequence[object]
    comma: bool = False
    others_comma: bool = False
    fault: str | None = None


@dataclass(slots=True)
class SheetNotes:
    """How a table was read; complete when its last row is."""

    delimiter: str = ","
    encodings: Encodings = field(default_factory=Encodings)
    windows_rows: list[int] = field(default_factory=list)
    decimal_commas: bool = False
    others: list[str] = field(default_factory=list)

    def sentences(self) -> list[str]:
        """Return a sentence for everything that is not as in a plain CSV."""
        found = list(self.others)
        if self.delimiter != ",":
            found.append(f"Cells are separated by {_DELIMITERS[self.delimiter]}.")
        if self.decimal_commas:
            found.append("Decimal commas were read as decimal points.")
        if self.encodings.utf16:
            found.append("The text was read as UTF-16.")
        if self.windows_rows:
            found.append(f"{_named(self.windows_rows)} not UTF-8; read as Windows-1252.")
        return found


@dataclass(frozen=True, slots=True)
class SheetTable:
    """The first row that is not blank, the rows below it, and notes on how they were read."""

    header: Sequence[str]
    rows: Iterator[SheetRow]
    notes: SheetNotes


def read_delimited(pieces: Iterable[bytes], split: Split) -> SheetTable:
    """Read a table; blank rows are left out, but count in the numbers of the rows.

    Raises
    ------
    BadInput
        If the header is no row of a table; while rows are read, if a text in UTF-16 breaks its rules.
    """
    notes = SheetNotes()
    texts = decoded(split(as_utf8(pieces, notes.encodings)), notes.encodings)
    number, first = 0, ""
    for text in texts:
        separator = _SEPARATOR_LINE.fullmatch(text)
        if separator and not number:  # a program reads this line, and its sheet does not show it
            notes.delimiter = separator[1]
            continue
        number, first = number + 1, text
        if text.strip(_BLANK):
            break
    outside = re.sub(r'"[^"]*"', "", first)
    most = max(_DELIMITERS, key=outside.count)
    notes.delimiter = most if most in outside else notes.delimiter
    rows = _rows(_with(first, texts), number - 1, notes)
    head = next(rows, SheetRow(1, ()))
    if head.fault:
        raise BadInput([Fault("/header", "csv_invalid", head.fault)])
    names = [str(cell) for cell in head.cells]
    while names and not names[-1].strip():  # a sheet that was once wider ends its rows by empty cells
        names.pop()
    return SheetTable(names, rows, notes)


def _with(first: str, texts: Iterator[str]) -> Iterator[str]:
    yield first
    yield from texts


def _rows(texts: Iterator[str], number: int, notes: SheetNotes) -> Iterator[SheetRow]:
    reader = csv.reader(texts, delimiter=notes.delimiter, strict=True)
    comma = notes.delimiter != ","
    while True:
        number += 1
        before = notes.encodings.windows_lines
        try:
            cells = next(reader, None)
        except csv.Error as error:
            yield SheetRow(number, (), fault=f"is no row of a table: {error}; look for a quotation mark")
            continue
        if cells is None:
            return
        if notes.encodings.windows_lines > before:
            notes.windows_rows.append(number)
        if any(cell.strip() for cell in cells):
            others = comma and has_decimal_comma(cells)
            notes.decimal_commas |= others
            yield SheetRow(number, cells, comma, others)


def _named(rows: Sequence[int]) -> str:
    shown = ", ".join(map(str, rows[:_ROWS_NAMED]))
    if len(rows) == 1:
        return f"Row {shown} is"
    more = f" and {len(rows) - _ROWS_NAMED} more" if len(rows) > _ROWS_NAMED else ""
    return f"Rows {shown}{more} are"
