import csv
import io
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.export.formats import csv_text, in_blocks, json_text, preferred_format, result_text

SINGLE: dict[str, Any] = {"line": {"name": "x"}, "analysis": {"harmonics": 5}}
STUDY: dict[str, Any] = {**SINGLE, "study": {"axes": []}}
POINT: dict[str, Any] = {
    "axes": {},
    "static": {"sag_m": 1.5},
    "den_hartog": {"coefficient": -0.2, "unstable": True},
    "warnings": ["w"],
    "engine_version": "1",
    "failure": None,
}


@pytest.mark.parametrize(
    ("accept", "expected"),
    [
        ("", "json"),
        ("*/*", "json"),
        ("application/json", "json"),
        ("text/csv", "csv"),
        ("text/*", "csv"),
        ("TEXT/CSV; charset=utf-8", "csv"),
        ("application/json;q=0.5, text/csv;q=0.9", "csv"),
        ("text/csv;q=0.1, */*;q=0.5", "json"),
        ("text/html,application/xhtml+xml,*/*;q=0.8", "json"),
        ("*/*, application/json;q=0", "csv"),
        ("text/html", None),
        ("text/csv;q=0", None),
        ("text/csv;q=many", None),
        ("text/csv;q=nan", None),
        (";;;,,,", None),
    ],
)
def test_the_accept_header_chooses_the_format(accept: str, expected: str | None) -> None:
    assert preferred_format(accept) == expected


def test_csv_has_a_header_even_without_rows() -> None:
    assert "".join(csv_text(["a", "b"], [])) == "a,b\r\n"


def test_csv_rows_follow_the_columns_and_leave_nothing_for_null() -> None:
    rows: list[dict[str, Any]] = [{"b": 1.25, "a": "x"}, {"a": None, "b": -2}]
    assert "".join(csv_text(["a", "b"], rows)) == "a,b\r\nx,1.25\r\n,-2\r\n"


@given(st.text(max_size=20), st.text(min_size=1, max_size=20))
def test_no_text_passes_for_a_formula(value: str, column: str) -> None:
    text = "".join(csv_text([column], [{column: value}]))
    for cell in (cell for row in csv.reader(io.StringIO(text, newline="")) for cell in row):
        assert not cell.startswith(tuple("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20"))


@pytest.mark.parametrize("value", ["=1+1", "+1", "-1", "@A1", "\t=1", "\r=1", "\n=1", "\uff1d1+1"])
def test_text_that_looks_like_a_formula_gets_an_apostrophe(value: str) -> None:
    rows = list(csv.reader(io.StringIO("".join(csv_text(["a"], [{"a": value}])), newline="")))
    assert rows[1] == ["'" + value]


def test_numbers_are_left_alone_by_the_guard() -> None:
    assert "".join(csv_text(["a"], [{"a": -1.5}])) == "a\r\n-1.5\r\n"


def test_excel_gets_a_mark_and_its_commas() -> None:
    rows: list[dict[str, Any]] = [{"a": "1.5", "b": -1.5}, {"a": "=x;y", "b": 1e-05}, {"a": True, "b": None}]
    assert "".join(csv_text(["a", "b"], rows[:1], "excel")) == "\ufeffa,b\r\n1.5,-1.5\r\n"
    european = "".join(csv_text(["a", "b"], rows, "excel_semicolon"))
    assert european == '\ufeffa;b\r\n1.5;-1,5\r\n"\'=x;y";1e-05\r\nTrue;\r\n'


@given(
    st.lists(
        st.dictionaries(st.text(max_size=5), st.integers(-(2**53), 2**53) | st.text(max_size=5) | st.none(), max_size=3)
    )
)
def test_a_table_as_json_is_what_went_in(rows: list[dict[str, Any]]) -> None:
    assert json.loads("".join(json_text("t", rows))) == {"t": rows}


@given(st.lists(st.text()))
def test_blocks_hold_the_same_text(pieces: list[str]) -> None:
    assert "".join(in_blocks(pieces)) == "".join(pieces)
    assert b"".join(in_blocks(piece.encode() for piece in pieces)) == "".join(pieces).encode()


def test_blocks_are_large_but_bounded() -> None:
    blocks = list(in_blocks("x" * 100 for _ in range(10_000)))
    assert len(blocks) < 10
    assert max(map(len, blocks)) < 140_000


def test_a_result_without_study_has_single_objects() -> None:
    document = json.loads("".join(result_text(SINGLE, [POINT], {"frequencies": [{"loops": 1}]})))
    assert document == {
        "input": SINGLE,
        "static": {"sag_m": 1.5},
        "den_hartog": {"coefficient": -0.2, "unstable": True},
        "frequencies": [{"loops": 1}],
        "warnings": ["w"],
        "failures": [],
        "failure": None,
        "engine_version": "1",
    }


def test_a_study_has_a_row_for_each_point_and_its_failures() -> None:
    points = [
        {**POINT, "axes": {"span.sag_m": 1.0}},
        {**POINT, "axes": {"span.sag_m": 2.0}, "static": None, "den_hartog": None, "failure": "why", "warnings": []},
    ]
    document = json.loads("".join(result_text(STUDY, points, {})))
    assert document["static"] == [{"span.sag_m": 1.0, "sag_m": 1.5}]
    assert document["failures"] == [{"span.sag_m": 2.0, "failure": "why"}]


def test_a_chunk_of_a_batch_has_a_row_for_each_of_its_lines() -> None:
    assert json.loads("".join(result_text({"batch_id": "b", "part": 0}, [POINT], {})))["static"] == [{"sag_m": 1.5}]


def test_a_result_without_points_is_whole() -> None:
    failure = {"kind": "worker_lost", "detail": "gone"}
    document = json.loads("".join(result_text(SINGLE, [], {"frequencies": []}, failure)))
    assert document["static"] is None
    assert document["failure"] == failure
    assert document["engine_version"] is None
