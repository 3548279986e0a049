"""Free sections against a field U_i for every sub-conductor in the same elements."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space

from engine.arrays import FloatArray
from engine.mechanics.cross_sections import sections
from engine.mechanics.finite_elements import FIELDS, THETA, Matrices, matrices
from engine.mechanics.free_sections import differences, second_moments
from engine.mechanics.interpolation import strain_points
from engine.mechanics.static_profile import static_profile
from engine.spec import BlowOut, Bundle, CrossSection, Ice, Line, Support, Supports, Yoke
from tests.builders import ICE_AT_40, random_line, source_line


def with_section(line: Line, section: CrossSection) -> Line:
    """Return a line whose section moves in this way."""
    return replace(line, bundle=replace(line.bundle, section=section))


def assembled(*lines: Line) -> Matrices:
    """Return the matrices of lines in X, Y and Z, also of blown-out ones."""
    profile = static_profile(lines)
    return matrices(lines, profile, sections(lines, profile))


def with_yokes(line: Line, left: Support, right: Support) -> Line:
    """Return a line with these ends."""
    return replace(line, supports=Supports(left=left, right=right))


def odd_line(seed: int) -> Line:
    """Draw a blown-out line of free sections without ice's offset: any positions, coupling, each kind of yoke."""
    generator = np.random.default_rng(seed)
    line = random_line(generator)
    positions = tuple((float(y), float(z)) for y, z in generator.normal(scale=0.3, size=(generator.integers(2, 6), 2)))
    ends = (
        Support(dead_end=True),
        Support(dead_end=True, yoke=Yoke.FREE),
        Support(insulator_length=2.0),
        Support(yoke=Yoke.FREE, adjacent_span=200.0),
    )
    left, right = (ends[i] for i in generator.integers(0, 4, size=2))
    return replace(
        line,
        conductor=replace(line.conductor, axial_torsional_coupling=500.0),
        bundle=Bundle(positions, CrossSection.FREE),
        ice=Ice(ICE_AT_40),
        wind=replace(line.wind, blow_out=BlowOut(20.0, 1.0)),
        supports=Supports(left=left, right=right),
    )


def with_own_fields(line: Line) -> tuple[FloatArray, FloatArray]:
    """Return K of section 3 with a field U_i for every sub-conductor, condensed onto mean U, V, W and Theta.

    Beside it what the condensed motion adds to M.
    """
    profile = static_profile((line,))
    at = strain_points((line,), profile)
    n, elements = len(line.bundle.positions), line.span.elements
    nodes, conductor = 2 * elements + 1, line.conductor
    stiffness = np.zeros((n + 3, nodes, n + 3, nodes))  # U_1 to U_n, V, W, Theta

    def slope(field: int, element: int, point: int) -> FloatArray:
        form = np.zeros((n + 3, nodes))
        form[field, 2 * element : 2 * element + 3] = at.slopes[0, element, point]
        return form

    for e, p in np.ndindex(elements, 2):
        x, y, z = at.direction[0, e, p]
        turn = slope(n + 2, e, p)
        for i, (y_i, z_i) in enumerate(line.bundle.positions):
            moves = slope(i, e, p), slope(n, e, p) - z_i * turn, slope(n + 1, e, p) + y_i * turn
            strain = x * moves[0] + y * moves[1] + z * moves[2]
            terms = [(conductor.axial_rigidity, strain, strain), (conductor.torsional_rigidity, turn, turn)]
            terms += [(conductor.axial_torsional_coupling, a, b) for a, b in ((strain, turn), (turn, strain))]
            terms += [(at.tension[0, e, p], move, move) for move in moves]
            for factor, a, b in terms:
                stiffness += factor * at.weight[0, e, p] * np.multiply.outer(a, b)
    about_mean = np.eye(n) - 1.0 / n
    held = []
    for end, node in ((0, 0), (1, nodes - 1)):
        if np.isfinite(profile.end_stiffness[0, end]):
            stiffness[:n, node, :n, node] += profile.end_stiffness[0, end] / n
        if np.isfinite(profile.yoke_stiffness[0, end]):
            stiffness[:n, node, :n, node] += profile.yoke_stiffness[0, end] * about_mean
        else:
            held.append(node)
    # U_i = U + differences of no sum, none at a held yoke.
    spread = np.zeros((n + 3, FIELDS))
    spread[:n, 0] = spread[n, 1] = spread[n + 1, 2] = spread[n + 2, 3] = 1.0
    common = np.einsum("fc,ab->fabc", spread, np.eye(nodes)).reshape((n + 3) * nodes, nodes * FIELDS)
    apart = np.zeros((n + 3, n - 1))
    apart[:n] = null_space(np.ones((1, n)))
    moving = np.delete(np.eye(nodes), held, axis=1)
    along = assembled(with_section(line, CrossSection.RIGID)).mass[0, ::FIELDS, ::FIELDS] / n
    if not profile.yoke_stiffness.any():
        moving = null_space(along.sum(axis=0, keepdims=True))  # nothing holds the differences: their mean is zero
    own = np.einsum("fd,ab->fabd", apart, moving).reshape((n + 3) * nodes, -1)
    flat = stiffness.reshape((n + 3) * nodes, -1)
    follow = -own @ np.linalg.solve(own.T @ flat @ own, own.T @ flat @ common)
    whole = common + follow
    each = follow.reshape(n + 3, nodes, -1)[:n]
    return np.asarray(whole.T @ flat @ whole), np.einsum("ina,nm,imb->ab", each, along, each)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6))
