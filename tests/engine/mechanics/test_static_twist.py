"""The twisted static state against exact solutions, finite differences and brute-force minima of the energy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh_tridiagonal
from scipy.optimize import brentq, minimize
from scipy.special import ellipj, ellipk

from engine.arrays import FloatArray
from engine.mechanics.coefficients import fit_measured
from engine.mechanics.finite_elements import FIELDS, THETA, held_freedoms
from engine.mechanics.modes import directional_shapes
from engine.mechanics.static_twist import energy_derivatives, twisted_state
from engine.models.discretization import Discretization, discretize
from engine.outcome import InvalidSpec, Outcome
from engine.spec import (
    Analysis,
    Bundle,
    CrossSection,
    DetuningPendulum,
    Ice,
    IceSegment,
    Line,
    MeasuredCoefficients,
    Model,
    PhysicsRequest,
    StaticTwist,
    with_physics,
)
from tests.builders import ICE_AT_40, discretized, random_line, run, source_line

GRAVITY = 9.81


def single(length: float, e_y: float, e_z: float, elements: int = 10) -> Line:
    """Return the source's single conductor of another length and eccentricity."""
    line = source_line(1)
    return replace(line, span=replace(line.span, length=length, elements=elements), ice=Ice(ICE_AT_40, e_y, e_z))


def twist_of(line: Line) -> tuple[FloatArray, FloatArray]:
    """Return arc positions and twist of the nodes; the state must have been found."""
    discretization = discretized(line)
    state = twisted_state(discretization.lines, discretization.profile, discretization.sections)
    assert state.outcome[0] is Outcome.CONVERGED
    return np.linspace(0.0, float(discretization.profile.arc_length[0]), state.angle.shape[1]), state.angle[0]


def wave_number(line: Line, eccentricity: float) -> float:
    """Return sqrt(m g e / GJ) [1/m]."""
    return math.sqrt(line.conductor.mass * GRAVITY * eccentricity / line.conductor.torsional_rigidity)


def eventful_line(seed: int) -> Line:
    """Draw a line with coupling, free sections, positions off the centre, partial ice and a pendulum."""
    generator = np.random.default_rng(seed)
    line = random_line(generator)
    positions = tuple((float(y), float(z)) for y, z in generator.normal(scale=0.2, size=(3, 2)))
    return replace(
        line,
        conductor=replace(line.conductor, axial_torsional_coupling=500.0),
        bundle=Bundle(positions, CrossSection.FREE),
        ice=replace(line.ice, segments=(IceSegment(10.0, 33.0, eccentricity_y=-1e-3, eccentricity_z=1e-3),)),
        devices=(DetuningPendulum(40.0, 10.0, 0.4, 0.3),),
    )


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_second_derivative_at_zero_is_the_stiffness_of_section_3(seed: int) -> None:
    discretization = discretized(eventful_line(seed))
    stiffness = discretization.matrices.stiffness
    _, tangent = energy_derivatives(
        discretization.lines, discretization.profile, discretization.sections, np.zeros(stiffness.shape[:2])
    )
    assert np.abs(tangent - stiffness).max() <= 1e-12 * np.abs(stiffness).max()


def test_derivatives_agree_with_finite_differences_of_each_other() -> None:
    discretization = discretized(eventful_line(3))
    freedoms = discretization.matrices.stiffness.shape[-1]
    state: FloatArray = np.random.default_rng(4).normal(scale=0.3, size=(freedoms,))
    change = 1e-6 * np.eye(freedoms)

    def gradient(x: FloatArray) -> FloatArray:
        at_x, _ = energy_derivatives(discretization.lines, discretization.profile, discretization.sections, x[None])
        return np.asarray(at_x[0], dtype=np.float64)

    numerical = np.stack([(gradient(state + change[i]) - gradient(state - change[i])) / 2e-6 for i in range(freedoms)])
    _, tangent = energy_derivatives(discretization.lines, discretization.profile, discretization.sections, state[None])
    torsional = np.s_[THETA::FIELDS, THETA::FIELDS]
    assert np.abs(numerical - tangent[0]).max() <= 1e-8 * np.abs(tangent).max()
    assert np.abs((numerical - tangent[0])[torsional]).max() <= 1e-8 * np.abs(tangent[0][torsional]).max()


def test_small_twist_is_the_parabola_of_a_uniform_moment() -> None:
    line = single(60.0, 0.0, -1e-6)
    arc, angle = twist_of(line)
    moment = line.conductor.mass * GRAVITY * -1e-6
    exact = 0.5 * moment / line.conductor.torsional_rigidity * arc * (arc[-1] - arc)
    assert angle == pytest.approx(exact, rel=1e-5, abs=1e-12)


