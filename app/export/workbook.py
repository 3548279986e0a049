"""Result tables as Excel workbooks (XLSX): one sheet with the rows, one with the meaning of the columns."""

import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from openpyxl import Workbook
from openpyxl.cell import WriteOnlyCell
from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE
from openpyxl.styles import Font

from app.export.exported_columns import ExportedColumn

_MOST_ROWS = 1_048_576
_MOST_CHARACTERS = 32_767
_TITLE_CHARACTERS = 31
_BLOCK = 1 << 17


def xlsx_bytes(
    title: str, columns: Sequence[ExportedColumn], rows: Iterable[Mapping[str, Any]], most_rows: int = _MOST_ROWS
) -> Iterator[bytes]:
    """Yield the pieces of a workbook, which is written to a temporary file with few rows in memory.

    Parameters
    ----------
    title : str
        Name of the sheet.
    columns : sequence of ExportedColumn
        Unit and description go to the second sheet.
    rows : iterable of mappings
        Values by the name of their column; text is never a formula.
    most_rows : int
        Rows of a sheet with its header; what is more goes to further sheets, as Excel's own bound asks.
    """
    workbook = Workbook(write_only=True)
    names = [column.name for column in columns]
    sheet, taken, number = _sheet(workbook, title, names), 1, 1
    for row in rows:
        if taken == most_rows:
            number += 1
            sheet, taken = _sheet(workbook, f"{title[: _TITLE_CHARACTERS - 4]} {number}", names), 1
        sheet.append([_cell(sheet, row.get(name)) for name in names])
        taken += 1
    legend = _sheet(workbook, "columns", ["column", "unit", "meaning"])
    for column in columns:
        legend.append([column.name, column.unit, column.description])
    with tempfile.TemporaryFile() as file:
        workbook.save(file)
        file.seek(0)
        while block := file.read(_BLOCK):
            yield block


def _sheet(workbook: Workbook, title: str, names: Sequence[str]) -> Any:
    sheet: Any = workbook.create_sheet(title[:_TITLE_CHARACTERS])
    sheet.freeze_panes = "A2"
    header = [WriteOnlyCell(sheet, name) for name in names]
    for cell in header:
        cell.font = Font(bold=True)
    sheet.append(header)
    return sheet


def _cell(sheet: Any, value: Any) -> Any:
    if not isinstance(value, str):
        return value
    text = ILLEGAL_CHARACTERS_RE.sub("\ufffd", value)[:_MOST_CHARACTERS]
    if not text.startswith("="):
        return text
    cell = WriteOnlyCell(sheet, text)
    cell.data_type = "s"
    return cell
