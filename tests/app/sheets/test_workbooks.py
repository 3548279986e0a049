import io
import re
import zipfile
from datetime import date
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl import Workbook

from app.schemas.faults import BadInput
from app.sheets.cells import WrongCell, value_of
from app.sheets.delimited import SheetRow, SheetTable
from app.sheets.workbooks import read_workbook

MOST = 1_000_000


def saved(rows: list[list[Any]], *further: str) -> bytes:
    workbook = Workbook()
    sheet = workbook.active
    assert sheet is not None
    sheet.title = "Spans"
    for row in rows:
        sheet.append(row)
    for name in further:
        workbook.create_sheet(name)
    file = io.BytesIO()
    workbook.save(file)
    return file.getvalue()


def read(raw: bytes) -> tuple[SheetTable, list[SheetRow]]:
    table = read_workbook(io.BytesIO(raw), MOST, MOST)
    return table, list(table.rows)


def changed(raw: bytes, part: str, old: bytes, new: bytes) -> bytes:
    """Return a workbook with what fits a pattern replaced in one of its parts."""
    file = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(raw)) as before, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as after:
        for name in before.namelist():
            content = before.read(name)
            assert name != part or re.search(old, content)
            after.writestr(name, re.sub(old, new, content) if name == part else content)
    return file.getvalue()


CELLS = st.one_of(st.floats(-1e12, 1e12), st.integers(-(10**9), 10**9), st.booleans(), st.sampled_from(["Ås", "a;b"]))


@settings(max_examples=50, deadline=None)
@given(st.lists(st.lists(CELLS, min_size=1, max_size=4), min_size=1, max_size=6))
def test_cells_come_out_as_they_went_in(rows: list[list[Any]]) -> None:
    table, found = read(saved([["a", "b", "c", "d"], *rows]))
    assert list(table.header) == ["a", "b", "c", "d"]
    assert [row.number for row in found] == list(range(2, len(rows) + 2))
    for row, wanted in zip(found, rows, strict=True):
        values = [value_of(cell, comma=row.comma) for cell in row.cells][: len(wanted)]
        for value, given_value in zip(values, wanted, strict=True):  # openpyxl writes 16 digits
            close = pytest.approx(given_value, rel=1e-15) if isinstance(given_value, float) else given_value
            assert value == close and isinstance(value, bool) == isinstance(given_value, bool)


def test_blank_rows_count_and_other_sheets_are_named() -> None:
    table, found = read(saved([[], ["a", "b", None], [1, 2.5], [None, " "], ["0,5", True]], "Notes"))
    assert list(table.header) == ["a", "b"]
    assert [(row.number, list(row.cells)[:2]) for row in found] == [(3, [1, 2.5]), (5, ["0,5", True])]
    assert table.notes.sentences() == ["Only the first sheet, 'Spans', was read."]


def test_dates_and_formulas_without_a_value_are_no_numbers() -> None:
    raw = saved([["a", "b"], [date(2026, 5, 1), "=1+1"], [3, None]])
    _, (first, second) = read(raw)
    day, formula = (value_of(cell, comma=True) for cell in first.cells)
    assert isinstance(day, WrongCell) and "date" in day.sentence
    assert isinstance(formula, WrongCell) and "formula whose value is not stored" in formula.sentence
    assert list(second.cells) == [3]


def test_a_formula_is_read_as_its_stored_value() -> None:
    raw = changed(saved([["a"], ["=1+1"]]), "xl/worksheets/sheet1.xml", rb"<v ?/>|<v></v>", b"<v>2</v>")
    _, (row,) = read(raw)
    assert list(row.cells) == [2]


def test_bombs_are_refused_before_they_are_unpacked() -> None:
    raw = saved([["a"], [1]])
    for part in ("xl/worksheets/sheet1.xml", "xl/sharedStrings.xml", "xl/media/image1.png"):
        file = io.BytesIO(raw)
        with zipfile.ZipFile(file, "a", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr(part.replace("sheet1", "sheet9"), b" " * (MOST + 1))
        with pytest.raises(BadInput) as caught:
            read_workbook(file, MOST, MOST)
        assert caught.value.faults[0].code == "xlsx_too_large"


def test_entities_are_not_expanded() -> None:
    declared = b'<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa">]><worksheet'
    with pytest.raises(BadInput) as caught:
        read(changed(saved([["a"], [1]]), "xl/worksheets/sheet1.xml", b"<worksheet", declared))
    assert caught.value.faults[0].code == "xlsx_invalid"


@pytest.mark.parametrize("raw", [b"", b"PK", b"reference,name\n", b"\xd0\xcf\x11\xe0" + b"\0" * 600])
def test_what_is_no_workbook_is_refused(raw: bytes) -> None:
    with pytest.raises(BadInput) as caught:
        read(raw)
    assert [fault.code for fault in caught.value.faults] == ["xlsx_invalid"]


@pytest.mark.parametrize("part", ["xl/workbook.xml", "xl/worksheets/sheet1.xml", "[Content_Types].xml"])
def test_a_workbook_with_a_broken_part_is_refused(part: str) -> None:
    raw = saved([["a"], [1]])
    for broken in (changed(raw, part, b"<", b"&"), raw[: len(raw) // 2]):
        with pytest.raises(BadInput):
            read(broken)


def test_rows_beyond_the_bound_of_excel_are_refused() -> None:
    raw = changed(saved([["a"], [1]]), "xl/worksheets/sheet1.xml", b'r="2"', b'r="9999999"')
    with pytest.raises(BadInput, match="at most 1048576 rows"):
        read(raw)
