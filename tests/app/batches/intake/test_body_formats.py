import gzip
import json
import tracemalloc
from collections.abc import Iterator
from contextlib import closing
from itertools import chain

import pytest

from app.batches.intake import BodyTooLarge, gunzipped, read_json, read_ndjson
from app.schemas.faults import BadInput


def pieces(body: bytes, size: int) -> Iterator[bytes]:
    for first in range(0, len(body), size):
        yield body[first : first + size]


def codes(error: pytest.ExceptionInfo[BadInput]) -> list[tuple[str, str]]:
    return [(fault.pointer, fault.code) for fault in error.value.faults]


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_ndjson_is_the_same_however_it_is_cut(size: int) -> None:
    body = b'{"analysis": {"loops": [1]}}\n{"n": 1}\r\n\n{"n": "\xc3\xa4"}\n{"n": 3}'
    incoming = read_ndjson(pieces(body, size), 100)
    assert incoming.analysis == {"loops": [1]}
    assert list(incoming.lines) == [{"n": 1}, {"n": "ä"}, {"n": 3}]


def test_ndjson_may_begin_with_a_mark_or_be_utf16() -> None:
    text = '{"analysis": {"loops": [1]}}\n{"n": "ä"}\n'
    for encoding in ("utf-8-sig", "utf-16"):
        incoming = read_ndjson(pieces(text.encode(encoding), 5), 100)
        assert (incoming.analysis, list(incoming.lines)) == ({"loops": [1]}, [{"n": "ä"}])


def test_ndjson_needs_its_analysis_first() -> None:
    for body in (b"", b'{"n": 1}\n', b"[1]\n", b'{"analysis": {}, "webhook": "http://x"}\n'):
        with pytest.raises(BadInput) as caught:
            read_ndjson([body], 100)
        assert codes(caught) == [("", "missing")]


def test_a_line_that_is_no_json_is_told_of_in_its_place() -> None:
    first, second, third = read_ndjson([b'{"analysis": {}}\n{"a": 1}\n{"a": \n{"a": 3}\n'], 100).lines
    assert (first, third) == ({"a": 1}, {"a": 3})
    assert isinstance(second, BadInput)


def test_a_text_line_without_end_is_refused_early() -> None:
    taken = []

    def endless() -> Iterator[bytes]:
        yield b'{"analysis": {}}\n'
        for number in range(1000):
            taken.append(number)
            yield b"x" * 100

    with pytest.raises(BodyTooLarge, match="1000 bytes"):
        list(read_ndjson(endless(), 1000).lines)
    assert len(taken) == 11


@pytest.mark.parametrize("size", [1, 13, 10_000])
def test_gzip_comes_out_as_it_went_in(size: int) -> None:
    text = json.dumps(list(range(3000))).encode()
    body = gzip.compress(text[:5000]) + gzip.compress(text[5000:])
    assert b"".join(gunzipped(pieces(body, size), 100_000)) == text


def test_a_bomb_is_noticed_before_it_takes_memory() -> None:
    bomb = gzip.compress(b"\0" * 50_000_000)
    assert len(bomb) < 100_000
    out = 0
    with pytest.raises(BodyTooLarge, match="1000000 bytes"):
        for part in gunzipped([bomb], 1_000_000):
            out += len(part)
            assert len(part) <= 1 << 18
    assert out <= 1_000_000


def test_broken_gzip_is_the_senders_fault() -> None:
    for body in (b"no gzip", gzip.compress(b"cut" * 1000)[:-9]):
        with pytest.raises(BadInput) as caught:
            list(gunzipped([body], 10_000))
        assert codes(caught) == [("", "gzip_invalid")]


def test_json_is_looked_through_and_names_every_fault() -> None:
    with closing(read_json([b'{"lines": [1, {"a"', b': 2}], "analysis": {"b": 3}}'], 100)) as incoming:
        assert (incoming.analysis, list(incoming.lines)) == ({"b": 3}, [1, {"a": 2}])
    with pytest.raises(BadInput) as caught:
        read_json([b'{"webhook": "http://x", "lines": {}}'], 100)
    assert codes(caught) == [("/webhook", "unknown_field"), ("/lines", "list_type")]
    with pytest.raises(BodyTooLarge, match="NDJSON"):
        read_json([b"x" * 101], 100)


@pytest.mark.parametrize(
    ("body", "code"),
    [
        (b"", "json_invalid"),
        (b"nonsense", "json_invalid"),
        (b"[1]", "not_an_object"),
        (b' [{"span": 1, "ice": 2}]', "missing_wrapper"),
        (b'{"span": 1, "ice": 2}', "missing_wrapper"),
        (b'{"lines": [1], "lines": [2]}', "repeated_name"),
        (b'{"lines": [1,]}', "json_invalid"),
        (b'{"lines": [1]} 2', "json_invalid"),
    ],
)
def test_what_is_no_json_batch_is_named(body: bytes, code: str) -> None:
    with pytest.raises(BadInput) as caught:
        read_json([body], 1000)
    assert [found for _, found in codes(caught)] == [code]


def test_one_line_that_is_no_json_spoils_no_other() -> None:
    with closing(read_json([b'{"lines": [1, {"a": nonsense}, {"b": 1, "b": 2}, 3]}'], 1000)) as incoming:
        first, second, third, fourth = incoming.lines
    assert (first, fourth) == (1, 3)
    assert isinstance(second, BadInput) and second.faults[0].code == "json_invalid"
    assert isinstance(third, BadInput) and third.faults[0].code == "repeated_name"


def test_json_is_not_held_as_values_all_at_once() -> None:
    line = b'{"a": [%b]}' % b",".join(b"%d" % number for number in range(1000, 2000))
    pieces = chain([b'{"lines": [', line], (b"," + line for _ in range(1500)), [b"]}"])
    tracemalloc.start()
    try:
        with closing(read_json(pieces, 10_000_000)) as incoming:
            assert sum(len(document["a"]) for document in incoming.lines if isinstance(document, dict)) == 1_501_000
        assert tracemalloc.get_traced_memory()[1] < 15_000_000
    finally:
        tracemalloc.stop()
