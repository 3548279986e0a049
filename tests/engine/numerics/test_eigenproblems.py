"""Symmetric eigenproblems: solutions, and bounds on the error of approximate vectors."""

import numpy as np
import pytest

from engine.numerics.eigenproblems import eigenvalues_alone, largest_sines, solve_symmetric


def test_symmetric_problem_is_solved_with_vectors_orthonormal_in_the_mass() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 4, 6, 6))
    stiffness, mass = a + a.swapaxes(-1, -2), b @ b.swapaxes(-1, -2) + np.eye(6)
    values, vectors = solve_symmetric(stiffness, mass)
    assert stiffness @ vectors == pytest.approx(mass @ vectors * values[:, None], abs=1e-10)
    assert vectors.swapaxes(-1, -2) @ mass @ vectors == pytest.approx(np.broadcast_to(np.eye(6), (4, 6, 6)), abs=1e-11)
    assert (np.diff(values, axis=-1) >= 0.0).all()


@pytest.mark.parametrize("size", [1, 24, 25, 78])
def test_eigenvalues_alone_are_those_of_the_solution(size: int) -> None:
    generator = np.random.default_rng(size)
    a, b = generator.normal(size=(2, 3, size, size))
    stiffness, mass = a + a.swapaxes(-1, -2), b @ b.swapaxes(-1, -2) + size * np.eye(size)
    values, vectors = solve_symmetric(stiffness, mass)
    assert eigenvalues_alone(stiffness, mass) == pytest.approx(values, rel=1e-10, abs=1e-12)
    assert stiffness @ vectors == pytest.approx(mass @ vectors * values[:, None], abs=1e-9)


def test_no_vector_of_a_subspace_is_farther_away_than_its_bound() -> None:
    generator = np.random.default_rng(0)
    values = np.cumsum(generator.uniform(0.05, 1.0, size=(200, 12)), axis=-1)
    near = np.eye(12)[:, :5] + 0.02 * generator.normal(size=(200, 12, 5))
    basis, _ = np.linalg.qr(near)
    across = basis.swapaxes(-1, -2)
    approximate, inside = np.linalg.eigh(across @ (values[..., None] * basis))
    cosines = np.abs(np.einsum("lii->li", (basis @ inside)[:, :5]))
    bounds = largest_sines(approximate, values)
    assert (np.sqrt(1.0 - cosines**2) <= bounds).all()
    assert np.median(bounds) < 0.5  # they tell something


def test_equal_eigenvalues_leave_the_vector_open() -> None:
    (bounds,) = largest_sines(np.array([[1.0, 1.0, 4.0]]), np.array([[1.0, 1.0, 4.0, 9.0]]))
    assert not np.isfinite(bounds[:2]).any()
    assert bounds[2] == 0.0
