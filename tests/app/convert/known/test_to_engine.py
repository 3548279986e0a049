from dataclasses import replace
from typing import Any

import pytest

from app import convert
from app.reference.conductors import named
from app.schemas.faults import BadInput
from tests.app.known_documents import CONTRACT, LINES, changed

(DRAKE,) = named("795 kcmil 26/7")


def faults(document: dict[str, Any], own: convert.OwnRows | None = None) -> dict[str, str]:
    with pytest.raises(BadInput) as caught:
        convert.resolve_document(document, own or convert.OwnRows())
    return {fault.pointer: fault.detail for fault in caught.value.faults}


def test_an_own_conductor_comes_before_the_shipped_one() -> None:
    own = convert.OwnRows(conductors=[replace(DRAKE, diameter_m=0.029, source="own row", own=True)])
    line = convert.resolve_document(CONTRACT, own)["line"]
    assert line["conductor"]["diameter_m"] == 0.029


def test_what_is_said_overrides_the_row() -> None:
    said = changed(conductor={"catalogue": "Drake", "youngs_modulus_pa": 74e9})
    line = convert.resolve_document(said)["line"]
    assert line["conductor"]["axial_rigidity_n"] == pytest.approx(74e9 * 0.7264 * 0.0254**2, rel=1e-4)


def test_an_own_table_lends_its_coefficients_at_any_angle() -> None:
    form = LINES["not in a catalogue, with a table"]["ice"]["aerodynamics"]
    measured = {key: form[key] for key in ("table", "static_angle_deg", "half_range_deg")}
    own = convert.OwnRows(tables={"Our D": {"name": "Our D", **measured, "reference_diameter_m": 0.05}})
    ice = {**CONTRACT["ice"], "aerodynamics": {"catalogue": "our d", "angle_deg": 50.0}}
    resolved = convert.resolve_document(changed(ice=ice), own)
    table = resolved["line"]["ice"]["aerodynamics"]
    assert table["static_angle_deg"] == pytest.approx(50.0)
    # Forces over the bare diameter: the coefficients over 50 mm times 50/28.14.
    assert table["table"][0]["lift"] == pytest.approx(0.1 * 0.05 / DRAKE.diameter_m)
    assert table["table"][8]["moment"] == pytest.approx(-0.16 * (0.05 / DRAKE.diameter_m) ** 2)


@pytest.mark.parametrize(
    ("parts", "pointer", "words"),
    [
        ({"conductor": {"catalogue": "Drak"}}, "/conductor/catalogue", "near are Drake"),
        ({"conductor": {"catalogue": "50/8"}}, "/conductor/catalogue", "48-AL1/8-ST1A, 48-AL3/8-ST1A"),
        ({"conductor": {"diameter_m": 0.028}}, "/conductor/bare_mass_kg_per_m", "must be given, or a conductor"),
        ({"conductor": {"catalogue": "Drake", "mass_kg_per_m": 2.3}}, "/conductor/mass_kg_per_m", "must be absent"),
        ({"ice": {**CONTRACT["ice"], "aerodynamics": {"catalogue": "c11-41"}}}, "/ice/aerodynamics/catalogue", "near"),
        (
            {"ice": {**CONTRACT["ice"], "aerodynamics": {"catalogue": "c11-40", "angle_deg": 50.0}}},
            "/ice/aerodynamics/angle_deg",
            "must be absent or 40",
        ),
        ({"bundle": {"subconductors": 3, "spacing_m": 0.4, "arrangement": "horizontal"}}, "/bundle/arrangement", "fit"),
        (
            {"span": {"length_m": 300.0, "everyday": {"share_of_rated_strength": 20.0}}},
            "/span/everyday/share_of_rated_strength",
            "20 % is 0.2",
        ),
        (
            {"span": {"length_m": 300.0, "everyday": {"horizontal_tension_n": 150e3}}},
            "/span/everyday/horizontal_tension_n",
            "strength",
        ),
        (
            {"ice": {**CONTRACT["ice"], "accretion": {"shape": "crescent", "thickness_m": 0.01, "mass_kg_per_m": 1.0}}},
            "/ice/accretion",
            "exactly one of thickness and mass",
        ),
        ({"span": {"length_m": 300.0, "tension_n": 28e3}}, "/span/tension_n", "did you mean horizontal_tension_n?"),
        ({"ice": {**CONTRACT["ice"], "thickness_mm": 12}}, "/ice/thickness_mm", "/line/ice/accretion/thickness_m"),
        ({"line": CONTRACT}, "/line", "is a line already"),
    ],
)
def test_a_fault_names_the_field_the_value_and_the_rule(parts: dict[str, Any], pointer: str, words: str) -> None:
    assert words in faults(changed(**parts))[pointer]


def test_faults_of_several_parts_come_together() -> None:
    found = faults(changed(conductor={"catalogue": "x"}, bundle={"subconductors": 2}))
    assert set(found) == {"/conductor/catalogue", "/bundle/spacing_m"}
