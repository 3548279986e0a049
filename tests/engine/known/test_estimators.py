"""Estimates against hand calculations, the source's conductor and the conductors that ship with the service."""

import math
from dataclasses import replace

import pytest

from app.reference.conductors import shipped
from engine.known import estimators
from engine.known.estimate import Estimate
from engine.known.wires import Wires, areas_from_mass

DRAKE = Wires(402.8e-6, 65.4e-6, 0.02814, 26, 7)


def within(estimate: Estimate, value: float) -> bool:
    return estimate.lowest <= value <= estimate.highest


def test_gj_is_the_energy_of_two_layers_and_of_every_wire() -> None:
    # Drake's 10 and 16 wires of 4.44 mm over a core of 10.4 mm, one layer after the other.
    wire, area = 4.44e-3, 0.25 * math.pi * 4.44e-3**2
    helical = 0.0
    for count, radius in ((10, 5.19e-3 + 2.22e-3), (16, 5.19e-3 + 3 * 2.22e-3)):
        angle = math.atan(2.0 * math.pi * radius / (12.0 * 2.0 * (radius + 0.5 * wire)))
        helical += count * 68e9 * area * radius**2 * math.sin(angle) ** 2 * math.cos(angle)
    own = 26 * 68e9 / 2.66 * math.pi * wire**4 / 32.0 + 7 * 207e9 / 2.6 * math.pi * 3.45e-3**4 / 32.0
    assert estimators.torsional_rigidity(DRAKE).value == pytest.approx(helical + own, rel=0.08)


def test_both_estimates_of_gj_hold_the_source_s_conductor_and_each_other() -> None:
    by_wires = estimators.torsional_rigidity(replace(DRAKE, diameter=0.0286))
    by_diameter = estimators.torsional_rigidity_of_diameter(0.0286)
    assert by_diameter.value == pytest.approx(101.0)
    assert within(by_wires, 101.0)
    assert within(by_diameter, by_wires.value)
    assert by_wires.highest / by_wires.lowest == pytest.approx(4.0)


def test_gj_grows_with_the_fourth_power_of_the_size() -> None:
    double = Wires(4 * DRAKE.aluminium_area, 4 * DRAKE.steel_area, 2 * DRAKE.diameter, 26, 7)
    small, large = (estimators.torsional_rigidity(wires).value for wires in (DRAKE, double))
    assert large / small == pytest.approx(16.0)
    ratio = (
        estimators.torsional_rigidity_of_diameter(0.04).value / estimators.torsional_rigidity_of_diameter(0.02).value
    )
    assert ratio == pytest.approx(16.0)


def test_unknown_wires_only_lack_their_own_torsion() -> None:
    unknown = replace(DRAKE, aluminium_wires=None, steel_wires=None)
    assert within(estimators.torsional_rigidity(DRAKE), estimators.torsional_rigidity(unknown).value)


def test_the_moduli_and_expansions_of_shipped_conductors_lie_in_their_ranges() -> None:
    shares = []
    for row in shipped():
        if row.area_m2 is None or row.aluminium_area_m2 is None or row.youngs_modulus_pa is None:
            continue
        wires = Wires(row.aluminium_area_m2, row.area_m2 - row.aluminium_area_m2, row.diameter_m)
        assert within(estimators.modulus(wires), row.youngs_modulus_pa), row.name
        shares.append(row.youngs_modulus_pa / (wires.stiffness / wires.area))
        if row.thermal_expansion_per_k is not None:
            assert within(estimators.thermal_expansion(wires), row.thermal_expansion_per_k), row.name
    shares.sort()
    assert len(shares) > 50
    # The figures that the estimate's sentence states.
    assert [round(share, 2) for share in (shares[0], shares[len(shares) // 2], shares[-1])] == [0.80, 0.87, 0.93]


def test_the_steel_of_shipped_conductors_follows_from_their_mass() -> None:
    for row in shipped():
        if row.area_m2 is not None and row.aluminium_area_m2 is not None:
            _, steel = areas_from_mass(row.area_m2, row.mass_kg_per_m)
            assert steel / row.area_m2 == pytest.approx(1.0 - row.aluminium_area_m2 / row.area_m2, abs=0.015), row.name


def test_the_areas_of_shipped_conductors_lie_in_the_range_of_their_circle() -> None:
    for row in shipped():
        if row.area_m2 is not None:
            assert within(estimators.area_of_circle(row.diameter_m), row.area_m2), row.name


def test_expansion_of_pure_aluminium_is_that_of_aluminium() -> None:
    pure = estimators.thermal_expansion(Wires(400e-6, 0.0, 0.026))
    assert (pure.lowest, pure.value, pure.highest) == pytest.approx((23e-6, 23e-6, 23e-6))


def test_the_polar_inertia_lies_between_core_and_disc() -> None:
    mass = 1.628
    disc = mass * DRAKE.diameter**2 / 8.0
    found = estimators.polar_inertia(DRAKE, mass)
    # Steel, a third of the mass, lies within 0.37 of the radius.
    aluminium, steel = 2700.0 * 402.8e-6, 7780.0 * 65.4e-6
    radius, core = 0.01407, 0.01407 * math.sqrt(65.4 / 468.2)
    by_parts = 0.5 * mass / (aluminium + steel) * (aluminium * (radius**2 + core**2) + steel * core**2)
    assert found.value == pytest.approx(by_parts, rel=1e-9)
    assert found.highest == pytest.approx(disc)
    assert within(estimators.polar_inertia_of_disc(DRAKE.diameter, mass), found.value)
    pure = estimators.polar_inertia(Wires(400e-6, 0.0, 0.026), 1.1)
    assert pure.value == pytest.approx(1.1 * 0.026**2 / 8.0)


def test_the_source_s_iced_inertia_and_damping_lie_in_their_ranges() -> None:
    assert within(estimators.iced_polar_inertia(0.0286, 2.379), 3.334e-4)
    for direction, ratio in (("vertical", 0.000515), ("horizontal", 0.000515), ("torsional", 0.308)):
        assert within(estimators.damping_ratio(direction), ratio)
