import pytest

from app.owned.conductor_sheets import read_conductors
from app.owned.spreadsheets import read_sheet
from app.reference.catalogue_row import CatalogueRow
from app.reference.conductors import named
from app.schemas.faults import BadInput


def conductors(text: str) -> list[CatalogueRow]:
    return read_conductors(read_sheet(text.encode()))


def faults(text: str) -> dict[str, str]:
    with pytest.raises(BadInput) as caught:
        conductors(text)
    return {fault.pointer: fault.detail for fault in caught.value.faults}


def test_units_in_the_names_give_si() -> None:
    """Drake as a utility in the United States writes it gives the figures of the shipped row."""
    (row,) = conductors(
        "code word,stranding,area [in2],diameter [in],weight [lb/ft],RTS [lbf],modulus [psi],expansion [1e-6/degF]\n"
        "Mine,26/7,0.7264,1.108,1.094,31500,10.1e6,10.456\n"
    )
    (drake,) = named("795 kcmil 26/7")
    for name in ("area_m2", "diameter_m", "mass_kg_per_m", "rated_strength_n", "youngs_modulus_pa"):
        assert getattr(row, name) == pytest.approx(getattr(drake, name), rel=1e-3)
    assert row.thermal_expansion_per_k == pytest.approx(18.82e-6, rel=1e-3)
    assert (row.own, row.aluminium_wires, row.steel_wires, row.designation) == (True, 26, 7, "Mine")
    assert row.aluminium_area_m2 is None


def test_units_in_a_second_row_give_si() -> None:
    (row,) = conductors("name;diameter;mass;rated strength\n;mm;kg/km;kN\nX;28,11;1628;140,1\n")
    assert (row.diameter_m, row.mass_kg_per_m, row.rated_strength_n) == pytest.approx((0.02811, 1.628, 140100.0))


def test_faults_name_the_row_that_the_spreadsheet_shows() -> None:
    found = faults(
        "name,diameter [mm],mass [kg/km],stranding\nA,28.1,1628,26/7\n\nB,x,1628,26-7\n,28.1,1,\nA,28.1,1628,\n"
    )
    assert found == {
        "/rows/4/diameter": "must be a number, got 'x'",
        "/rows/4/stranding": "must be wires of aluminium / of steel, such as 26/7, got '26-7'",
        "/rows/5/name": "is needed",
        "/rows/5/mass": "must be in 0.01 to 100 kg/m, but 1 kg/km is 0.001 kg/m",
        "/rows/6/name": "row 2 has this name already",
    }


@pytest.mark.parametrize(
    ("text", "pointer", "words"),
    [
        ("name,diameter,mass [kg/m]\nA,1,1", "/header/diameter", "must declare its unit, such as `diameter [m]`"),
        ("name,diameter [lb],mass [kg/m]\nA,1,1", "/header/diameter [lb]", "lb is a mass, but a length is wanted"),
        ("name,diameter [mm]\nA,1", "/header", "no column mass"),
        ("name,diameter [mm],mass [kg/m],colour\nA,1,1,red", "/header/colour", "unknown column"),
        ("name,diameter [mm],mass [kg/m],weight [kg/m]\nA,1,1,1", "/header/mass [kg~1m]", "two columns hold mass"),
        ("name,diameter [mm],mass [kg/m]\n", "", "1 to 1000 conductors, got 0"),
    ],
)
def test_a_header_that_cannot_be_read_is_told(text: str, pointer: str, words: str) -> None:
    assert words in faults(text)[pointer]
