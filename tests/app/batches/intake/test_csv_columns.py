from collections.abc import Iterator

import pytest

from app.batches.intake import read_csv
from app.schemas.faults import BadInput


def pieces(body: bytes, size: int) -> Iterator[bytes]:
    for first in range(0, len(body), size):
        yield body[first : first + size]


def codes(error: pytest.ExceptionInfo[BadInput]) -> list[tuple[str, str]]:
    return [(fault.pointer, fault.code) for fault in error.value.faults]


@pytest.mark.parametrize("size", [1, 11, 1000])
def test_csv_cells_become_fields(size: int) -> None:
    header = "reference,name,span.length_m,span.elements,ice.v,damping.model,devices.1.from_m,devices.0.type,tags.a.b"
    text = f'\ufeff{header}\r\n007,"two\r\nlines",125.5,10,"[1, 2.5]",constant_ratio,3,spacer,1\r\n\r\n,,9,,,,,,\r\n'
    first, second = read_csv(pieces(text.encode(), size), {"loops": [1]}, 1000).lines
    assert first == {
        "reference": "007",
        "name": "two\r\nlines",
        "span": {"length_m": 125.5, "elements": 10},
        "ice": {"v": [1, 2.5]},
        "damping": {"model": "constant_ratio"},
        "devices": [{"type": "spacer"}, {"from_m": 3}],
        "tags": {"a.b": "1"},
    }
    assert second == {"span": {"length_m": 9}}


def test_a_row_of_another_length_is_told_of_in_its_place() -> None:
    first, second = read_csv([b"a.b,c\n1,2\n1,2,3\n"], {}, 100).lines
    assert first == {"a": {"b": 1}, "c": 2}
    assert isinstance(second, BadInput) and "3 cells, but the header has 2" in str(second)


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


def test_what_is_no_csv_or_no_utf8_is_refused() -> None:
    for body, code in ((b'a\n"1"2\n', "csv_invalid"), (b"a\n\xff\n", "not_utf8")):
        with pytest.raises(BadInput) as caught:
            list(read_csv([body], {}, 100).lines)
        assert codes(caught) == [("", code)]
