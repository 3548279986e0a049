import math
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from app import schemas
from app.schemas.faults import BadInput, faults_of, json_pointer, parse_json
from tests.app.lines import FULL_LINE, changed


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


def test_names_that_stand_twice_are_named_wherever_they_are() -> None:
    raw = b'{"a": [{"b": {"c/d": 1, "e": 1e400, "c/d": NaN}}, {"b": 1}], "a": ' + b"9" * 1000 + b', "\\u0061": 0}'
    with pytest.raises(BadInput) as caught:
        parse_json(raw)
    assert [fault.pointer for fault in caught.value.faults] == ["/a/0/b/c~1d", "/a", "/a"]
    assert {fault.code for fault in caught.value.faults} == {"repeated_name"}


def test_pointers_escape_and_cut_what_strangers_wrote() -> None:
    assert json_pointer(["line", "a/b~c", 3]) == "/line/a~1b~0c/3"
    assert json_pointer([]) == ""
    assert json_pointer(["x" * 10_000]) == "/" + "x" * 200


@pytest.mark.parametrize(
    ("path", "value", "end"),
    [
        ("span.length_m", -1.5, "greater than or equal to 1, got -1.5"),
        ("span.length_m", "126", 'should be a valid number, got "126"'),
        ("span.length_m", math.nan, "should be a finite number, got NaN"),
        ("span.length_m", True, "should be a valid number, got true"),
        ("span.length_m", None, "should be a valid number, got null"),
        ("damping.model", "ö" * 100, ', got "' + "ö" * 79),
        (
            "devices.0.type",
            "anchor",
            'airflow_spoiler, torsional_damper or interphase_spacer, got "anchor"',
        ),
        ("conductor.colour", "red", "unknown field"),
        ("conductor", [1.0], "must be an object"),
        ("conductor", {}, "field required"),
    ],
)
def test_a_fault_says_what_was_found(path: str, value: Any, end: str) -> None:
    assert details(changed(path, value))[0].endswith(end)


def test_a_name_that_is_at_fault_is_pointed_to_and_so_is_a_value_under_a_strange_one() -> None:
    tags = {"region:north": "yes", "[key]": "a\nb"}
    with pytest.raises(ValidationError) as caught:
        schemas.Line.model_validate(changed("tags", tags))
    assert {fault.pointer for fault in faults_of(caught.value.errors())} == {"/tags/region:north", "/tags/[key]"}


def test_a_number_too_long_to_be_written_is_not_written() -> None:
    span = {**FULL_LINE["span"], "elements": 10**4999}
    assert details({**FULL_LINE, "span": span}) == [
        "input should be less than or equal to 100, got a whole number of more than 80 digits"
    ]


def details(line: dict[str, Any]) -> list[str]:
    with pytest.raises(ValidationError) as caught:
        schemas.Line.model_validate(line)
    return [fault.detail for fault in faults_of(caught.value.errors(include_url=False), root="/line")]


@pytest.mark.parametrize("name", ["utf8_bom", "powershell_utf16"])
def test_json_as_windows_programs_save_it_is_read(name: str) -> None:
    raw = (Path(__file__).parents[1] / "sheets" / "cases" / f"{name}.json").read_bytes()
    assert not raw.startswith(b"{")
    assert parse_json(raw)["conductor"]["diameter_m"] == 0.0286


def test_utf16_without_a_mark_is_named() -> None:
    with pytest.raises(BadInput, match="save it as UTF-8") as caught:
        parse_json('{"a": 1}'.encode("utf-16-le"))
    assert caught.value.faults[0].code == "json_invalid"