def test_an_own_field_for_every_sub_conductor_gives_the_same_matrices(seed: int) -> None:
    line = odd_line(seed)
    expected, inertia = with_own_fields(line)
    torsional = np.s_[THETA::FIELDS, THETA::FIELDS]
    found, rigid = (assembled(x) for x in (line, with_section(line, CrossSection.RIGID)))
    stiffness = found.stiffness[0]
    assert np.abs(stiffness - expected).max() <= 1e-9 * np.abs(expected).max()
    assert np.abs((stiffness - expected)[torsional]).max() <= 1e-7 * np.abs(expected[torsional]).max()
    assert found.mass[0] - rigid.mass[0] == pytest.approx(inertia, abs=1e-8 * np.abs(inertia).max())


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_freedom_takes_stiffness_from_torsion_adds_inertia_and_changes_nothing_else(seed: int) -> None:
    line = odd_line(seed)
    free, rigid = (assembled(with_section(line, kind)) for kind in (CrossSection.FREE, CrossSection.RIGID))
    for before, after, sign in ((rigid.stiffness, free.stiffness, -1.0), (rigid.mass, free.mass, 1.0)):
        change = sign * (after - before)[0]
        values = np.linalg.eigvalsh(change[THETA::FIELDS, THETA::FIELDS])
        assert values.min() >= -1e-10 * values.max()
        change[THETA::FIELDS, THETA::FIELDS] = 0.0
        assert not change.any()


def test_a_rigid_section_is_the_default_and_one_conductor_has_no_other() -> None:
    rigid = source_line(2)
    assert rigid.bundle.section is None
    for line in (rigid, with_section(rigid, CrossSection.RIGID), with_section(source_line(1), CrossSection.FREE)):
        apart = differences((line,), static_profile((line,)), np.linspace(0.0, 1.0, 21)[None])
        assert not any(values.any() for values in (apart.gradient, apart.tangent, apart.inertia(np.ones((1, 21, 21)))))


def test_a_stack_of_rigid_and_free_sections_is_that_of_its_lines() -> None:
    lines = [with_section(source_line(n), kind) for n in (2, 3) for kind in CrossSection]
    together = assembled(*lines).stiffness
    for line, stiffness in zip(lines, together, strict=True):
        assert np.array_equal(assembled(line).stiffness[0], stiffness)


