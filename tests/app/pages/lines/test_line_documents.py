import json
from typing import Any

import pytest

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
    line = {**examples.line(examples.DRAKE), "phases": [{"name": "top", "y_m": 7.0, "z_m": 0.0}], "climate": None}
    texts = to_texts({"line": line}, SI)
    assert json.loads(texts["rest"]) == {"line": {"phases": line["phases"]}}
    assert to_document(texts, SI)["line"]["phases"] == line["phases"]


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
