"""Read the first sheet of an Excel workbook (XLSX) row by row; nothing in it is computed, fetched or expanded."""

import zipfile
from collections.abc import Iterator, Sequence
from contextlib import closing
from itertools import zip_longest
from typing import IO, Any

import openpyxl
from defusedxml.common import DefusedXmlException
from openpyxl.utils.exceptions import InvalidFileException

from app.schemas.faults import BadInput, Fault
from app.sheets.cells import WrongCell, has_decimal_comma
from app.sheets.delimited import SheetNotes, SheetRow, SheetTable

_MOST_PARTS = 1000
_MOST_ROWS = 1_048_576
_OLD_FORM = b"\xd0\xcf\x11\xe0"
_FORMULAS = (b"<f>", b"<f ", b"<f/", b":f>", b":f ")
_BLOCK = 1 << 20
_UNVALUED = WrongCell("is a formula whose value is not stored; open the workbook in Excel and save it")
# openpyxl lets through what it does not expect: each of these came from a workbook that was cut or changed.
_BROKEN = (
    zipfile.BadZipFile,
    InvalidFileException,
    DefusedXmlException,
    ArithmeticError,
    AttributeError,
    EOFError,
    LookupError,
    NotImplementedError,
    RuntimeError,
    SyntaxError,
    TypeError,
    ValueError,
)

Cells = Sequence[object]


def read_workbook(file: IO[bytes], most_bytes: int, most_other_bytes: int) -> SheetTable:
    """Read the first sheet; formulas are read as the values that the workbook stores for them.

    Parameters
    ----------
    file : binary file
        It must stay open until the last row is taken.
    most_bytes, most_other_bytes : int
        Bounds on the unpacked size of the sheets, read row by row, and of everything else, which is held in memory.

    Raises
    ------
    BadInput
        If it is no workbook, or is larger unpacked than the bounds; also while the rows are read.
    """
    notes = SheetNotes()
    try:
        has_formulas = _examined(file, most_bytes, most_other_bytes)
        workbook = _opened(file, values=True)
        shown = [sheet.title for sheet in workbook.worksheets if sheet.sheet_state == "visible"]
        if not shown:
            raise _fault("xlsx_empty", "the workbook has no sheet")
        if len(shown) > 1:
            notes.others.append(f"Only the first sheet, {shown[0]!r}, was read.")
        rows = _valued(file, workbook, shown[0]) if has_formulas else _plain(workbook, shown[0])
    except BadInput:
        raise
    except _BROKEN as error:
        raise _as_fault(error) from error
    below = _rows(rows)
    header = next(below, SheetRow(1, ()))
    names = ["" if cell is None else str(cell) for cell in header.cells]
    while names and not names[-1].strip():
        names.pop()
    return SheetTable(names, below, notes)


def _rows(rows: Iterator[Cells]) -> Iterator[SheetRow]:
    try:
        for number, cells in enumerate(rows, 1):
            if number > _MOST_ROWS:
                raise _fault("xlsx_invalid", f"a sheet has at most {_MOST_ROWS} rows")
            filled = [cell for cell in cells if cell is not None and not (isinstance(cell, str) and not cell.strip())]
            if filled:
                texts = [cell for cell in filled if isinstance(cell, str)]
                yield SheetRow(number, cells, comma=True, others_comma=has_decimal_comma(texts))
    except BadInput:
        raise
    except _BROKEN as error:
        raise _as_fault(error) from error


def _examined(file: IO[bytes], most_bytes: int, most_other_bytes: int) -> bool:
    """Check the sizes that the parts declare, which their reader never exceeds; tell whether there are formulas."""
    if file.read(len(_OLD_FORM)) == _OLD_FORM:
        detail = "the workbook is in the old form (XLS) or needs a password; save it as XLSX without one"
        raise _fault("xlsx_invalid", detail)
    with zipfile.ZipFile(file) as archive:
        parts = archive.infolist()
        sheets = [part for part in parts if part.filename.startswith("xl/worksheets/")]
        size, whole = (sum(part.file_size for part in some) for some in (sheets, parts))
        if len(parts) > _MOST_PARTS or size > most_bytes or whole - size > most_other_bytes:
            bounds = f"{_MOST_PARTS} parts, {most_bytes} bytes of sheets and {most_other_bytes} of the rest"
            raise _fault("xlsx_too_large", f"unpacked, a workbook may have at most {bounds}")
        return any(_holds_formula(archive, part) for part in parts if part.filename.endswith(".xml"))


def _holds_formula(archive: zipfile.ZipFile, part: zipfile.ZipInfo) -> bool:
    with archive.open(part) as stream:
        end = b""
        while block := stream.read(_BLOCK):
            if any(mark in end + block for mark in _FORMULAS):
                return True
            end = block[-3:]
    return False


def _opened(file: IO[bytes], *, values: bool) -> Any:
    file.seek(0)
    return openpyxl.load_workbook(file, read_only=True, data_only=values, keep_links=False)


def _plain(workbook: Any, title: str) -> Iterator[Cells]:
    with closing(workbook):
        sheet = workbook[title]
        sheet.reset_dimensions()  # some programs write wrong ones
        yield from sheet.iter_rows(values_only=True)


def _valued(file: IO[bytes], workbook: Any, title: str) -> Iterator[Cells]:
    """Yield the stored values; a formula without one would otherwise look like an empty cell."""
    for values, formulas in zip(_plain(workbook, title), _plain(_opened(file, values=False), title), strict=True):
        pairs = zip_longest(values, formulas)
        yield [_UNVALUED if value is None and formula is not None else value for value, formula in pairs]


def _fault(code: str, detail: str) -> BadInput:
    return BadInput([Fault("", code, detail)])


def _as_fault(error: Exception) -> BadInput:
    return _fault("xlsx_invalid", f"not a workbook that can be read: {str(error)[:200] or type(error).__name__}")