def test_derivatives_by_a_large_twist_agree_with_finite_differences() -> None:
    lines = (odd_line(5), replace(odd_line(6), span=odd_line(5).span))
    profile = static_profile(lines)
    twist = np.random.default_rng(7).normal(scale=0.6, size=(2, 21))
    tangent = differences(lines, profile, twist).tangent
    ends = [[differences(lines, profile, twist + step).gradient for step in (h, -h)] for h in 1e-6 * np.eye(21)]
    numerical = np.stack([(above - below) / 2e-6 for above, below in ends], axis=1)
    assert np.abs(numerical - tangent).max() <= 1e-8 * np.abs(tangent).max()


def energy_of_fields(line: Line, twist: FloatArray) -> float:
    """Return the least energy over the differences of fields U_i at a given twist of the nodes, less the rigid one."""
    profile = static_profile((line,))
    at = strain_points((line,), profile)
    rigidity, elements = line.conductor.axial_rigidity, line.span.elements
    about_mean = np.array(line.bundle.positions) - np.mean(line.bundle.positions, axis=0)
    matrix, right = np.zeros((twist.size, twist.size)), np.zeros((len(about_mean), twist.size))
    for e, p in np.ndindex(elements, 2):
        here = slice(2 * e, 2 * e + 3)
        x, y, z = at.direction[0, e, p]
        slopes, weight = at.slopes[0, e, p], at.weight[0, e, p]
        turn, rate = at.values[p] @ twist[here], slopes @ twist[here]
        c, s = np.cos(turn), np.sin(turn)
        strain = [(z * (c * eta - s * zeta) - y * (s * eta + c * zeta)) * rate for eta, zeta in about_mean]
        matrix[here, here] += weight * (rigidity * x**2 + at.tension[0, e, p]) * np.outer(slopes, slopes)
        right[:, here] += weight * rigidity * x * np.outer(strain, slopes)
    for end, node in ((0, 0), (1, -1)):
        spring = profile.yoke_stiffness[0, end]
        matrix[node, node] += spring if np.isfinite(spring) else 1e6 * np.abs(matrix).max()
    return float(-0.5 * (right * np.linalg.lstsq(matrix, right.T, rcond=1e-14)[0].T).sum())


@pytest.mark.parametrize("seed", range(6))
def test_energy_of_a_large_twist_is_the_least_one_of_own_fields(seed: int) -> None:
    line = odd_line(seed)
    twist = np.random.default_rng(seed).normal(scale=0.6, size=21)
    abscissae, weights = np.polynomial.legendre.leggauss(24)
    profile = static_profile((line,))
    along = [differences((line,), profile, 0.5 * (1.0 + t) * twist[None]).gradient[0] @ twist for t in abscissae]
    assert 0.5 * weights @ along == pytest.approx(energy_of_fields(line, twist), rel=1e-6)


def test_section_turned_as_a_whole_is_that_of_the_turned_positions() -> None:
    line = odd_line(8)
    angle = 0.7
    c, s = np.cos(angle), np.sin(angle)
    turned = Bundle(tuple((c * y - s * z, s * y + c * z) for y, z in line.bundle.positions), CrossSection.FREE)
    profile = static_profile((line,))
    found = differences((line,), profile, np.full((1, 21), angle))
    expected = differences((replace(line, bundle=turned),), profile, np.zeros((1, 21)))
    assert found.tangent == pytest.approx(expected.tangent, abs=1e-12 * np.abs(expected.tangent).max())
    along = assembled(line).mass[:, ::FIELDS, ::FIELDS]
    assert found.inertia(along) == pytest.approx(expected.inertia(along), abs=1e-12 * np.abs(along).max())


def test_second_moments_are_about_the_mean_position() -> None:
    line = replace(source_line(2), bundle=Bundle(((1.0, 2.0), (1.0, 3.0), (4.0, 2.5)), CrossSection.FREE))
    assert second_moments((line,))[0] == pytest.approx(np.array([[6.0, 0.0], [0.0, 0.5]]))
