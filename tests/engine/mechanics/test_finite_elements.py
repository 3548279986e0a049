"""K and M against energies that are computed by hand, and against what must not change them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W, interpolation_at
from engine.mechanics.modes import full_modes
from engine.mechanics.static_profile import coordinates, static_profile
from engine.spec import (
    Aerodynamics,
    AirflowSpoiler,
    BlowOut,
    Bundle,
    DetuningPendulum,
    Ice,
    IceSegment,
    Line,
    Spacer,
    Span,
    Supports,
)
from tests.builders import ICE_AT_40, discretized, random_line, source_line

NODES = 21


def nodal(line: Line) -> tuple[FloatArray, FloatArray]:
    """Return arc positions of the nodes and their coordinates."""
    profile = static_profile((line,))
    arc = np.linspace(0.0, profile.arc_length[0], NODES)
    return arc, coordinates(profile, arc[None])[0]


def field(kind: int, values: FloatArray) -> FloatArray:
    """Return the freedoms of a field that takes these values at the nodes."""
    vector = np.zeros(FIELDS * NODES)
    vector[kind::FIELDS] = values
    return vector


def without_springs(line: Line) -> Line:
    """Return a line whose ends are all but free along the span."""
    return replace(line, supports=Supports(longitudinal_stiffness=1e-12))


@settings(max_examples=15)
@given(st.integers(0, 10**6))
def test_matrices_are_symmetric_and_mass_is_positive(seed: int) -> None:
    system = discretized(random_line(np.random.default_rng(seed))).matrices
    for matrix in (system.stiffness[0], system.mass[0]):
        assert np.abs(matrix - matrix.T).max() <= 1e-12 * np.abs(matrix).max()
    assert np.linalg.eigvalsh(system.mass[0]).min() > 0.0


@pytest.mark.parametrize("subconductors", [1, 2, 4])
@pytest.mark.parametrize("direction", [U, V, W])
def test_translation_carries_the_whole_mass(subconductors: int, direction: int) -> None:
    discretization = discretized(source_line(subconductors))
    unit = field(direction, np.ones(NODES))
    expected = subconductors * 2.379 * discretization.profile.arc_length[0]
    # The isoparametric curve's length differs from the catenary's by (h/c)^4: 1e-9.
    assert unit @ discretization.matrices.mass[0] @ unit == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("direction", [U, V, W])
def test_translation_has_no_strain_energy_but_in_the_springs(direction: int) -> None:
    line = source_line(3)
    discretization = discretized(line)
    unit = field(direction, np.ones(NODES))
    expected = 3 * discretization.profile.end_stiffness[0].sum() if direction == U else 0.0
    assert unit @ discretization.matrices.stiffness[0] @ unit == pytest.approx(expected, rel=1e-9, abs=1e-4)


@pytest.mark.parametrize(("a", "b"), [(U, V), (U, W), (V, W)])
def test_infinitesimal_rotation_has_no_elastic_energy(a: int, b: int) -> None:
    # u = phi x r strains nothing to first order, so EA drops out and only the tension's T |u'|^2 stays.
    line = without_springs(replace(source_line(1), span=Span(125.88, sag=12.0)))
    doubled = replace(line, conductor=replace(line.conductor, axial_rigidity=100.0 * line.conductor.axial_rigidity))
    _, r = nodal(line)
    rotation = field(a, -r[:, b]) + field(b, r[:, a])
    one, other = (discretized(x).matrices.stiffness[0] for x in (line, doubled))
    first, second = rotation @ one @ rotation, rotation @ other @ rotation
    assert second - first == pytest.approx(0.0, abs=1e-8 * first)


def test_rotation_in_plane_stores_the_energy_of_the_tension() -> None:
    line = without_springs(replace(source_line(2), span=Span(125.88, sag=6.0)))
    discretization = discretized(line)
    c, tension = discretization.profile.catenary_parameter[0], discretization.profile.horizontal_tension[0]
    _, r = nodal(line)
    rotation = field(U, -r[:, 1]) + field(V, r[:, 0])
    # n int T ds = n H int cosh^2(x/c) dx over the span.
    integral = tension * (0.5 * 125.88 + 0.5 * c * math.sinh(125.88 / c))
    assert rotation @ discretization.matrices.stiffness[0] @ rotation == pytest.approx(2.0 * integral, rel=1e-7)


def test_uniform_stretch_of_a_nearly_straight_line_stores_n_ea_over_l() -> None:
    line = without_springs(replace(source_line(2), span=Span(100.0, sag=1e-4), ice=replace(source_line(2).ice)))
    discretization = discretized(line)
    stretch = field(U, np.linspace(0.0, 1.0, NODES))
    expected = 2.0 * (line.conductor.axial_rigidity + discretization.profile.horizontal_tension[0]) / 100.0
    assert stretch @ discretization.matrices.stiffness[0] @ stretch == pytest.approx(expected, rel=1e-9)


def test_uniform_twist_stores_torsion_tension_and_axial_torsional_coupling() -> None:
    line = replace(source_line(2), span=Span(100.0, sag=1e-4))
    line = without_springs(replace(line, conductor=replace(line.conductor, axial_torsional_coupling=700.0)))
    discretization = discretized(line)
    along = np.linspace(0.0, 1.0, NODES)
    twist, stretch = field(THETA, along), field(U, along)
    tension = discretization.profile.horizontal_tension[0]
    ice = 2.379 * 9.81 * 2.05e-3 * 100.0 / 3.0
    expected = 2.0 * (101.0 / 100.0 + tension * 0.2355**2 / 100.0 - ice)
    stiffness = discretization.matrices.stiffness[0]
    assert twist @ stiffness @ twist == pytest.approx(expected, rel=1e-9)
    assert twist @ stiffness @ stretch == pytest.approx(2.0 * 700.0 / 100.0, rel=1e-9)


def test_rotation_of_the_section_carries_every_sub_conductor_and_its_ice() -> None:
    positions = ((0.3, 0.1), (-0.2, 0.25), (0.05, -0.4))
    line = replace(source_line(3), bundle=Bundle(positions))
    discretization = discretized(line)
    e_y, e_z = line.ice.eccentricity_y, line.ice.eccentricity_z
    turn, up, across = (field(kind, np.ones(NODES)) for kind in (THETA, V, W))
    mass, length = discretization.matrices.mass[0], discretization.profile.arc_length[0]
    own = 3.334e-4 - 2.379 * (e_y**2 + e_z**2)
    inertia = sum(2.379 * ((y + e_y) ** 2 + (z + e_z) ** 2) + own for y, z in positions)
    assert turn @ mass @ turn == pytest.approx(inertia * length, rel=1e-9)
    assert turn @ mass @ up == pytest.approx(-2.379 * sum(z + e_z for _, z in positions) * length, rel=1e-9)
    assert turn @ mass @ across == pytest.approx(2.379 * sum(y + e_y for y, _ in positions) * length, rel=1e-9)


def test_kinetic_energy_is_that_of_the_sub_conductors_moving_by_eq_3() -> None:
    line = source_line(3)
    discretization = discretized(line)
    rng = np.random.default_rng(3)
    u, v, w, theta = rng.normal(size=4)
    motion = sum((field(k, np.full(NODES, x)) for k, x in enumerate((u, v, w, theta))), np.zeros(FIELDS * NODES))
    e_y, e_z = line.ice.eccentricity_y, line.ice.eccentricity_z
    energy = 0.0
    for y, z in line.bundle.positions:
        energy += 2.379 * (u**2 + (v - (z + e_z) * theta) ** 2 + (w + (y + e_y) * theta) ** 2)
        energy += (3.334e-4 - 2.379 * (e_y**2 + e_z**2)) * theta**2
    assert motion @ discretization.matrices.mass[0] @ motion == pytest.approx(
        energy * discretization.profile.arc_length[0], rel=1e-9
    )


def test_spacer_of_zero_mass_changes_nothing() -> None:
    line = source_line(2)
    with_spacers = replace(line, devices=(Spacer(20.0, 0.0, 0.0), Spacer(125.88, 0.0, 0.0), Spacer(0.0, 0.0, 0.0)))
    one, other = discretized(line).matrices, discretized(with_spacers).matrices
    assert np.array_equal(one.mass, other.mass)
    assert np.array_equal(one.stiffness, other.stiffness)


@pytest.mark.parametrize("position", [3.0, 62.94, 90.0, 125.88])
def test_spacer_adds_its_energy(position: float) -> None:
    line = source_line(2)
    discretization = discretized(replace(line, devices=(Spacer(position, 6.5, 0.4),)))
    added = discretization.matrices.mass[0] - discretized(line).matrices.mass[0]
    first, values = interpolation_at(discretization.profile, 0, 10, position)
    rng = np.random.default_rng(1)
    motion = rng.normal(size=FIELDS * NODES)
    at = values @ motion.reshape(NODES, FIELDS)[first : first + 3]
    energy = 6.5 * (at[:3] ** 2).sum() + 0.4 * at[3] ** 2
    assert motion @ added @ motion == pytest.approx(energy, rel=1e-10)


@pytest.mark.parametrize("angle", [0.0, 0.6, -1.2, math.pi])
def test_pendulum_adds_the_energy_of_a_point_mass_on_its_arm(angle: float) -> None:
    line = source_line(2)
    bob, arm = 12.0, 0.35
    before, after = (
        discretized(x).matrices for x in (line, replace(line, devices=(DetuningPendulum(62.94, bob, arm, angle),)))
    )
    u, v, w, theta = 0.3, -0.7, 0.4, 1.1
    motion = sum((field(k, np.full(NODES, x)) for k, x in enumerate((u, v, w, theta))), np.zeros(FIELDS * NODES))
    # The bob hangs at y = -l cos(beta), z = l sin(beta); section 1: v = V - z Theta, w = W + y Theta.
    y, z = -arm * math.cos(angle), arm * math.sin(angle)
    kinetic = bob * (u**2 + (v - z * theta) ** 2 + (w + y * theta) ** 2)
    assert motion @ (after.mass[0] - before.mass[0]) @ motion == pytest.approx(kinetic, rel=1e-9)

    def height(turn: float) -> float:
        return y * math.cos(turn) - z * math.sin(turn)

    # Gravity's stiffness is the second difference of the bob's height over the rotation.
    step = 1e-3
    bend = (height(step) - 2.0 * height(0.0) + height(-step)) / step**2
    potential = bob * 9.81 * bend * theta**2
    added = after.stiffness[0] - before.stiffness[0]
    assert motion @ added @ motion == pytest.approx(potential, rel=1e-6, abs=1e-8)


def test_turning_a_bundle_by_its_symmetry_changes_nothing() -> None:
    for n in (2, 3, 4):
        line = source_line(n)
        turned = replace(line, bundle=Bundle.regular(n, 0.2355, 0.7 + 2.0 * math.pi / n))
        plain = replace(line, bundle=Bundle.regular(n, 0.2355, 0.7))
        one, other = discretized(plain).matrices, discretized(turned).matrices
        for a, b in ((one.mass, other.mass), (one.stiffness, other.stiffness)):
            assert a == pytest.approx(b, abs=1e-13 * np.abs(a).max())


def test_bundle_by_positions_equals_the_regular_one() -> None:
    half = 0.2355 / math.sqrt(2.0)
    square = Bundle(((half, half), (-half, half), (-half, -half), (half, -half)))
    line = source_line(4)
    one, other = discretized(line).matrices, discretized(replace(line, bundle=square)).matrices
    assert one.mass == pytest.approx(other.mass, abs=1e-13 * np.abs(one.mass).max())
    assert one.stiffness == pytest.approx(other.stiffness, abs=1e-13 * np.abs(one.stiffness).max())


def test_mirror_image_of_the_span_gives_the_mirrored_matrices() -> None:
    none = Aerodynamics((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    line = source_line(2)
    left = replace(
        line,
        ice=replace(line.ice, segments=(IceSegment(10.0, 33.3, mass=2.6, eccentricity_y=1e-3),)),
        devices=(Spacer(40.0, 5.0, 0.3), AirflowSpoiler(50.0, 77.0, none, 0.3)),
    )
    right = replace(
        line,
        ice=replace(line.ice, segments=(IceSegment(125.88 - 33.3, 115.88, mass=2.6, eccentricity_y=1e-3),)),
        devices=(Spacer(85.88, 5.0, 0.3), AirflowSpoiler(125.88 - 77.0, 75.88, none, 0.3)),
    )
    one, other = discretized(left).matrices, discretized(right).matrices
    order = np.arange(FIELDS * NODES).reshape(NODES, FIELDS)[::-1].ravel()
    sign = np.where(np.arange(FIELDS * NODES) % FIELDS == U, -1.0, 1.0)
    for a, b in ((one.mass[0], other.mass[0]), (one.stiffness[0], other.stiffness[0])):
        mirrored = (sign[:, None] * b * sign)[np.ix_(order, order)]
        assert a == pytest.approx(mirrored, abs=1e-11 * np.abs(a).max())


def eigenvalues(line: Line) -> FloatArray:
    """Return the lowest twelve squares of natural frequencies of all freedoms."""
    system = discretized(line).matrices
    free = np.flatnonzero(~system.fixed[0])
    select = np.ix_(free, free)
    return np.asarray(eigh(system.stiffness[0][select], system.mass[0][select], eigvals_only=True)[:12])


@pytest.mark.parametrize("place", [(0.3, 0.0), (0.0, -0.5), (-0.2, 0.4)])
def test_place_of_a_single_conductor_beside_the_reference_curve_does_not_matter(place: tuple[float, float]) -> None:
    # With eq. (3) V_1, W_1 and Theta of the conductor itself are as good freedoms as V, W and Theta of the curve.
    line = source_line(1)
    moved = replace(line, bundle=Bundle((place,)))
    assert eigenvalues(moved) == pytest.approx(eigenvalues(line), rel=1e-7)


@pytest.mark.parametrize("subconductors", [2, 3])
def test_torsion_of_an_inclined_bundle_is_that_about_its_chord(subconductors: int) -> None:
    # About X the twin would strain its sub-conductors by Theta' z_i times the chord's slope: 3.1 Hz instead of 0.64.
    line = replace(source_line(subconductors), ice=Ice(ICE_AT_40), supports=Supports(longitudinal_stiffness=1e7))
    inclined = replace(line, span=Span(125.88, horizontal_tension=30_000.0, level_difference=30.0))
    chord = math.hypot(125.88, 30.0)
    level = replace(line, span=Span(chord, horizontal_tension=30_000.0 * chord / 125.88))
    found, expected = (full_modes(discretized(x).matrices, (1, 2)).eigenvalues[0, 2] for x in (inclined, level))
    assert found == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("place", [(0.3, 0.0), (0.0, -0.5), (-0.2, 0.4)])
def test_place_of_an_inclined_conductor_beside_the_reference_curve_does_not_matter(place: tuple[float, float]) -> None:
    line = replace(source_line(1), span=Span(125.88, horizontal_tension=30_000.0, level_difference=25.0))
    moved = replace(line, bundle=Bundle((place,)))
    assert eigenvalues(moved) == pytest.approx(eigenvalues(line), rel=1e-7)


def test_blown_out_cable_is_a_heavier_one_that_is_turned() -> None:
    # Without offset of the ice the tilted cable is the still one in a gravity of sqrt(1 + r^2): the same eigenvalues as
    # a mass larger by that factor has at the same catenary parameter, times the factor.
    line = source_line(1)
    base = replace(
        line,
        ice=replace(line.ice, eccentricity_y=0.0, eccentricity_z=0.0),
        supports=Supports(longitudinal_stiffness=1e5),
        span=Span(125.88, sag=2.5),
    )
    blown = replace(base, wind=replace(line.wind, blow_out=BlowOut(25.0, 1.2)))
    ratio = math.hypot(1.0, 0.5 * 1.2929 * 25.0**2 * 0.0286 * 1.2 / (2.379 * 9.81))
    catenary = float(discretized(blown).profile.catenary_parameter[0])
    heavy = replace(
        base,
        conductor=replace(base.conductor, mass=2.379 * ratio, polar_inertia=3.334e-4 * ratio),
        span=Span(125.88, catenary_parameter=catenary),
    )
    assert eigenvalues(blown) == pytest.approx(ratio * eigenvalues(heavy), rel=1e-7)
    turned, plain = discretized(blown).matrices, discretized(heavy).matrices
    assert turned.stiffness == pytest.approx(plain.stiffness, abs=1e-9 * np.abs(plain.stiffness).max())
