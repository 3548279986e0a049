"""Cut the text of a JSON document into its members and the items of a list, such as the features of GeoJSON.

Libraries that parse JSON as a stream stop at the first text that is not JSON. Here only the brackets are followed, and
each item is parsed by itself, so that a bad one spoils no other, and no text is held or parsed in one piece.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from app.schemas.faults import BadInput, BodyTooLarge, Fault, json_pointer, parse_json

_SPACE = re.compile(rb"[ \t\r\n]*")
# A whole text in quotation marks, a bracket, or the mark with which an unfinished text begins.
_MARK = re.compile(rb'"(?:[^"\\]++|\\.)*+"|[{}\[\]]|"', re.DOTALL)
_DEEPEST_AT_ONCE = 8  # levels of brackets; a line has five


def _nested(levels: int) -> bytes:
    """Return the pattern of a whole object or list with so many levels of others in it."""
    inner = rb'[^"{}\[\]]++|"(?:[^"\\]++|\\.)*+"' + (b"|" + _nested(levels - 1) if levels else b"")
    return rb"[{\[](?:" + inner + rb")*+[}\]]"


_WHOLE = re.compile(_nested(_DEEPEST_AT_ONCE), re.DOTALL)
_PLAIN = re.compile(rb'[^\s,:\[\]{}"]*')
_OPENING = b"{["
_GATHERED_BYTES = 65_536
_MOST_MEMBERS = 100


@dataclass(slots=True)
class FeatureTexts:
    """The members of a document before its features, or another list, and the text of each feature.

    members grows by what stands behind the features when the last one is taken. whole tells that the document has no
    features, and its members are everything.
    """

    members: dict[str, bytes]
    texts: Iterator[bytes]
    whole: bool = False


def cut_features(pieces: Iterable[bytes], most_bytes: int, listed: str = "features") -> FeatureTexts:
    """Cut a document up to its features, or another list of it; they are cut while they are taken.

    Parameters
    ----------
    pieces : iterable of bytes
        The text in UTF-8.
    most_bytes : int
        Longest feature, and longest text of everything beside them.
    listed : str
        Name of the list.

    Raises
    ------
    BadInput
        If the text is no JSON object, or has too many members; while the features are taken, if it is none further on.
    BodyTooLarge
        If a part is longer than the bound.
    """
    text = _Text(iter(pieces), most_bytes, listed)
    if text.peek() != b"{":
        raise _invalid("must be a JSON object")
    text.at += 1
    members: dict[str, bytes] = {}
    if _members(text, members):
        return FeatureTexts(members, _features(text, members))
    return FeatureTexts(members, iter(()), whole=True)


def _members(text: "_Text", members: dict[str, bytes]) -> bool:
    """Read members; tell whether it stopped in front of the list of features instead of at the end of the object."""
    size = 0
    while True:
        if text.peek() == b"}" and not members:
            break
        name = _name(text)
        if name == text.listed and text.peek() == b"[":
            if name in members:
                raise _repeated(name)
            members[name] = b"[]"
            text.at += 1
            return True
        if name in members:
            raise _repeated(name)
        members[name] = text.value()
        size += len(members[name])
        if size > text.most_bytes:
            raise BodyTooLarge(f"The members beside {text.listed} are longer than {text.most_bytes} bytes.")
        if len(members) > _MOST_MEMBERS:
            rule = f"may have at most {_MOST_MEMBERS} members beside {text.listed}, got {name[:50]!r} beyond them"
            raise BadInput([Fault("", "too_many", rule)])
        if text.peek() != b",":
            break
        text.at += 1
    _end(text)
    return False


def _name(text: "_Text") -> str:
    if text.peek() != b'"':
        raise _invalid("expected the name of a member")
    name = parse_json(text.value())
    if text.peek() != b":":
        raise _invalid(f"expected a colon behind {str(name)[:50]!r}")
    text.at += 1
    return str(name)


def _features(text: "_Text", members: dict[str, bytes]) -> Iterator[bytes]:
    number, item = 0, text.listed.removesuffix("s")
    if text.peek() != b"]":
        while True:
            number += 1
            yield text.value(f"{item} {number}: ")
            if text.peek() != b",":
                break
            text.at += 1
    if text.peek() != b"]":
        raise _invalid(f"expected a comma or the end of the list behind {item} {number}")
    text.at += 1
    if text.peek() == b",":
        text.at += 1
        if _members(text, members):
            raise _repeated(text.listed)
    else:
        _end(text)


def _end(text: "_Text") -> None:
    if text.peek() != b"}":
        raise _invalid("expected a comma or the end of the object")
    text.at += 1
    if text.peek():
        raise _invalid("something follows the end of the object")


def _invalid(detail: str) -> BadInput:
    return BadInput([Fault("", "json_invalid", f"not valid JSON: {detail}")])


def _repeated(name: str) -> BadInput:
    return BadInput([Fault(json_pointer([name]), "repeated_name", "appears more than once in its object")])


@dataclass(slots=True)
class _Text:
    """A text that is still arriving: what has arrived and is not used up, and the place of the next value in it."""

    pieces: Iterator[bytes]
    most_bytes: int
    listed: str
    buffer: bytes = b""
    at: int = 0
    is_complete: bool = field(default=False)

    def peek(self) -> bytes:
        """Go to the next byte that is no space and return it; nothing at the end of the text."""
        while True:
            found = _SPACE.match(self.buffer, self.at)
            self.at = found.end() if found else self.at
            if self.at < len(self.buffer):
                return self.buffer[self.at : self.at + 1]
            if not self.more():
                return b""

    def more(self) -> bool:
        """Take further pieces, many at once, so that a text in tiny pieces is not searched again for each."""
        if self.is_complete:
            return False
        parts, size = [self.buffer[self.at :]], 0
        self.at = 0
        for piece in self.pieces:
            parts.append(piece)
            size += len(piece)
            if size >= _GATHERED_BYTES:
                break
        else:
            self.is_complete = True
        self.buffer = b"".join(parts)
        return size > 0

    def value(self, place: str = "") -> bytes:
        """Return the text of the next value and go behind it; its brackets match in number, nothing else is checked."""
        first = self.peek()
        if first not in (b"{", b"[", b'"'):
            return self._plain(place)
        whole = _WHOLE.match(self.buffer, self.at)
        if whole is not None:  # most are not deep and have arrived; one search for each bracket and text costs more
            return self._taken(whole.end() - self.at)
        scanned, depth = 0, 0
        while True:
            mark = _MARK.search(self.buffer, self.at + scanned)
            if mark is None or mark[0] == b'"':
                scanned = (len(self.buffer) if mark is None else mark.start()) - self.at
                self._grow(place)
                continue
            scanned = mark.end() - self.at
            if not mark[0].startswith(b'"'):
                depth += 1 if mark[0] in _OPENING else -1
            if depth <= 0:
                return self._taken(scanned)

    def _plain(self, place: str) -> bytes:
        while True:
            found = _PLAIN.match(self.buffer, self.at)
            length = found.end() - self.at if found else 0
            if self.at + length < len(self.buffer) or self.is_complete:
                if not length:
                    raise _invalid(f"{place}expected a value")
                return self._taken(length)
            self._grow(place)

    def _grow(self, place: str) -> None:
        if len(self.buffer) - self.at > self.most_bytes:
            raise BodyTooLarge(
                f"One of the {self.listed}, or a member beside them, is longer than {self.most_bytes} bytes."
            )
        if not self.more() and self.is_complete:
            raise _invalid(f"{place}the text ends within a value")

    def _taken(self, length: int) -> bytes:
        taken = self.buffer[self.at : self.at + length]
        self.at += length
        return taken
