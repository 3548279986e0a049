import pytest

from app.owned.spreadsheets import read_sheet
from app.schemas.faults import BadInput


@pytest.mark.parametrize("mark", [";", "\t", ","])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16"])
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_a_sheet_is_read_as_excel_writes_it_anywhere(mark: str, encoding: str, ending: str) -> None:
    text = ending.join([f"name{mark}größe", f'"a{mark} ü"{mark}28.1', mark, "", f" c {mark}2"])
    sheet = read_sheet(text.encode(encoding))
    assert sheet.header == ("name", "größe")
    assert [(row.number, row.cells) for row in sheet.rows] == [(2, (f"a{mark} ü", "28.1")), (5, ("c", "2"))]
    assert any("Windows-1252" in note for note in sheet.notes) is (encoding == "cp1252")


def test_a_decimal_comma_is_a_point_where_commas_do_not_part_cells() -> None:
    sheet = read_sheet(b"a;b\n28,11;1,5e3\n1,2,3;x,1")
    assert [row.cells for row in sheet.rows] == [("28.11", "1.5e3"), ("1,2,3", "x,1")]
    assert "Decimal commas were read as decimal points." in sheet.notes
    assert read_sheet(b"a,b\n28,11").rows[0].cells == ("28", "11")


@pytest.mark.parametrize("raw", [b"", b"\n;;\n"])
def test_a_text_without_names_is_refused(raw: bytes) -> None:
    with pytest.raises(BadInput) as caught:
        read_sheet(raw)
    assert [fault.code for fault in caught.value.faults] == ["csv_empty"]


def test_a_quote_that_never_ends_is_refused() -> None:
    with pytest.raises(BadInput):
        read_sheet(b'a;b\n"x;1')


def test_no_more_rows_are_read_than_are_asked_for() -> None:
    assert [row.number for row in read_sheet(b"a\n1\n2\n3\n4", 2).rows] == [2, 3]