def test_small_twist_with_weight_above_the_centre_is_the_beam_columns() -> None:
    line = single(100.0, 2e-3, 1e-7)
    arc, angle = twist_of(line)
    k = wave_number(line, 2e-3)
    exact = 1e-7 / 2e-3 * (np.cos(k * (arc - 0.5 * arc[-1])) / math.cos(0.5 * k * arc[-1]) - 1.0)
    assert angle == pytest.approx(exact, rel=2e-3, abs=1e-8)


@pytest.mark.parametrize(("length", "twisted"), [(143.0, False), (145.0, True)])
def test_ice_straight_above_buckles_at_the_length_of_divergence(length: float, twisted: bool) -> None:
    """pi sqrt(GJ/(m g e)) is 144.3 m for the source's single conductor."""
    line = single(length, 2.05e-3, 0.0)
    assert math.pi / wave_number(line, 2.05e-3) == pytest.approx(144.35, abs=0.05)
    assert bool(np.abs(twist_of(line)[1]).max() > 0.1) is twisted


@pytest.mark.parametrize("length", [145.0, 160.0, 400.0])
def test_post_buckled_state_is_the_elastica_of_the_pendulum(length: float) -> None:
    """GJ Theta'' + m g e sin Theta = 0: k L/2 = K(sin(Theta_max/2)), sin(Theta/2) = sin(Theta_max/2) sn(k s)."""
    line = single(length, 2.05e-3, 0.0, elements=16)
    arc, angle = twist_of(line)
    k = wave_number(line, 2.05e-3)
    largest = brentq(lambda x: ellipk(math.sin(0.5 * x) ** 2) - 0.5 * k * arc[-1], 1e-6, math.pi - 1e-10)
    modulus = math.sin(0.5 * largest)
    exact = 2.0 * np.arcsin(modulus * ellipj(k * arc, modulus**2)[0])
    assert angle == pytest.approx(exact, rel=1e-3, abs=3e-4)


def test_ice_below_the_centre_hangs_as_it_is() -> None:
    assert np.abs(twist_of(single(1000.0, -2e-3, 0.0))[1]).max() < 1e-9


def test_sections_turn_to_the_side_of_the_weight() -> None:
    for e_z in (1e-3, -1e-3):
        _, angle = twist_of(single(300.0, 2e-3, e_z))
        assert np.sign(angle[1:-1]) == pytest.approx(np.sign(e_z))


