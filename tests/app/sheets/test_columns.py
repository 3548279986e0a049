from collections.abc import Iterator

import pytest

from app.batches.intake import read_csv
from app.schemas.faults import BadInput
from app.sheets.columns import Columns, PlacedLine
from app.sheets.delimited import SheetRow


def pieces(body: bytes, size: int) -> Iterator[bytes]:
    for first in range(0, len(body), size):
        yield body[first : first + size]


def codes(error: pytest.ExceptionInfo[BadInput]) -> list[tuple[str, str]]:
    return [(fault.pointer, fault.code) for fault in error.value.faults]


def taken(body: bytes, size: int = 1000) -> list[PlacedLine]:
    lines = []
    for line in read_csv(pieces(body, size), {}, 1000).lines:
        assert isinstance(line, PlacedLine)
        lines.append(line)
    return lines


@pytest.mark.parametrize("size", [1, 11, 1000])
def test_csv_cells_become_fields(size: int) -> None:
    header = "reference,name,span.length_m,span.elements,ice.v,damping.model,devices.1.from_m,devices.0.type,tags.a.b"
    text = f'\ufeff{header}\r\n007,"two\r\nlines",125.5,10,"[1, 2.5]",constant_ratio,3,spacer,1\r\n\r\n,,9,,,,,,\r\n'
    first, second = taken(text.encode(), size)
    assert (first.row, second.row) == (2, 4)
    assert first.document == {
        "reference": "007",
        "name": "two\r\nlines",
        "span": {"length_m": 125.5, "elements": 10},
        "ice": {"v": [1, 2.5]},
        "damping": {"model": "constant_ratio"},
        "devices": [{"type": "spacer"}, {"from_m": 3}],
        "tags": {"a.b": "1"},
    }
    assert second.document == {"span": {"length_m": 9}}


def test_a_row_of_another_length_is_told_of_in_its_place() -> None:
    first, second, third, fourth = taken(b"a.b,c\n1,2\n1,2,3\n1\n1,2,,\n")
    assert first.document == {"a": {"b": 1}, "c": 2} == fourth.document
    assert isinstance(second.document, BadInput) and "3 cells, but the header has 2" in str(second.document)
    assert third.document == {"a": {"b": 1}}


def test_a_cell_whose_value_would_be_a_guess_is_told_of_by_its_field() -> None:
    first, second = taken(b"reference;span.length_m;span.tension\n1;1.234,5;0,5\n2;300,5;01.02.2026\n")
    assert [(fault.pointer, fault.code) for fault in first.faults] == [("/span/length_m", "csv_value")]
    assert first.document == {"reference": "1", "span": {"tension": 0.5}}
    assert [fault.pointer for fault in second.faults] == ["/span/tension"] and "date" in second.faults[0].detail


def test_names_stay_text_even_if_they_are_numbers() -> None:
    (line,) = taken(b"reference,conductor.catalogue,phases.0.name\n7,477,12\n")
    assert line.document == {"reference": "7", "conductor": {"catalogue": "477"}, "phases": [{"name": "12"}]}
    columns = Columns.of(["reference", "tags.n", "span.elements"])
    assert columns.line(SheetRow(2, [7.0, True, 10.0])).document == {
        "reference": "7",
        "tags": {"n": "True"},
        "span": {"elements": 10},
    }


@pytest.mark.parametrize(
    ("header", "places"),
    [
        ("a,,b", ["/header/1"]),
        ("a,b,a", ["/header/0", "/header/2"]),
        ("a.b,a", ["/header/1"]),
        ("a.5000", ["/header/0"]),
        ("0.a", ["/header/0"]),
        ("1", ["/header/0"]),
        (",".join(["x"] * 501), ["/header"]),
    ],
)
def test_headers_at_fault_are_refused_whole(header: str, places: list[str]) -> None:
    with pytest.raises(BadInput) as caught:
        read_csv([f"{header}\n1\n".encode()], {}, 5000)
    assert [pointer for pointer, _ in codes(caught)] == places


def test_a_header_is_needed() -> None:
    with pytest.raises(BadInput) as caught:
        read_csv([b"\r\n"], {}, 100)
    assert codes(caught) == [("/header", "csv_header")]


def test_what_is_no_csv_spoils_its_row_only() -> None:
    first, second = taken(b'a\n"1"2\n3\n')
    assert isinstance(first.document, BadInput) and [f.code for f in first.document.faults] == ["csv_invalid"]
    assert (second.row, second.document) == (3, {"a": 3})
