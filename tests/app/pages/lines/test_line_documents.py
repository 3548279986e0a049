import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import convert
from app.pages import examples
from app.pages.lines.line_documents import to_document, to_texts
from app.pages.measures import FEET, SI, Units
from app.schemas.faults import BadInput


def request_of(name: str) -> dict[str, Any]:
    return {"line": examples.line(name), "analysis": examples.ANALYSIS}


@pytest.mark.parametrize("units", [SI, FEET], ids=lambda units: units.name)
@pytest.mark.parametrize("name", examples.NAMES)
def test_a_line_goes_through_the_form_and_stays_the_same_line(name: str, units: Units) -> None:
    made = to_document(to_texts(request_of(name), units), units)
    one, other = (convert.resolve_document(line)["line"] for line in (made["line"], examples.line(name)))
    assert one["span"]["length_m"] == pytest.approx(other["span"]["length_m"], rel=1e-6)
    assert one["span"]["horizontal_tension_n"] == pytest.approx(other["span"]["horizontal_tension_n"], rel=1e-5)
    assert one["conductor"]["mass_kg_per_m"] == pytest.approx(other["conductor"]["mass_kg_per_m"], rel=1e-6)
    assert one["ice"]["aerodynamics"] == other["ice"]["aerodynamics"]
    assert made["analysis"] == examples.ANALYSIS if units is SI else made["analysis"]["loops"] == [1, 2]


def test_what_has_no_field_is_kept_beside_the_form() -> None:
    line = {**examples.line(examples.DRAKE), "tags": {"region": "north"}, "section": None}
    texts = to_texts({"line": line}, SI)
    assert json.loads(texts["rest"]) == {"line": {"tags": line["tags"]}}
    assert to_document(texts, SI)["line"]["tags"] == line["tags"]


