from collections.abc import Iterator

import pytest

from app.schemas.faults import BadInput
from app.sheets.encodings import Encodings, as_utf8, decoded

TEXT = "name;länge\r\nÅs;1,5\r\n"


def pieces(body: bytes, size: int) -> Iterator[bytes]:
    for first in range(0, len(body), size):
        yield body[first : first + size]


@pytest.mark.parametrize("size", [1, 3, 1000])
@pytest.mark.parametrize(
    "raw",
    [
        TEXT.encode(),
        TEXT.encode("utf-8-sig"),
        TEXT.encode("utf-16"),
        b"\xfe\xff" + TEXT.encode("utf-16-be"),
        TEXT.encode("utf-16-le"),
        TEXT.encode("utf-16-be"),
    ],
)
def test_a_text_is_the_same_in_every_encoding(raw: bytes, size: int) -> None:
    found = Encodings()
    assert b"".join(as_utf8(pieces(raw, size), found)).decode() == TEXT
    assert found.utf16 == (b"\0" in raw)


def test_lone_returns_end_lines_if_nothing_else_does() -> None:
    assert b"".join(as_utf8([b"a\rb", b"\rc\r"])) == b"a\nb\nc\n"
    assert b"".join(as_utf8([b"a\r\nb\rc"])) == b"a\r\nb\rc"


def test_short_and_empty_texts_stay() -> None:
    for raw in (b"", b"a", b"a\n", b"\n\n"):
        assert b"".join(as_utf8(pieces(raw, 1))) == raw


@pytest.mark.parametrize("raw", [b"\xff\xfea\0b", b"\xff\xfe\x00\xd8a\0"])
def test_broken_utf16_is_the_senders_fault(raw: bytes) -> None:
    with pytest.raises(BadInput) as caught:
        list(as_utf8([raw]))
    assert caught.value.faults[0].code == "not_utf16" and "save it as UTF-8" in str(caught.value)


def test_only_the_line_with_the_odd_byte_is_read_as_windows_1252() -> None:
    found = Encodings()
    lines = list(decoded(["Größe\n".encode(), "Größe € \u0178\n".encode("cp1252"), b"\x81\n"], found))
    assert lines == ["Größe\n", "Größe € \u0178\n", "\ufffd\n"]
    assert found.windows_lines == 2
