"""Areas of aluminium and steel from what catalogues print."""

import pytest

from engine.known.wires import ALUMINIUM_DENSITY, LAY_MASS, STEEL_DENSITY, Wires, areas_from_mass


@pytest.mark.parametrize("steel", [0.0, 20e-6, 65e-6, 300e-6])
def test_areas_follow_from_area_and_mass(steel: float) -> None:
    mass = LAY_MASS * (ALUMINIUM_DENSITY * 400e-6 + STEEL_DENSITY * steel)
    assert areas_from_mass(400e-6 + steel, mass) == pytest.approx((400e-6, steel))


def test_a_mass_below_that_of_aluminium_means_no_steel_and_above_that_of_steel_no_aluminium() -> None:
    assert areas_from_mass(400e-6, 1.0) == (400e-6, 0.0)
    assert areas_from_mass(400e-6, 9.0) == (0.0, 400e-6)


def test_wires_add_up() -> None:
    wires = Wires(400e-6, 100e-6, 0.03)
    assert wires.area == pytest.approx(500e-6)
    assert wires.stiffness == pytest.approx(68e9 * 400e-6 + 207e9 * 100e-6)
    assert wires.core_radius == pytest.approx(0.015 * 0.2**0.5)
