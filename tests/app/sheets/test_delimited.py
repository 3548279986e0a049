import csv
import io
from collections.abc import Iterable, Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.schemas.faults import BadInput
from app.sheets.cells import value_of
from app.sheets.delimited import SheetRow, SheetTable, read_delimited


def lines(pieces: Iterable[bytes]) -> Iterator[bytes]:
    return iter(b"".join(pieces).splitlines(keepends=True))


def read(raw: bytes) -> tuple[SheetTable, list[SheetRow]]:
    table = read_delimited([raw], lines)
    return table, list(table.rows)


NUMBERS = st.one_of(
    st.floats(-1e9, 1e9), st.integers(-(10**6), 10**6), st.booleans(), st.sampled_from([0.0286, 28418105.8, -0.00063])
)
TABLES = st.integers(1, 6).flatmap(
    lambda width: st.lists(
        st.tuples(st.text("abcÄéß ;,\t\"'\n", max_size=6), *[NUMBERS] * width),
        min_size=1,
        max_size=8,
    )
)


@settings(max_examples=200, deadline=None)
@given(
    TABLES,
    st.sampled_from(";\t,"),
    st.booleans(),
    st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "cp1252"]),
    st.integers(0, 3),
)
def test_a_table_reads_the_same_however_it_was_written(
    rows: list[tuple[object, ...]], delimiter: str, decimal_comma: bool, encoding: str, blank: int
) -> None:
    decimal_comma = decimal_comma and delimiter != ","
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, delimiter=delimiter)
    buffer.write("\r\n" * blank)
    names = ["name", *(f"span.n{i}" for i in range(len(rows[0]) - 1))]
    writer.writerow(names)
    for name, *numbers in rows:
        texts = [str(number).upper() if isinstance(number, bool) else repr(number) for number in numbers]
        writer.writerow([name, *(text.replace(".", ",") if decimal_comma else text for text in texts)])
        buffer.write(delimiter * len(numbers) + "\r\n")  # a blank row, which counts
    table, found = read(buffer.getvalue().encode(encoding))
    assert list(table.header) == names
    assert [row.number for row in found] == [blank + 2 + 2 * place for place in range(len(rows))]
    for row, (name, *numbers) in zip(found, rows, strict=True):
        assert row.cells[0] == name and row.fault is None
        assert [value_of(cell, comma=row.comma) for cell in row.cells[1:]] == numbers


def test_notes_say_what_is_not_plain() -> None:
    table, _ = read(b"a,b\n1,2\n")
    assert table.notes.sentences() == []
    table, _ = read("a;b\nÅ;1,5\n".encode("utf-16"))
    assert table.notes.sentences() == [
        "Cells are separated by semicolons.",
        "Decimal commas were read as decimal points.",
        "The text was read as UTF-16.",
    ]
    table, found = read(b"a\tb\n1\t2\n\xc5s\t3\n")
    assert found[1].cells == ["Ås", "3"]
    assert table.notes.sentences() == ["Cells are separated by tabs.", "Row 3 is not UTF-8; read as Windows-1252."]
    table, _ = read(b"a,b\n" + b"\xc5,3\n" * 7)
    assert table.notes.sentences() == ["Rows 2, 3, 4, 5, 6 and 2 more are not UTF-8; read as Windows-1252."]


def test_a_line_that_names_the_separator_is_not_in_the_sheet() -> None:
    table, found = read(b"sep=;\r\na,b;c\r\n1;2\r\n")
    assert list(table.header) == ["a,b", "c"] and [(row.number, row.cells) for row in found] == [(2, ["1", "2"])]


def test_a_row_in_several_lines_counts_once_and_a_wrong_quotation_mark_spoils_one_row() -> None:
    _, found = read(b'a,b\n"x\ny",1\n"q"r,2\nz,3\n"open,4\n')
    assert [row.number for row in found] == [2, 3, 4, 5]
    assert [row.fault is None for row in found] == [True, False, True, False]
    assert found[2].cells == ["z", "3"] and "quotation mark" in (found[1].fault or "")


def test_empty_cells_beyond_the_names_are_no_columns() -> None:
    table, found = read(b"a;b;;\n1;2;;\n3\n")
    assert list(table.header) == ["a", "b"] and [len(row.cells) for row in found] == [4, 1]


def test_a_header_that_is_no_row_is_refused() -> None:
    with pytest.raises(BadInput, match="quotation mark"):
        read(b'"a"b,c\n1,2\n')