COEFFICIENTS = examples.line("c11-twin")["ice"]["aerodynamics"]
ROWS: dict[str, Any] = {
    "line": {
        "devices": [
            {"type": "spacer", "position_m": 60.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4},
            {"type": "airflow_spoiler", "from_m": 10.0, "to_m": 20.0, "aerodynamics": COEFFICIENTS},
            {"type": "interphase_spacer", "position_m": 75.0, "mass_kg": 30.0, "between": ["this", "top"]},
        ],
        "phases": [{"name": "top", "y_m": 7.0, "line": {"span": {"length_m": 300.0, "sag_m": 6.0}}}],
        "ice": {"segments": [{"from_m": 0.0, "to_m": 50.0, "mass_kg_per_m": 2.3}]},
        "wind": {"profile": [{"position_m": 0.0, "factor": 0.7}]},
        "climate": {
            "line_azimuth_deg": 45.0,
            "sectors": [{"direction_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}],
            "icing": [{"kind": "glaze", "thickness_m": {"value": 12.0, "unit": "mm"}, "hours_a_year": 40.0}],
        },
        "section": {
            "spans": [{"length_m": 150.0}, {"length_m": 125.88, "level_difference_m": 2.0}],
            "strings": [{"length_m": 4.5, "weight_n": 2500.0}],
        },
    },
    "analysis": {"wind_speeds_m_per_s": [2.0, 4.5]},
}


def test_lists_become_rows_and_are_the_same_lists_again() -> None:
    texts = to_texts(ROWS, SI)
    assert texts["line.devices.1.aerodynamics.vertical.1"] == "-4.0547"
    assert texts["line.devices.2.between.1"] == "top"
    assert texts["analysis.wind_speeds_m_per_s.1"] == "4.5"
    assert json.loads(texts["line.phases.0.rest"]) == {"line": {"span": {"length_m": 300.0, "sag_m": 6.0}}}
    assert texts["rest"] == ""
    assert to_document(texts, SI) == ROWS


def test_rows_in_feet_are_sent_with_their_units_and_come_back() -> None:
    texts = to_texts(ROWS, FEET)
    assert texts["line.devices.0.position_m"] == "196.8504"
    assert texts["line.section.strings.0.weight_n"] == "562.0224"
    made = to_document(texts, FEET)
    assert made["line"]["devices"][0]["mass_kg"] == {"value": 14.33005, "unit": "lb"}
    assert made["analysis"]["wind_speeds_m_per_s"][0]["unit"] == "mph"
    assert made["line"]["devices"][1]["aerodynamics"] == COEFFICIENTS
    assert to_texts(made, FEET) == texts


def test_numbers_that_were_sent_with_units_fill_fields_again() -> None:
    said = {"line": {"span": {"length_m": {"value": 1000.0, "unit": "ft"}}}}
    assert to_texts(said, SI) == {"line.span.length_m": "304.8", "rest": ""}
    wrong = {"line": {"span": {"length_m": {"value": 1000.0, "unit": "kg"}}}}
    assert json.loads(to_texts(wrong, SI)["rest"]) == wrong


@pytest.mark.parametrize(
    "devices",
    [[{"type": "balloon"}], ["spacer"], [{"position_m": 1.0}], "none", [{"type": "spacer"}] * 201, [{"type": ["x"]}]],
)
def test_lists_that_rows_cannot_show_stay_json(devices: Any) -> None:
    request = {"line": {"devices": devices}}
    assert json.loads(to_texts(request, SI)["rest"]) == request


def test_what_a_row_says_wrongly_is_kept_for_the_schema_to_refuse() -> None:
    texts = {
        "line.devices.0.type": "balloon",
        "line.devices.1.type": "interphase_spacer",
        "line.devices.1.between.1": "top",
        "line.devices.1.mass_kg": "heavy",
        "analysis.wind_speeds_m_per_s.0": "",
    }
    made = to_document(texts, SI)
    assert made["line"]["devices"][0] == {"type": "balloon"}
    assert made["line"]["devices"][1] == {"type": "interphase_spacer", "mass_kg": "heavy", "between": ["", "top"]}
    assert made["analysis"]["wind_speeds_m_per_s"] == [""]


@pytest.mark.parametrize(
    ("texts", "pointer"),
    [
        ({"rest": '{"line": {"devices": [{}]}}', "line.devices.0.type": "spacer"}, "/rest"),
        (
            {"analysis.wind_speeds_m_per_s.0": "4", "analysis.wind_speeds_m_per_s.start": "2"},
            "/analysis/wind_speeds_m_per_s/start",
        ),
        ({"line.phases.0.rest": "[]"}, "/line/phases/0/rest"),
        ({"line.phases.0.rest": "{"}, "/line/phases/0/rest"),
    ],
)
def test_what_is_said_twice_or_is_no_json_is_refused(texts: dict[str, str], pointer: str) -> None:
    with pytest.raises(BadInput) as raised:
        to_document(texts, SI)
    assert raised.value.faults[0].pointer == pointer


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("300", 300.0),
        ("1,5", 1.5),
        ("1 000", 1000.0),
        ("\N{MINUS SIGN}5", -5.0),
        ("abc", "abc"),
        ("1,000.5", "1,000.5"),
    ],
)
def test_numbers_are_read_as_people_write_them(text: str, value: object) -> None:
    assert to_document({"line.span.length_m": text}, SI)["line"]["span"]["length_m"] == value


def test_numbers_in_other_units_are_sent_with_their_unit() -> None:
    made = to_document({"line.span.length_m": "1000", "line.bundle.subconductors": "2"}, FEET)
    assert made["line"]["span"]["length_m"] == {"value": 1000.0, "unit": "ft"}
    assert made["line"]["bundle"]["subconductors"] == 2
    small = to_document({"line.ice.accretion.thickness_m": "12"}, SI)["line"]["ice"]["accretion"]
    assert small["thickness_m"] == {"value": 12.0, "unit": "mm"}


@pytest.mark.parametrize("text", ["{", "[1]", '{"a": 1, "a": 2}'])
def test_what_is_kept_must_be_an_object(text: str) -> None:
    with pytest.raises(BadInput) as raised:
        to_document({"rest": text}, SI)
    assert raised.value.faults[0].pointer.startswith("/rest")


