from dataclasses import replace

import pytest

from app.answers.reference import ConductorRow
from app.reference import conductors
from app.reference.conductor_doubts import doubts

ROWS = conductors.shipped()


def test_every_row_is_of_its_schema_and_names_a_source_an_address_and_a_licence() -> None:
    assert len(ROWS) >= 100
    for row in ROWS:
        listed = ConductorRow.model_validate(row.listed())
        assert all((listed.source, listed.source_address, listed.licence))


def test_the_row_of_drake_has_its_published_figures_in_si() -> None:
    """0.7264 in2, 1.108 in, 1.094 lb/ft, 31,500 lb, 6.4e6 + 3.7e6 psi, 12.8e-6 and 6.4e-6 per degree Fahrenheit."""
    (drake,) = conductors.search("drake")
    assert (drake.type, drake.stranding, drake.designation) == ("ACSR", "26/7", "795 kcmil 26/7")
    assert drake.area_m2 == pytest.approx(0.7264 * 0.0254**2, rel=1e-4)
    assert drake.aluminium_area_m2 == pytest.approx(795e3 * 0.7854 * 2.54e-5**2, rel=1e-4)
    assert drake.diameter_m == pytest.approx(1.108 * 0.0254, rel=2e-4)
    assert drake.mass_kg_per_m == pytest.approx(1.094 * 0.45359237 / 0.3048, rel=1e-4)
    assert drake.rated_strength_n == pytest.approx(31_500 * 4.4482216, rel=1e-4)
    psi = 6894.757
    assert drake.youngs_modulus_pa == pytest.approx(10.1e6 * psi, rel=1e-3)
    expansion = 1.8e-6 * (6.4 * 12.8 + 3.7 * 6.4) / 10.1
    assert drake.thermal_expansion_per_k == pytest.approx(expansion, rel=1e-3)


@pytest.mark.parametrize(
    ("text", "designations"),
    [
        ("HAWK", ["242-AL1/39-ST1A"]),
        ("aacsr 30/7 212", ["212-AL3/49-ST1A"]),
        ("  26/7   drake ", ["795 kcmil 26/7"]),
        ("no such thing", []),
        ("%", []),
    ],
)
def test_all_words_are_sought_in_any_case(text: str, designations: list[str]) -> None:
    assert [row.designation for row in conductors.search(text)] == designations


@pytest.mark.parametrize(
    ("name", "designations"),
    [
        ("drake", ["795 kcmil 26/7"]),
        ("795 KCMIL  26/7", ["795 kcmil 26/7"]),
        ("50/8", ["48-AL1/8-ST1A", "48-AL3/8-ST1A"]),
        ("48-al3/8-st1a", ["48-AL3/8-ST1A"]),
        ("Drak", []),
    ],
)
def test_a_conductor_is_found_by_its_designation_or_by_its_whole_name(name: str, designations: list[str]) -> None:
    assert [row.designation for row in conductors.named(name)] == designations


def test_accents_may_be_written_in_either_form() -> None:
    (drake,) = conductors.named("drake")
    own = [replace(drake, name="A\u030ase", designation="ours")]
    assert conductors.search("\u00e5SE", own) == conductors.search("a\u030ase", own) == own
    assert conductors.named("\u00c5se", conductors.NamedRows.of(own)) == own


def test_no_two_rows_are_the_same_conductor() -> None:
    assert len({row.designation for row in ROWS}) == len(ROWS)


def test_the_figures_of_no_row_contradict_each_other() -> None:
    assert {row.designation: found for row in ROWS if (found := doubts(row))} == {}
