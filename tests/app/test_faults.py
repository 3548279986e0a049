import pytest

from app.faults import BadInput, json_pointer, parse_json


@pytest.mark.parametrize(
    "raw",
    [
        b"",
        b"{",
        b"[1,]",
        b"{'a': 1}",
        b"\xff\xfe",
        b'{"a": "\xc3("}',
        b"[" * 100_000,
        b'{"a":' * 5_000,
        b"1" * 10_000,
        b'"\\ud800"',
        b"{} {}",
    ],
)
def test_what_is_no_json_is_one_fault_at_the_root(raw: bytes) -> None:
    with pytest.raises(BadInput) as caught:
        parse_json(raw)
    assert [(fault.pointer, fault.code) for fault in caught.value.faults] == [("", "json_invalid")]


def test_json_is_taken_with_its_numbers_as_they_are() -> None:
    assert parse_json(b'{"a": [1, 2.5, true, null, "x"]}') == {"a": [1, 2.5, True, None, "x"]}
    assert parse_json(b"NaN") != parse_json(b"NaN")


def test_pointers_escape_and_cut_what_strangers_wrote() -> None:
    assert json_pointer(["line", "a/b~c", 3]) == "/line/a~1b~0c/3"
    assert json_pointer([]) == ""
    assert json_pointer(["x" * 10_000]) == "/" + "x" * 200
