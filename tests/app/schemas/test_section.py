"""Sections in a request: what arrives in the engine, and faults that name field, value and rule."""

import copy
from typing import Any

import pytest

from app.convert import read
from app.convert.run import specification
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from app.schemas.section import EXAMPLE

STRING = {"length_m": 1.2, "weight_n": 600.0}


def request(**changes: Any) -> dict[str, Any]:
    line = {**copy.deepcopy(example("c11-twin")), "section": {**copy.deepcopy(EXAMPLE), **changes}}
    return {"line": line}


def faults_of(document: dict[str, Any]) -> list[tuple[str, str]]:
    with pytest.raises(BadInput) as caught:
        read(document)
    return [(fault.pointer, fault.detail) for fault in caught.value.faults]


def test_a_section_arrives_in_the_engine() -> None:
    document = request(
        spans=[
            {"length_m": 150.0, "wind_profile": [{"position_m": 0.0, "factor": 0.7}], "level_difference_m": 2.0},
            {"length_m": 125.88},
            {"length_m": 140.0, "ice": {**example("c11-twin")["ice"], "eccentricity_y_m": 1e-3}},
        ]
    )
    line, _ = specification(read(document), {})
    assert line.section is not None
    first, own, last = line.section.spans
    assert (first.length, first.level_difference, first.profile) == (150.0, 2.0, ((0.0, 0.7),))
    assert (own.length, own.ice) == (125.88, None)
    assert last.ice is not None
    assert last.ice.eccentricity_y == 1e-3
    assert [(s.length, s.weight) for s in line.section.strings] == [(1.2, 600.0)] * 2
    assert line.section.span_of_interest == 2


@pytest.mark.parametrize(
    ("changes", "pointer", "words"),
    [
        ({"strings": EXAMPLE["strings"][:1]}, "/line/section/strings", "one string fewer than spans, which is 2"),
        (
            {"strings": [{"length_m": 1.2, "weight_n": 600.0}, {"length_m": 2.5, "weight_n": 600.0}]},
            "/line/section/strings/1/length_m",
            "larger sag",
        ),
        (
            {"strings": [{"length_m": 1.2, "weight_n": 600.0}, {"length_m": 1.2}]},
            "/line/section/strings/1/weight_n",
            "",
        ),
        ({"span_of_interest": 1}, "/line/section/spans/0/length_m", "that of the line's span (125.88)"),
        ({"span_of_interest": 9}, "/line/section/span_of_interest", "from 1 to 3"),
    ],
)
def test_bad_sections_name_field_and_rule(changes: dict[str, Any], pointer: str, words: str) -> None:
    found = faults_of(request(**changes))
    assert [at for at, _ in found] == [pointer]
    assert words in found[0][1]


def test_unequal_weights_and_ice_beyond_a_span_are_named() -> None:
    ice = example("c11-twin")["ice"]
    heavy = {**ice, "segments": [{"from_m": 0.0, "to_m": 50.0, "mass_kg_per_m": 3.0}]}
    far = {**ice, "segments": [{"from_m": 0.0, "to_m": 500.0, "eccentricity_y_m": 1e-3}]}
    spans = copy.deepcopy(EXAMPLE["spans"])
    spans[0]["ice"] = heavy
    ((pointer, detail),) = faults_of(request(spans=spans))
    assert pointer == "/line/section/spans/0/ice/segments"
    assert "mean mass per length" in detail
    spans[0]["ice"] = far
    ((pointer, detail),) = faults_of(request(spans=spans))
    assert pointer == "/line/section/spans/0/ice/segments/0/to_m"
    assert "must lie on the span" in detail


def test_what_sections_do_not_have_is_refused() -> None:
    document = request()
    document["line"]["wind"] = {"blow_out": {"wind_speed_m_per_s": 10.0, "drag_coefficient": 1.0}}
    document["line"]["supports"] = {"left": {"insulator_length_m": 2.0}}
    assert {pointer for pointer, _ in faults_of(document)} == {"/line/wind/blow_out", "/line/supports"}
    asked = {**request(), "analysis": {"loop_competition": "checked"}}
    assert [pointer for pointer, _ in faults_of(asked)] == ["/analysis/loop_competition"]


def test_a_study_varies_the_strings() -> None:
    axis = {"parameter": "section.strings.0.length_m", "values": [1.0, 1.2]}
    asked = read({**request(), "study": {"axes": [axis]}})
    line, _ = specification(asked, {"section.strings.0.length_m": 1.0})
    assert line.section is not None
    assert [string.length for string in line.section.strings] == [1.0, 1.2]
