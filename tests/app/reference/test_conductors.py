import csv
from importlib.resources import files

import pytest

from app.answers.reference import ConductorRow
from app.reference import conductors

ALUMINIUM, STEEL = 2703.0, 7780.0  # kg/m3, IEC 60889 and IEC 60888
ROWS = conductors.search("")


def test_every_row_is_of_its_schema_and_of_its_source() -> None:
    assert len(ROWS) >= 90
    for row in ROWS:
        assert ConductorRow.model_validate(row).source


def test_the_row_of_drake_has_its_published_figures_in_si() -> None:
    (drake,) = conductors.search("drake")
    assert drake == {
        "name": "Drake",
        "designation": "795 kcmil 26/7",
        "type": "ACSR",
        "stranding": "26/7",
        "area_m2": 468.5e-6,
        "diameter_m": 0.02811,
        "mass_kg_per_m": 1.628,
        "rated_strength_n": 140100.0,
        "youngs_modulus_pa": 74e9,
        "source": "Aluminum Association values for ACSR",
    }


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
    assert [row["designation"] for row in conductors.search(text)] == designations


def test_no_two_rows_are_the_same_conductor() -> None:
    assert len({(row["name"], row["designation"], row["source"]) for row in ROWS}) == len(ROWS)


def test_printed_masses_are_those_of_the_printed_areas() -> None:
    """Density times area, longer by the lay of the strands: a slip of a digit shows here."""
    text = (files("app") / "data" / "conductors.csv").read_text(encoding="utf-8")
    for row in csv.DictReader(text.splitlines()):
        if row["steel_area_mm2"]:
            steel = float(row["steel_area_mm2"])
            aluminium = float(row["area_mm2"]) - steel
            mass = (1.021 * ALUMINIUM * aluminium + 1.005 * STEEL * steel) * 1e-3
            assert float(row["mass_kg_per_km"]) == pytest.approx(mass, rel=0.02), row["designation"]


def test_wires_fill_between_half_and_nine_tenths_of_the_circle() -> None:
    for row in ROWS:
        assert 0.5 < row["area_m2"] / (0.7854 * row["diameter_m"] ** 2) < 0.9, row["designation"]
        if row["rated_strength_n"] is not None:
            assert 1.4e8 < row["rated_strength_n"] / row["area_m2"] < 6.5e8, row["designation"]
