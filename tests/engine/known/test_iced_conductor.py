"""Iced sub-conductors by accretion, as given, and bare."""

import math
from dataclasses import replace

import pytest

from engine.known.bare_conductor import bare_conductor
from engine.known.densities import IceKind
from engine.known.description import KnownAerodynamics, KnownConductor, KnownIce
from engine.known.ice_sections import Accretion, BareConductor, Shape, ice_section
from engine.known.iced_conductor import iced_conductor
from engine.known.provenance import Origin
from tests.engine.known.known_lines import C11, DRAKE

AERODYNAMICS = KnownAerodynamics(C11)
BARE = bare_conductor(KnownConductor(row=DRAKE), {}, bare=True)


def test_an_accretion_is_a_section_about_the_bare_conductor() -> None:
    ice = Accretion(Shape.CRESCENT, 0.012, density=850.0, angle=1.0)
    found = iced_conductor(KnownIce(AERODYNAMICS, ice), BARE, {})
    bare = BareConductor(0.02814, 1.6281, BARE["conductor.bare_polar_inertia"])
    section = ice_section(bare, ice)
    assert found.section == section
    assert found.rows["conductor.mass"] == section.mass
    assert found.rows["conductor.polar_inertia"] == section.polar_inertia
    assert found.rows["ice.eccentricity_y"] == section.eccentricity_y
    assert found.rows["ice.eccentricity_z"] == section.eccentricity_z
    assert {row.origin for row in found.rows.rows} == {Origin.GIVEN, Origin.COMPUTED}


def test_density_and_angle_that_are_not_said_are_assumed() -> None:
    found = iced_conductor(KnownIce(AERODYNAMICS, Accretion(Shape.D_SHAPE, 0.012)), BARE, {})
    ranges = {row.path: (row.lowest, row.value, row.highest) for row in found.rows.rows if row.origin is Origin.ASSUMED}
    assert ranges["ice.accretion.density"] == (600.0, 900.0, 917.0)
    assert ranges["ice.accretion.angle"] == pytest.approx((math.pi, 1.5 * math.pi, 2.0 * math.pi))
    assert found.rows["ice.eccentricity_z"] < -1e-3
    kind = Accretion(Shape.UNIFORM, 0.012, kind=IceKind.HARD_RIME)
    rime = iced_conductor(KnownIce(AERODYNAMICS, kind), BARE, {})
    assert [row.path for row in rime.rows.rows if row.origin is Origin.ASSUMED] == ["ice.accretion.density"]
    assert rime.rows["ice.accretion.density"] == 750.0


def test_chosen_values_make_another_section() -> None:
    ice = KnownIce(AERODYNAMICS, Accretion(Shape.CRESCENT, 0.012))
    chosen = {"ice.accretion.density": 700.0, "ice.accretion.angle": 4.0}
    said = Accretion(Shape.CRESCENT, 0.012, density=700.0, angle=4.0)
    assert iced_conductor(ice, BARE, chosen).section == iced_conductor(replace(ice, accretion=said), BARE, {}).section


def test_the_density_of_a_profile_with_a_mass_is_not_assumed() -> None:
    square = ((0.03, 0.03), (0.03, -0.03), (-0.03, -0.03), (-0.03, 0.03))
    found = iced_conductor(KnownIce(AERODYNAMICS, Accretion(Shape.PROFILE, mass=1.5, points=square)), BARE, {})
    assert not [row for row in found.rows.rows if row.origin is Origin.ASSUMED]
    assert found.rows["conductor.mass"] == pytest.approx(1.6281 + 1.5)


def test_iced_figures_are_taken_as_given_and_the_inertia_estimated() -> None:
    said = KnownIce(AERODYNAMICS, mass=2.379, polar_inertia=3.334e-4, eccentricity_y=2e-3, eccentricity_z=-6e-4)
    found = iced_conductor(said, BARE, {})
    assert found.section is None
    assert {row.path: row.value for row in found.rows.rows} == {
        "conductor.mass": 2.379,
        "conductor.polar_inertia": 3.334e-4,
        "ice.eccentricity_y": 2e-3,
        "ice.eccentricity_z": -6e-4,
    }
    estimated = iced_conductor(replace(said, polar_inertia=None), BARE, {})
    (row,) = [row for row in estimated.rows.rows if row.origin is Origin.ASSUMED]
    assert row.path == "conductor.polar_inertia"


def test_without_ice_the_conductor_is_bare() -> None:
    found = iced_conductor(KnownIce(AERODYNAMICS), BARE, {})
    assert found.rows["conductor.mass"] == BARE["conductor.bare_mass"]
    assert found.rows["conductor.polar_inertia"] == BARE["conductor.bare_polar_inertia"]
