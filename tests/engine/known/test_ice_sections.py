"""Sections of ice against closed forms, random points, limits and rules."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.known.densities import IceKind
from engine.known.ice_sections import Accretion, BareConductor, IceSection, Shape, ice_section
from engine.outcome import InvalidSpec

DIAMETER, RADIUS, MASS, INERTIA = 0.02811, 0.014055, 1.628, 1.5e-4
DRAKE = BareConductor(DIAMETER, MASS, INERTIA)
THICKNESS, DENSITY = 0.012, 900.0
OUTLINED = (Shape.UNIFORM, Shape.CRESCENT, Shape.D_SHAPE)


def iced(shape: Shape, angle: float = 0.0) -> IceSection:
    return ice_section(DRAKE, Accretion(shape, THICKNESS, density=DENSITY, angle=angle))


def profile(points: np.ndarray, angle: float = 0.0) -> IceSection:
    outline = tuple((float(p.real), float(p.imag)) for p in points)
    return ice_section(DRAKE, Accretion(Shape.PROFILE, density=DENSITY, angle=angle, points=outline))


def ring(radius: float, count: int, centre: complex = 0j) -> np.ndarray:
    return np.asarray(centre + radius * np.exp(2j * np.pi * np.arange(count) / count))


def test_uniform_ice_is_a_ring() -> None:
    found, outer = iced(Shape.UNIFORM), RADIUS + THICKNESS
    area = math.pi * (outer**2 - RADIUS**2)
    assert found.ice_area == pytest.approx(area, rel=1e-13)
    assert found.mass == pytest.approx(MASS + DENSITY * area, rel=1e-13)
    assert abs(complex(found.eccentricity_y, found.eccentricity_z)) < 1e-15
    assert found.polar_inertia == pytest.approx(INERTIA + DENSITY * 0.5 * math.pi * (outer**4 - RADIUS**4), rel=1e-13)
    assert found.outer_diameter == found.frontal_diameter == pytest.approx(2.0 * outer)


def test_crescent_ice_is_an_eccentric_disc_without_the_conductor() -> None:
    found, outer, shift = iced(Shape.CRESCENT), RADIUS + 0.5 * THICKNESS, 0.5 * THICKNESS
    area = math.pi * (outer**2 - RADIUS**2)
    assert found.ice_area == pytest.approx(area, rel=1e-13)
    assert found.eccentricity_y == pytest.approx(DENSITY * math.pi * outer**2 * shift / found.mass, rel=1e-13)
    polar = math.pi * outer**2 * (0.5 * outer**2 + shift**2) - 0.5 * math.pi * RADIUS**4
    assert found.polar_inertia == pytest.approx(INERTIA + DENSITY * polar, rel=1e-13)
    assert found.outer_diameter == found.frontal_diameter == pytest.approx(DIAMETER + THICKNESS)


def test_d_shaped_ice_is_half_a_ring() -> None:
    found, outer = iced(Shape.D_SHAPE), RADIUS + THICKNESS
    area = 0.5 * math.pi * (outer**2 - RADIUS**2)
    assert found.ice_area == pytest.approx(area, rel=1e-13)
    first = 2.0 / 3.0 * (outer**3 - RADIUS**3)
    assert found.eccentricity_y == pytest.approx(DENSITY * first / found.mass, rel=1e-13)
    assert found.polar_inertia == pytest.approx(INERTIA + DENSITY * 0.25 * math.pi * (outer**4 - RADIUS**4), rel=1e-13)
    assert found.frontal_diameter == pytest.approx(outer + RADIUS)
    assert iced(Shape.D_SHAPE, 0.5 * math.pi).frontal_diameter == pytest.approx(2.0 * outer)


@pytest.mark.parametrize("shape", OUTLINED)
def test_sections_are_those_of_random_points(shape: Shape) -> None:
    angle = math.radians(200.0)
    found, outer = iced(shape, angle), RADIUS + THICKNESS
    rng = np.random.default_rng(11)
    points = rng.uniform(-outer, outer, 10**6) + 1j * rng.uniform(-outer, outer, 10**6)
    to_thickest = np.exp(1j * angle)
    within = {
        Shape.UNIFORM: np.abs(points) < outer,
        Shape.CRESCENT: np.abs(points - 0.5 * THICKNESS * to_thickest) < RADIUS + 0.5 * THICKNESS,
        Shape.D_SHAPE: (np.abs(points) < outer) & ((points * to_thickest.conjugate()).real > 0.0),
    }[shape] & (np.abs(points) > RADIUS)
    cell = 4.0 * outer**2 / points.size
    mass = DENSITY * cell * within.sum()
    assert found.ice_mass == pytest.approx(mass, rel=5e-3)
    centre = DENSITY * cell * points[within].sum() / (MASS + mass)
    assert complex(found.eccentricity_y, found.eccentricity_z) == pytest.approx(centre, abs=2e-5)
    inertia = INERTIA + DENSITY * cell * (np.abs(points[within]) ** 2).sum()
    assert found.polar_inertia == pytest.approx(inertia, rel=5e-3)


@pytest.mark.parametrize("shape", OUTLINED)
def test_a_thin_layer_leaves_the_bare_conductor(shape: Shape) -> None:
    thin = ice_section(DRAKE, Accretion(shape, 1e-9, density=DENSITY))
    assert thin.mass == pytest.approx(MASS, rel=1e-6)
    assert thin.eccentricity_y == pytest.approx(0.0, abs=1e-9)
    assert thin.polar_inertia == pytest.approx(INERTIA, rel=1e-6)
    assert thin.outer_diameter == pytest.approx(DIAMETER, rel=1e-6)
    # To first order the area is the mean thickness times the circumference.
    mean = {Shape.UNIFORM: 1.0, Shape.CRESCENT: 0.5, Shape.D_SHAPE: 0.5}[shape]
    assert thin.ice_area == pytest.approx(mean * 1e-9 * math.pi * DIAMETER, rel=1e-5)


@given(st.sampled_from(OUTLINED), st.floats(-7.0, 7.0))
def test_the_angle_turns_the_eccentricity_and_nothing_else(shape: Shape, angle: float) -> None:
    at_top, turned = iced(shape), iced(shape, angle)
    before = complex(at_top.eccentricity_y, at_top.eccentricity_z)
    after = complex(turned.eccentricity_y, turned.eccentricity_z)
    assert abs(after - before * complex(math.cos(angle), math.sin(angle))) < 1e-15
    assert turned.polar_inertia == pytest.approx(at_top.polar_inertia, rel=1e-12)
    assert turned.mass == pytest.approx(at_top.mass, rel=1e-12)


def test_the_thickest_point_is_counted_clockwise_from_straight_up() -> None:
    top, downwind = iced(Shape.CRESCENT), iced(Shape.CRESCENT, math.radians(90.0))
    windward = iced(Shape.D_SHAPE, math.radians(270.0))
    assert (top.eccentricity_y > 1e-3, abs(top.eccentricity_z) < 1e-15) == (True, True)
    assert (downwind.eccentricity_z > 1e-3, abs(downwind.eccentricity_y) < 1e-15) == (True, True)
    assert windward.eccentricity_z < -1e-3


@given(st.sampled_from(OUTLINED), st.floats(1e-5, 0.2), st.floats(100.0, 917.0))
def test_a_mass_of_ice_gives_back_the_thickness(shape: Shape, thickness: float, density: float) -> None:
    by_thickness = ice_section(DRAKE, Accretion(shape, thickness, density=density))
    by_mass = ice_section(DRAKE, Accretion(shape, mass=by_thickness.ice_mass, density=density))
    assert by_mass.thickness == pytest.approx(thickness, rel=1e-9)
    assert by_mass.polar_inertia == pytest.approx(by_thickness.polar_inertia, rel=1e-9)


def test_a_fine_outline_of_a_crescent_is_the_crescent() -> None:
    exact = iced(Shape.CRESCENT, 0.7)
    outline = ring(RADIUS + 0.5 * THICKNESS, 999, 0.5 * THICKNESS * np.exp(0.7j))
    for points in (outline, outline[::-1]):
        found = profile(points)
        assert found.ice_mass == pytest.approx(exact.ice_mass, rel=1e-4)
        assert found.eccentricity_y == pytest.approx(exact.eccentricity_y, rel=1e-4)
        assert found.eccentricity_z == pytest.approx(exact.eccentricity_z, rel=1e-4)
        assert found.polar_inertia == pytest.approx(exact.polar_inertia, rel=1e-4)
        assert found.thickness == pytest.approx(THICKNESS, rel=1e-4)
        assert found.frontal_diameter == pytest.approx(exact.frontal_diameter, rel=1e-4)
        assert found.outer_diameter == pytest.approx(exact.outer_diameter, rel=1e-4)


def test_an_angle_turns_an_outline() -> None:
    outline = ring(RADIUS + 0.5 * THICKNESS, 500, 0.5 * THICKNESS + 0j)
    turned, angle = profile(outline, angle=1.1), 1.1
    drawn = profile(outline * np.exp(1j * angle))
    assert turned.eccentricity_y == pytest.approx(drawn.eccentricity_y, rel=1e-12)
    assert turned.eccentricity_z == pytest.approx(drawn.eccentricity_z, rel=1e-12)


def test_chords_on_the_bare_side_count_no_ice_within_the_conductor() -> None:
    # Half a ring drawn with 24 chords on the conductor: what they cut off the disc is no negative ice.
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 400)
    lee = np.linspace(0.5 * np.pi, 1.5 * np.pi, 25)
    found = profile(np.concatenate([(RADIUS + THICKNESS) * np.exp(1j * angles), RADIUS * np.exp(1j * lee)]))
    exact = iced(Shape.D_SHAPE)
    assert found.ice_mass == pytest.approx(exact.ice_mass, rel=1e-4)
    assert found.eccentricity_y == pytest.approx(exact.eccentricity_y, rel=1e-4)
    assert found.polar_inertia == pytest.approx(exact.polar_inertia, rel=1e-4)
    assert found.frontal_diameter == pytest.approx(exact.frontal_diameter, rel=1e-4)


def test_the_mass_of_a_profile_gives_its_density() -> None:
    outline = tuple((float(p.real), float(p.imag)) for p in ring(0.03, 600))
    half = ice_section(DRAKE, Accretion(Shape.PROFILE, points=outline, density=450.0))
    found = ice_section(DRAKE, Accretion(Shape.PROFILE, points=outline, mass=half.ice_mass))
    assert found.density == pytest.approx(450.0, rel=1e-12)
    with pytest.raises(InvalidSpec, match=r"ice.accretion.mass must not make ice denser .* got 9\.0"):
        ice_section(DRAKE, Accretion(Shape.PROFILE, points=outline, mass=9.0))


def test_without_a_density_the_kind_of_ice_says_it() -> None:
    glaze = ice_section(DRAKE, Accretion(Shape.UNIFORM, THICKNESS))
    rime = ice_section(DRAKE, Accretion(Shape.UNIFORM, THICKNESS, kind=IceKind.SOFT_RIME))
    assert glaze.density == 900.0
    assert rime.ice_mass == pytest.approx(glaze.ice_mass * rime.density / 900.0)


@pytest.mark.parametrize(
    ("fields", "fault"),
    [
        ({"thickness": None}, r"ice\.accretion must have exactly one of thickness and mass"),
        ({"mass": 1.0}, r"ice\.accretion must have exactly one of thickness and mass"),
        ({"thickness": -0.01}, r"ice\.accretion\.thickness must be a finite number greater than zero, got -0\.01"),
        ({"thickness": 12.0}, r"ice\.accretion\.thickness must be at most 0\.5 m: 12 mm is 0\.012 m, got 12"),
        ({"density": 9000.0}, r"ice\.accretion\.density must not make ice denser than solid ice, 917.* got 9000"),
        ({"angle": math.inf}, r"ice\.accretion\.angle must be a finite number"),
        ({"points": ((0.0, 1.0),)}, r"ice\.accretion\.points must be absent unless the shape is a profile"),
    ],
)
def test_a_broken_rule_of_a_shape_is_named(fields: dict[str, Any], fault: str) -> None:
    with pytest.raises(InvalidSpec, match=fault):
        replace(Accretion(Shape.CRESCENT, THICKNESS), **fields)


SQUARE = ((0.03, 0.03), (0.03, -0.03), (-0.03, -0.03), (-0.03, 0.03))
BOW_TIE = ((0.03, 0.03), (-0.03, -0.03), (-0.03, 0.03), (0.03, -0.03))


@pytest.mark.parametrize(
    ("points", "fault"),
    [
        (SQUARE[:2], r"ice\.accretion\.points must be 3 to 1000 points of the outline, got 2"),
        (BOW_TIE, r"ice\.accretion\.points must not cross itself: the edges after points 0 and 2 meet"),
        (
            tuple((y + 0.1, z) for y, z in SQUARE),
            r"must enclose the conductor: its centre lies outside .* 0\.07",
        ),
        (
            tuple((y + 0.02, z) for y, z in SQUARE),
            r"must enclose the conductor: .* radius \(0\.01405 m\), got 0\.0099",
        ),
        (((0.03, math.nan), *SQUARE[1:]), r"ice\.accretion\.points\.0\.1 must be a finite number"),
    ],
)
def test_a_broken_rule_of_an_outline_is_named(points: tuple[tuple[float, float], ...], fault: str) -> None:
    with pytest.raises(InvalidSpec, match=fault):
        ice_section(DRAKE, Accretion(Shape.PROFILE, density=DENSITY, points=points))


def test_a_profile_takes_no_thickness_and_not_both_mass_and_density() -> None:
    with pytest.raises(InvalidSpec, match=r"thickness must be absent for a profile"):
        Accretion(Shape.PROFILE, 0.01, points=SQUARE)
    with pytest.raises(InvalidSpec, match=r"mass must be absent for a profile whose density is given"):
        Accretion(Shape.PROFILE, mass=1.0, density=900.0, points=SQUARE)


def test_the_bare_conductor_is_checked() -> None:
    with pytest.raises(InvalidSpec, match=r"conductor\.mass must be a finite number greater than zero, got 0\.0"):
        BareConductor(DIAMETER, 0.0, INERTIA)


def test_ice_without_a_direction_grows_to_windward_and_an_outline_stands_as_drawn() -> None:
    usual = ice_section(DRAKE, Accretion(Shape.CRESCENT, THICKNESS, density=DENSITY))
    assert usual == iced(Shape.CRESCENT, math.radians(270.0))
    outline = tuple((float(p.real), float(p.imag)) for p in ring(0.03, 600, 0.005 + 0j))
    drawn = ice_section(DRAKE, Accretion(Shape.PROFILE, density=DENSITY, points=outline))
    assert drawn.eccentricity_y > 1e-3
