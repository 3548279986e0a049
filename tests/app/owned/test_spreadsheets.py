import pytest

from app.owned.spreadsheets import read_sheet
from app.schemas.faults import BadInput


@pytest.mark.parametrize("mark", [";", "\t", ","])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252"])
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_a_sheet_is_read_as_excel_writes_it_anywhere(mark: str, encoding: str, ending: str) -> None:
    text = ending.join([f"name{mark}größe", f'"a{mark} b"{mark}28.1', mark, "", f" c {mark}2"])
    sheet = read_sheet(text.encode(encoding))
    assert [row.number for row in sheet.rows] == [1, 2, 5]
    assert [row.cells for row in sheet.rows] == [("name", "größe"), (f"a{mark} b", "28.1"), ("c", "2")]
    assert ("Windows-1252" in sheet.notes[0]) is (encoding == "cp1252")


def test_a_decimal_comma_is_a_point_where_commas_do_not_part_cells() -> None:
    sheet = read_sheet(b"a;b\n28,11;1,5e3\n1,2,3;x,1")
    assert [row.cells for row in sheet.rows[1:]] == [("28.11", "1.5e3"), ("1,2,3", "x,1")]
    assert "decimal commas were read as decimal points" in sheet.notes
    assert read_sheet(b"a,b\n28,11").rows[1].cells == ("28", "11")


@pytest.mark.parametrize(("raw", "code"), [(b"", "csv_empty"), (b"\n;;\n", "csv_empty"), (b"a\0b", "csv_invalid")])
def test_what_is_no_sheet_is_refused(raw: bytes, code: str) -> None:
    with pytest.raises(BadInput) as caught:
        read_sheet(raw)
    assert [fault.code for fault in caught.value.faults] == [code]


def test_a_quote_that_never_ends_is_refused() -> None:
    with pytest.raises(BadInput):
        read_sheet(b'a;b\n"x;1')
