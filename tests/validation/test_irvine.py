"""Irvine and Caughey's linear theory of the shallow cable with fixed ends, theory section 11.

The theory leaves out longitudinal inertia and holds for a small sag. So U is condensed without its inertia, and the sag
ratios are so small (EA/H is 1e7) that terms of the order of (p L/H)^2 stay below the differences judged here.
"""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.modes import directional_shapes
from engine.mechanics.static_profile import static_profile
from engine.spec import Line
from tests.builders import discretized, tight_line

RIGIDITY_RATIO = 1e7
PRINTED_ROOTS = {1.0: 1.0402, 10.0: 1.345125, 4.0 * np.pi**2: 2.0, 100.0: 2.597185}


def parameter(line: Line) -> float:
    """Return lam2 of theory section 11 from the line's own numbers."""
    assert line.span.horizontal_tension is not None
    profile = static_profile((line,))
    length, tension = line.span.length, line.span.horizontal_tension
    load_ratio = line.conductor.mass * 9.81 * length / tension
    virtual_length = length * (1.0 + 8.0 * (profile.sag[0] / length) ** 2)
    return float(load_ratio**2 * length * line.conductor.axial_rigidity / (tension * virtual_length))


def line_with(lam2: float, elements: int) -> Line:
    """Return a line of this lam2 = (8 sag/L)^2 EA/H, up to the square of the sag ratio."""
    return tight_line(sag_ratio=np.sqrt(lam2 / RIGIDITY_RATIO) / 8.0, rigidity_ratio=RIGIDITY_RATIO, elements=elements)


def first_symmetric_root(lam2: float) -> float:
    """Solve tan(W/2) = W/2 - (4/lam2)(W/2)^3 for its first root beyond the zero at W = 0."""

    def equation(half: float) -> float:
        return float(np.sin(half) - np.cos(half) * (half - 4.0 / lam2 * half**3))

    return 2.0 * float(brentq(equation, 0.5 * np.pi, 1.5 * np.pi - 1e-9, xtol=1e-14))


def in_plane(line: Line) -> tuple[FloatArray, FloatArray]:
    """Return W = w L sqrt(m/H) of the symmetric and the antisymmetric in-plane modes, with U without inertia."""
    system = discretized(line).matrices
    free = np.flatnonzero(~system.fixed[0])
    along, up = free[free % FIELDS == U], free[free % FIELDS == V]
    stiffness, mass = system.stiffness[0], system.mass[0]
    follow = np.linalg.solve(stiffness[np.ix_(along, along)], stiffness[np.ix_(along, up)])
    condensed = stiffness[np.ix_(up, up)] - stiffness[np.ix_(up, along)] @ follow
    values, vectors = eigh(condensed, mass[np.ix_(up, up)])
    even = np.einsum("ai,ai->i", vectors, vectors[::-1]) > 0.0
    numbers = np.sqrt(values) * unit(line)
    return numbers[even], numbers[~even]


def unit(line: Line) -> float:
    """Return L sqrt(m/H), which turns an angular frequency into W."""
    assert line.span.horizontal_tension is not None
    return float(line.span.length * np.sqrt(line.conductor.mass / line.span.horizontal_tension))


@pytest.mark.parametrize(("lam2", "printed"), PRINTED_ROOTS.items())
def test_section_11_printed_roots_solve_the_transcendental_equation(lam2: float, printed: float) -> None:
    assert first_symmetric_root(lam2) / np.pi == pytest.approx(printed, abs=6e-5)  # printed to 4 decimals at least


def test_section_11_root_for_an_inextensible_cable() -> None:
    assert first_symmetric_root(1e9) / np.pi == pytest.approx(2.8606, abs=6e-5)


@pytest.mark.parametrize("lam2", [*PRINTED_ROOTS, 400.0])
def test_section_11_first_symmetric_frequency(lam2: float) -> None:
    line = line_with(lam2, 40)
    symmetric, _ = in_plane(line)
    # 40 quadratic elements: the error that the convergence test below sees is 1e-6 at lam2 = 100 and 8e-6 at 400.
    assert symmetric[0] == pytest.approx(first_symmetric_root(parameter(line)), rel=1e-5)


@pytest.mark.parametrize("lam2", [1.0, 10.0, 100.0])
def test_section_11_frequency_converges_at_the_fourth_order(lam2: float) -> None:
    error = []
    for elements in (5, 10, 20):
        line = line_with(lam2, elements)
        error.append(in_plane(line)[0][0] / first_symmetric_root(parameter(line)) - 1.0)
    # Quadratic elements: eigenvalues converge as h^4, from above as Rayleigh-Ritz; two-point quadrature keeps that.
    # Five elements lie before the asymptotic range when the cable is bent most (3.76 at lam2 = 100).
    coarse, fine = np.log2(np.array(error[:-1]) / np.array(error[1:]))
    assert coarse == pytest.approx(4.0, abs=0.3)
    assert fine == pytest.approx(4.0, abs=0.1)
    assert min(error) > 0.0


def string_numbers(loops: list[int], elements: int) -> FloatArray:
    """Return W/pi of a string in quadratic elements: k (1 + (k pi/elements)^4/1440), the element's dispersion."""
    k = np.array(loops, dtype=np.float64)
    return np.asarray(k * (1.0 + (k * np.pi / elements) ** 4 / 1440.0))


@pytest.mark.parametrize("lam2", [1.0, 100.0])
def test_section_11_antisymmetric_frequencies(lam2: float) -> None:
    _, antisymmetric = in_plane(line_with(lam2, 20))
    # Beside the element's dispersion there is only the sag, which enters by (p L/H)^2 = 1e-5 times a small number.
    assert antisymmetric[:2] / np.pi == pytest.approx(string_numbers([2, 4], 20), rel=3e-6)


@pytest.mark.parametrize("lam2", [1.0, 100.0])
def test_section_11_out_of_plane_frequencies(lam2: float) -> None:
    line = line_with(lam2, 20)
    system = discretized(line).matrices
    free = np.flatnonzero(~system.fixed[0])
    across = free[free % FIELDS == W]
    select = np.ix_(across, across)
    values = eigh(system.stiffness[0][select], system.mass[0][select], eigvals_only=True)
    assert np.sqrt(values[:3]) * unit(line) / np.pi == pytest.approx(string_numbers([1, 2, 3], 20), rel=3e-6)


def test_section_11_torsion_of_a_single_conductor_is_that_of_a_rod() -> None:
    line = line_with(1.0, 20)
    system = discretized(line).matrices
    free = np.flatnonzero(~system.fixed[0])
    turns = free[free % FIELDS == THETA]
    select = np.ix_(turns, turns)
    values = eigh(system.stiffness[0][select], system.mass[0][select], eigvals_only=True)
    rod = np.pi / line.span.length * np.sqrt(line.conductor.torsional_rigidity / line.conductor.polar_inertia)
    assert np.sqrt(values[:3]) == pytest.approx(rod * string_numbers([1, 2, 3], 20), rel=3e-6)


@pytest.mark.parametrize("lam2", [20.0, 60.0, 100.0])
def test_section_11_shapes_carry_the_right_label_on_both_sides_of_the_cross_over(lam2: float) -> None:
    line = line_with(lam2, 20)
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2))
    found = shapes.angular_frequency[0, :, 0] * unit(line)
    # The longitudinal inertia that the full matrices keep changes the frequencies by less than H/EA = 1e-7.
    assert found == pytest.approx([first_symmetric_root(parameter(line)), 2.0 * np.pi], rel=3e-5)
