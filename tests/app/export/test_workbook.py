import io
from typing import Any

import openpyxl
import pytest

from app.export.exported_columns import ExportedColumn
from app.export.workbook import xlsx_bytes

COLUMNS = [ExportedColumn("reference", "text", None, "Of the caller"), ExportedColumn("sag_m", "number", "m", "Sag")]


def opened(rows: list[dict[str, Any]], most_rows: int = 1_048_576) -> Any:
    raw = b"".join(xlsx_bytes("summary", COLUMNS, rows, most_rows))
    return openpyxl.load_workbook(io.BytesIO(raw))


def test_values_keep_their_kinds_and_columns_their_meaning() -> None:
    book = opened([{"reference": "Ås", "sag_m": 1.54}, {"reference": None, "sag_m": -2}, {"sag_m": True}])
    assert book.sheetnames == ["summary", "columns"]
    rows = list(book["summary"].iter_rows(values_only=True))
    assert rows == [("reference", "sag_m"), ("Ås", 1.54), (None, -2), (None, True)]
    assert list(book["columns"].iter_rows(values_only=True))[1:] == [
        ("reference", None, "Of the caller"),
        ("sag_m", "m", "Sag"),
    ]


@pytest.mark.parametrize("text", ["=1+1", "=HYPERLINK(1)", "+1", "@x", "'a"])
def test_text_is_never_a_formula(text: str) -> None:
    cell = opened([{"reference": text}])["summary"]["A2"]
    assert (cell.value, cell.data_type) == (text, "s")


def test_what_a_workbook_cannot_hold_is_replaced_or_cut() -> None:
    sheet = opened([{"reference": "a\x01b"}, {"reference": "x" * 40_000}])["summary"]
    assert sheet["A2"].value == "a\ufffdb" and len(sheet["A3"].value) == 32_767


def test_rows_beyond_the_bound_go_to_further_sheets() -> None:
    book = opened([{"sag_m": number} for number in range(5)], most_rows=3)
    assert book.sheetnames == ["summary", "summary 2", "summary 3", "columns"]
    assert [book[name].max_row for name in book.sheetnames[:3]] == [3, 3, 2]
    assert book["summary 3"]["B2"].value == 4
