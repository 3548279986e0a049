"""Branches of tori: born at an exact torus point, and from one torus point of a line to the other."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles.bifurcations import bifurcations
from engine.cycles.branches import follow_from_hopf_points, guessed_points
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.tori.spectrum import base_frequencies, base_lines, line_strengths
from engine.tori.torus_branches import follow_tori, starts_at_torus_points
from engine.tori.two_frequency_balance import balance, harmonic_lattice, phasors, resized, tori_of
from tests.engine.coupled_circles import FREQUENCIES, coupled_circles
from tests.engine.integrated_tori import followed
from tests.engine.motions import LIGHT, analysed

ONE = np.zeros(1, dtype=np.intp)
COUPLING, LINEAR = (0.4, 1.0), (2.0, 3.0)


def averaged(wind: float) -> FloatArray:
    """Return the radii of `coupled_circles` to first order in the growth.

    The mean of U q^2 + q'^2 / (U w^2) beside q' is r^2 (U + 3 / U) / 4 in its own motion, r^2 (U + 1 / U) / 2 in that
    of the other.
    """
    own, other = 0.25 * (wind + 3.0 / wind), 0.5 * (wind + 1.0 / wind)
    matrix = [[own, COUPLING[0] * other], [COUPLING[1] * other, own]]
    return np.asarray(np.sqrt(np.linalg.solve(matrix, [slope * wind - slope + 1.0 for slope in LINEAR])))


def test_branch_from_an_exact_torus_point() -> None:
    # The first oscillator alone runs on a circle of radius 1 at U = 1, where it just holds the second one at rest.
    model, winds = coupled_circles(COUPLING, LINEAR), np.array([1.02, 1.2])
    crossings = critical_wind_speeds(model, 5.0)
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 5, winds)
    found = bifurcations((branch_set,), ONE, model, crossings)
    births = starts_at_torus_points(model, (branch_set,), found, np.ones(found.member.size, dtype=np.bool_), (3, 2))
    assert births.tori.wind_speed == pytest.approx([1.0], abs=1e-6)
    points = follow_tori(model, births, winds)
    _, wind, guess = guessed_points(points, winds)
    tori, solution = balance(model, np.zeros(2, dtype=np.intp), tori_of(guess, 2, (3, 2)))
    assert solution.converged.all()
    assert wind.tolist() == [0, 1]
    for i, speed in enumerate(winds):
        torus = tori.select(np.array([i]))
        assert base_frequencies(model, ONE, torus)[0] == pytest.approx(np.array([FREQUENCIES]), rel=2e-3)
        lines = base_lines(line_strengths(model, ONE, torus)[0], harmonic_lattice(torus.order).pairs)
        amplitude = np.abs(phasors(torus.coefficients[0]))
        assert amplitude[[0, 1], lines] == pytest.approx(averaged(speed), rel=0.01)


def test_a_multiple_of_another_line_is_no_base_line() -> None:
    pairs = harmonic_lattice((3, 2)).pairs
    strengths = np.zeros(len(pairs))
    for strength, pair in enumerate([(1, 1), (1, 0), (2, 0)], start=1):
        strengths[(pairs == pair).all(axis=-1)] = strength
    assert pairs[base_lines(strengths, pairs)].tolist() == [[1, 0], [1, 1]]


def test_branch_joins_both_torus_points_of_the_single_conductor() -> None:
    model, cycles, found = analysed(1, LIGHT, 2)
    births = starts_at_torus_points(model, cycles.branch_sets, found, found.may_end_stability, (3, 2))
    assert sorted(births.tori.wind_speed) == pytest.approx([7.8004, 10.1183], abs=1e-3)
    winds = np.array([7.0, 9.0, 12.0])
    points = follow_tori(model, births, winds)
    for branch in (0, 1):  # from one end to the other, where it turns into the other cycle
        wind = points.z[points.branch == branch, -1]
        assert (wind.min(), wind.max()) == pytest.approx((7.80, 10.12), abs=0.02)
    _, at, guess = guessed_points(points, winds)
    assert at.tolist() == [1, 1]
    tori, solution = balance(model, np.zeros(2, dtype=np.intp), resized(tori_of(guess, 3, (3, 2)), (5, 4)))
    assert solution.converged.all()
    frequencies, _ = base_frequencies(model, np.zeros(2, dtype=np.intp), tori)
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-6)
    reached, expected = followed(model, tori.select(np.array([0])), 60.0)
    assert reached == pytest.approx(expected, abs=2e-4 * np.abs(expected).max())