@pytest.mark.parametrize("seed", range(3))
def test_no_start_leads_to_less_energy(seed: int) -> None:
    """Scipy's minimizer goes down from a spread of starts; the energy is integrated along the way it goes."""
    generator = np.random.default_rng(seed)
    length, e_y, e_z = generator.uniform(100.0, 350.0), generator.uniform(-3e-3, 3e-3), generator.uniform(-3e-3, 3e-3)
    discretization = discretized(single(float(length), float(e_y), float(e_z), elements=4))
    free = np.flatnonzero(~held_freedoms(discretization.profile, discretization.matrices.stiffness.shape[-1])[0])
    torsional = free[free % FIELDS == THETA]
    arc, wave = discretization.profile.arc_length[0], discretization.sections

    def energy(x: FloatArray) -> tuple[float, FloatArray]:
        whole = np.zeros((1, discretization.matrices.stiffness.shape[-1]))
        whole[0, torsional] = x
        gradient, _ = energy_derivatives(discretization.lines, discretization.profile, wave, whole)
        return _energy(discretization, whole[0]), gradient[0, torsional]

    def _energy(discretization: Discretization, x: FloatArray) -> float:
        nodes = np.linspace(0.0, arc, x.size // FIELDS)
        line = discretization.lines[0]
        fine = np.linspace(0.0, arc, 4001)
        element = np.minimum((fine / arc * 4).astype(int), 3)
        theta = np.zeros_like(fine)
        slope = np.zeros_like(fine)
        for e in range(4):
            cubic = np.polyfit(nodes[2 * e : 2 * e + 3], x[THETA::FIELDS][2 * e : 2 * e + 3], 2)
            theta[element == e] = np.polyval(cubic, fine[element == e])
            slope[element == e] = np.polyval(np.polyder(cubic), fine[element == e])
        weight = line.conductor.mass * GRAVITY
        density = 0.5 * line.conductor.torsional_rigidity * slope**2
        density += weight * (line.ice.eccentricity_y * np.cos(theta) - line.ice.eccentricity_z * np.sin(theta))
        return float(np.trapezoid(density, fine))

    state = twisted_state(discretization.lines, discretization.profile, discretization.sections)
    found = _energy(discretization, state.displacement[0])
    lowest = min(
        minimize(
            energy, generator.uniform(-4.0, 4.0, torsional.size), jac=True, method="BFGS", options={"gtol": 1e-4}
        ).fun
        for _ in range(5)
    )
    assert found <= lowest + 1e-4 * abs(lowest)


def test_bundle_turns_as_its_tension_lets_it() -> None:
    """With the strain of the sag left out, n GJ + T sum r^2 holds n m g e_z: the parabola again."""
    line = source_line(2)
    line = replace(line, span=replace(line.span, length=60.0, horizontal_tension=3e5), ice=Ice(ICE_AT_40, 0.0, 1e-3))
    line = replace(line, bundle=Bundle(((-0.2, 0.0), (0.2, 0.0))))
    arc, angle = twist_of(line)
    stiffness = 2.0 * line.conductor.torsional_rigidity + 3e5 * 2.0 * 0.04
    exact = 2.0 * line.conductor.mass * GRAVITY * 1e-3 / stiffness * arc[-1] ** 2 / 8.0
    assert angle.max() == pytest.approx(exact, rel=0.01)


def test_pendulum_at_an_angle_turns_the_section_towards_the_vertical() -> None:
    line = replace(single(100.0, 0.0, 0.0), devices=(DetuningPendulum(50.0, 3.0, 0.5, 0.5 * math.pi),))
    arc, angle = twist_of(line)
    middle = float(angle[angle.size // 2])
    torque = 3.0 * GRAVITY * 0.5 * math.cos(middle)
    assert middle == pytest.approx(torque * arc[-1] / (4.0 * line.conductor.torsional_rigidity), rel=1e-6)
    assert 0.5 < middle < 0.5 * math.pi


def test_mass_and_stiffness_are_those_of_a_line_iced_as_it_hangs() -> None:
    """A pendulum whose weight turns the section rigidly: a line that is built turned has the same matrices."""
    line = replace(single(100.0, 0.0, 0.0), devices=(DetuningPendulum(50.0, 3.0, 0.5, 0.4),))
    discretization = discretize((line,), StaticTwist.SOLVED)
    assert discretization.twist is not None
    middle = float(discretization.twist.angle[0, 10])
    hanging = replace(line, devices=(DetuningPendulum(50.0, 3.0, 0.5, 0.4 - middle),))
    plain = discretized(hanging).matrices
    assert discretization.matrices.mass == pytest.approx(plain.mass, rel=1e-12, abs=1e-12)
    assert discretization.matrices.stiffness == pytest.approx(plain.stiffness, rel=1e-9, abs=1e-3)
    assert discretization.matrices.stiffness[0, THETA::FIELDS, THETA::FIELDS] == pytest.approx(
        plain.stiffness[0, THETA::FIELDS, THETA::FIELDS], rel=1e-9, abs=1e-9
    )


def test_lines_of_a_stack_do_not_touch() -> None:
    lines = (single(120.0, 2e-3, -1e-3), single(300.0, 2e-3, 1e-3), source_line(4))
    together = discretized(*lines)
    state = twisted_state(together.lines, together.profile, together.sections)
    for i, line in enumerate(lines):
        assert state.angle[i] == pytest.approx(twist_of(line)[1], abs=1e-9)


def circle() -> MeasuredCoefficients:
    """Return smooth coefficients over the whole circle, the untwisted section at 40 degrees."""
    angle = np.radians(np.arange(-180.0, 180.0, 3.0))
    columns = (np.sin(2.0 * angle), 1.2 + 0.5 * np.cos(2.0 * angle), 0.3 * np.sin(angle))
    rows = [tuple(column.tolist()) for column in (angle, *columns)]
    return MeasuredCoefficients(rows[0], rows[1], rows[2], rows[3], math.radians(40.0), math.radians(15.0))


def test_a_long_single_span_rests_twisted_where_small_twist_diverges() -> None:
    line = single(250.0, 2.05e-3, -0.63e-3)
    asked = Analysis(loops=(1,), wind_speeds=(4.0,), finite_element_loops=(1, 2))
    small, whole = run(line, asked), run(line, replace(asked, static_twist=StaticTwist.SOLVED))
    assert {row.outcome for row in small.limit_cycles} == {Outcome.STATICALLY_UNSTABLE}
    assert small.static.twist_rad is None
    assert whole.static.twist_rad == pytest.approx(twist_of(line)[1].min(), rel=1e-9)
    assert Outcome.STATICALLY_UNSTABLE not in {row.outcome for row in whole.limit_cycles}
    assert all(row.torsional_hz is not None and row.torsional_hz > 0.0 for row in whole.frequencies)


def test_torsional_frequency_of_the_twisted_state_is_that_of_small_swings_about_it() -> None:
    """The first mode of Jacobi's accessory equation GJ f'' + (w^2 I - m g e_y(s)) f = 0, by finite differences."""
    line = single(250.0, 2.05e-3, -0.63e-3, elements=16)
    discretization = discretize((line,), StaticTwist.SOLVED)
    assert discretization.twist is not None
    arc = float(discretization.profile.arc_length[0])
    nodes = np.linspace(0.0, arc, 33)
    fine = np.linspace(0.0, arc, 2001)[1:-1]
    angle = np.interp(fine, nodes, discretization.twist.angle[0])
    upward = 2.05e-3 * np.cos(angle) + 0.63e-3 * np.sin(angle)
    step = fine[1] - fine[0]
    main = 2.0 * line.conductor.torsional_rigidity / step**2 - line.conductor.mass * GRAVITY * upward
    side = np.full(fine.size - 1, -line.conductor.torsional_rigidity / step**2)
    lowest = eigh_tridiagonal(main, side, select="i", select_range=(0, 0), eigvals_only=True)[0]
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1,))
    assert shapes.angular_frequency[0, 0, 2] == pytest.approx(
        math.sqrt(lowest / line.conductor.polar_inertia), rel=2e-3
    )


def test_a_table_is_fitted_at_the_local_angle() -> None:
    measured = circle()
    line = replace(single(200.0, 2.05e-3, -0.63e-3), ice=Ice(fit_measured(measured), 2.05e-3, -0.63e-3))
    discretization = discretize((line,), StaticTwist.SOLVED)
    twist = discretization.sections.twist[0]
    place = np.unravel_index(np.abs(twist).argmax(), twist.shape)
    expected = fit_measured(measured, float(twist[place]))
    assert abs(twist[place]) > 1.0
    assert discretization.sections.aerodynamics[0][place][0, 1:] == pytest.approx(expected.vertical, rel=1e-12)
    assert discretization.sections.aerodynamics[0][place][:, 0] == pytest.approx(expected.at_rest, rel=1e-12)
    at_rest = discretize((line,)).sections.aerodynamics[0]
    assert at_rest[..., 0, 1:] == pytest.approx(np.broadcast_to(fit_measured(measured).vertical, (*twist.shape, 3)))


def test_a_table_that_does_not_reach_the_local_angle_is_refused_with_that_angle() -> None:
    whole = circle()
    part = [i for i, a in enumerate(whole.angle) if 0.3 < a < 1.1]
    columns = [tuple(column[i] for i in part) for column in (whole.angle, whole.lift, whole.drag, whole.moment)]
    measured = MeasuredCoefficients(
        columns[0], columns[1], columns[2], columns[3], whole.static_angle, whole.half_range
    )
    line = replace(single(200.0, 2.05e-3, -0.63e-3), ice=Ice(fit_measured(measured), 2.05e-3, -0.63e-3))
    with pytest.raises(InvalidSpec, match=r"static angle \(1\d\.\d deg\)"):
        discretize((line,), StaticTwist.SOLVED)


def test_only_lines_that_turn_far_are_twisted_where_that_is_asked_for() -> None:
    lines = (single(300.0, 2.05e-3, -0.63e-3), source_line(2), single(300.0, 2.05e-3, 0.0), single(100.0, 0.0, 0.0))
    found, solved = discretize(lines, StaticTwist.WHERE_LARGE), discretize(lines, StaticTwist.SOLVED)
    plain = discretize(lines)
    assert found.twist is not None
    assert solved.twist is not None
    assert list(found.twist.outcome) == [Outcome.CONVERGED, None, Outcome.CONVERGED, None]
    for i, expected in enumerate((solved, plain, solved, plain)):
        for name in ("stiffness", "mass"):
            here, there = getattr(found.matrices, name)[i], getattr(expected.matrices, name)[i]
            assert here == pytest.approx(there, rel=1e-9, abs=1e-9 * np.abs(there).max())
    assert discretize(lines[1:2], StaticTwist.WHERE_LARGE).twist is None


def test_a_span_that_ice_turns_over_has_motions_under_full_physics() -> None:
    """The example that was statically unstable in every row: 300 m of a single conductor."""
    known = replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0))
    line = replace(single(300.0, 2.05e-3, -0.63e-3), ice=Ice(known, 2.05e-3, -0.63e-3))
    asked = with_physics(line, Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(4.0,)), PhysicsRequest())
    result = run(line, asked)
    assert Outcome.STATICALLY_UNSTABLE not in {row.outcome for row in result.limit_cycles}
    assert result.static.twist_rad == pytest.approx(twist_of(line)[1].min(), rel=1e-9)
    assert not any("static_twist" in text for text in result.warnings)