@pytest.mark.parametrize(
    "request_document",
    [
        {"line": {"wind": {"blow_out": {}, "profile": [{"position_m": 0.0, "factor": 0.7}]}}},
        {"analysis": {"finite_element_loops": [], "wind_speeds_m_per_s": [4.0]}, "line": {}},
        {"line": {"section": {"spans": [{"length_m": 150.0, "wind_profile": []}], "span_of_interest": 1}}},
        {"line": {"devices": [{"type": "airflow_spoiler", "aerodynamics": {"vertical": [1.0, "x", 3.0]}}]}},
        {"line": {"devices": [{"type": "airflow_spoiler", "aerodynamics": {"vertical": [1.0, 2.0]}}]}},
        {"line": {"devices": [{"type": "spacer", "colour": {"is": "red"}}], "phases": [{}]}},
    ],
)
def test_what_is_empty_or_wrong_is_not_lost(request_document: dict[str, Any]) -> None:
    assert to_document(to_texts(request_document, SI), SI) == request_document


def test_parts_that_are_in_fields_leave_nothing_behind() -> None:
    request = {"line": {"wind": {"yaw_deg": 10.0, "profile": []}, "name": "A", "span": {"sag_m": None}}}
    assert json.loads(to_texts(request, SI)["rest"]) == {"line": {"span": {}}}
    assert to_texts({"line": {"ice": {"accretion": {"shape": "crescent"}}}}, SI)["rest"] == ""


KNOWN = st.sampled_from(
    ["line", "devices", "type", "spacer", "position_m", "between", "phases", "ice", "wind_speeds_m_per_s"]
)
JSON_VALUES = st.recursive(
    st.floats(-1e3, 1e3).map(lambda number: round(number, 3)) | st.sampled_from(["spacer", "x"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KNOWN, inner, max_size=4),
    max_leaves=12,
)


@given(line=st.dictionaries(KNOWN, JSON_VALUES, max_size=5), analysis=st.dictionaries(KNOWN, JSON_VALUES, max_size=3))
def test_no_document_loses_anything_in_the_form(line: dict[str, Any], analysis: dict[str, Any]) -> None:
    request = {"line": line, "analysis": analysis}
    made = to_document(to_texts(request, SI), SI)
    for part, said in request.items():
        assert made.get(part, {}) == {
            name: value for name, value in said.items() if value != [] or name in made.get(part, {})
        }


TABLE = {
    "table": [{"angle_deg": 10.0 * n, "lift": n / 10.0, "drag": 1.0, "moment": -0.1} for n in range(5)],
    "static_angle_deg": 20.0,
    "half_range_deg": 20.0,
}
DIAMETERS = {"si": {"value": 28.6, "unit": "mm"}, "feet": {"value": 1.125984, "unit": "in"}}


@pytest.mark.parametrize("aerodynamics", [COEFFICIENTS, TABLE], ids=["cubics", "table"])
@pytest.mark.parametrize("units", [SI, FEET], ids=lambda units: units.name)
def test_own_coefficients_have_fields_and_come_back(aerodynamics: dict[str, Any], units: Units) -> None:
    at_rest = {"vertical": 0.3, "horizontal": 1.2, "torsional": 0.0}
    said = {"aerodynamics": {**aerodynamics, "reference_diameter_m": 0.0286}, "aerodynamics_at_rest": at_rest}
    texts = to_texts({"line": {"ice": said}}, units)
    assert (texts["rest"], texts["line.ice.aerodynamics_at_rest.horizontal"]) == ("", "1.2")
    expected = {**said, "aerodynamics": {**aerodynamics, "reference_diameter_m": DIAMETERS[units.name]}}
    assert to_document(texts, units)["line"]["ice"] == expected


def test_a_table_too_long_for_rows_stays_json() -> None:
    long = {"line": {"ice": {"aerodynamics": {"table": [{"angle_deg": 0.1 * n} for n in range(1001)]}}}}
    texts = to_texts(long, SI)
    assert json.loads(texts["rest"]) == long
    assert not any(name.startswith("line.ice") for name in texts)
