import json
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.exchange.feature_texts import cut_features
from app.schemas.faults import BadInput, BodyTooLarge

JSON = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.text(alphabet='ab"\\{}[],:é\n'),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(alphabet='c"{', max_size=2), inner, max_size=3),
    max_leaves=8,
)


def pieces(body: bytes, size: int) -> Iterator[bytes]:
    for first in range(0, len(body), size):
        yield body[first : first + size]


def detail(body: bytes) -> str:
    with pytest.raises(BadInput) as caught:
        list(cut_features([body], 1000).texts)
    return caught.value.faults[0].detail


@given(st.lists(JSON, max_size=4), JSON, JSON, st.sampled_from([1, 7, 1000]), st.sampled_from([None, 1]))
def test_any_document_is_cut_however_it_arrives(
    features: list[Any], before: Any, behind: Any, size: int, indent: int | None
) -> None:
    body = json.dumps({"a{": before, "features": features, "b": behind}, indent=indent).encode()
    cut = cut_features(pieces(body, size), 10_000)
    assert list(cut.members) == ["a{", "features"]
    assert [json.loads(text) for text in cut.texts] == features
    assert json.loads(cut.members["b"]) == behind and json.loads(cut.members["a{"]) == before


@pytest.mark.parametrize("size", [1, 7, 100, 10_000])
def test_deep_features_are_cut_like_flat_ones(size: int) -> None:
    features = [json.loads("[" * depth + '{"a]": "[{"}, 1' + "]" * depth) for depth in range(1, 16)] * 3
    body = json.dumps({"features": features, "b": features[-1]}).encode()
    cut = cut_features(pieces(body, size), 10_000)
    assert [json.loads(text) for text in cut.texts] == features
    assert json.loads(cut.members["b"]) == features[-1]


def test_a_document_without_features_is_whole() -> None:
    cut = cut_features([b' {"type": "Feature", "id": 1} '], 100)
    assert (cut.whole, cut.members, list(cut.texts)) == (True, {"type": b'"Feature"', "id": b"1"}, [])
    assert cut_features([b"{}"], 100).whole


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (b"", "JSON object"),
        (b"[1]", "JSON object"),
        (b'{"features": [1, 2', "behind feature 2"),
        (b'{"features": [{"a": "b}]}', "feature 1: the text ends within a value"),
        (b'{"features": [1 2]}', "behind feature 1"),
        (b'{"features": [1, ]}', "feature 2: expected a value"),
        (b'{"features": [1]', "end of the object"),
        (b'{"features": [1]} x', "something follows"),
        (b'{"features": [1], }', "name of a member"),
        (b'{"features" [1]}', "colon"),
        (b'{"a": 1, "a": 2}', "more than once"),
        (b'{"features": [], "features": []}', "more than once"),
        (b"{a: 1}", "name of a member"),
    ],
)
def test_what_is_no_json_is_told_of(body: bytes, words: str) -> None:
    assert words in detail(body)


def test_what_is_too_long_is_refused_before_it_is_read() -> None:
    taken = []

    def endless(begin: bytes, filling: bytes) -> Iterator[bytes]:
        yield begin
        for number in range(100_000):
            taken.append(number)
            yield filling * 2000

    for begin, filling in (
        (b'{"features": [{"a": [', b'"x", '),
        (b'{"a": [', b'"x", '),
        (b'{"features": [], "a": [', b'"x", '),
        (b'{"a": "', b"text "),
        (b'{"a": 1', b"11111"),
    ):
        taken.clear()
        with pytest.raises(BodyTooLarge, match="100000 bytes"):
            list(cut_features(endless(begin, filling), 100_000).texts)
        assert len(taken) < 30
    many = b"{" + b",".join(b'"%d": 1' % i for i in range(1000)) + b"}"
    with pytest.raises(BadInput, match="at most 100 members"):
        cut_features([many], 100_000)
