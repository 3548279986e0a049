"""Tell the encoding of a text that arrives in pieces, and turn it into UTF-8 or into lines of text."""

import codecs
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain

from app.schemas.faults import BadInput, Fault

_HEAD_BYTES = 65_536
_UTF16 = {codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
_LONE_RETURN = re.compile(rb"\r(?!\n)")


@dataclass(slots=True)
class Encodings:
    """How a text was read; it grows while the text is read."""

    utf16: bool = False
    windows_lines: int = 0


def as_utf8(pieces: Iterable[bytes], found: Encodings | None = None) -> Iterator[bytes]:
    r"""Yield a text in UTF-8 without a byte order mark, and with `\n` where lines end by `\r` alone.

    UTF-16 is told by its byte order mark or by the zero bytes of its first characters.

    Raises
    ------
    BadInput
        If a text in UTF-16 breaks its rules.
    """
    found = found or Encodings()
    head, pieces = _head(pieces)
    name = _utf16_name(head)
    if name is not None:
        found.utf16 = True
        head, pieces = _head(_recoded(chain([head], pieces), name))
    head = head.removeprefix(codecs.BOM_UTF8)
    if b"\n" not in head and _LONE_RETURN.search(head[:-1]):  # Excel for Mac ends lines so
        yield head.replace(b"\r", b"\n")
        yield from (piece.replace(b"\r", b"\n") for piece in pieces)
        return
    yield head
    yield from pieces


def decoded(texts: Iterable[bytes], found: Encodings) -> Iterator[str]:
    """Yield lines of text; a line that is not UTF-8 is read as Windows-1252 and counted.

    Each line is judged by itself, so that one byte of another program spoils no other line.
    """
    for text in texts:
        try:
            yield text.decode()
        except UnicodeDecodeError:
            found.windows_lines += 1
            yield text.decode("cp1252", errors="replace")


def _head(pieces: Iterable[bytes]) -> tuple[bytes, Iterator[bytes]]:
    """Return the beginning of a text, up to a line end if there is one early, and the pieces that follow."""
    following, head = iter(pieces), b""
    for piece in following:
        head += piece
        if (len(head) >= 4 and b"\n" in head[2:]) or len(head) >= _HEAD_BYTES:
            break
    return head, following


def _utf16_name(head: bytes) -> str | None:
    if head[:2] in _UTF16:
        return _UTF16[head[:2]]
    zeros = "".join("0" if byte == 0 else "x" for byte in head[:4])
    return {"x0x0": "utf-16-le", "0x0x": "utf-16-be"}.get(zeros)


def _recoded(pieces: Iterable[bytes], name: str) -> Iterator[bytes]:
    decoder = codecs.getincrementaldecoder(name)()
    try:
        for piece in pieces:
            yield decoder.decode(piece).encode()
        yield decoder.decode(b"", final=True).encode()
    except UnicodeError as error:
        raise BadInput([Fault("", "not_utf16", f"begins as UTF-16, but is not: {error}; save it as UTF-8")]) from error
