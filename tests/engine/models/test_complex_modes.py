"""Modes in wind and the derivatives of their eigenvalues, against the eigenproblem of the whole state."""

import numpy as np
import pytest

from engine.arrays import ComplexArray, FloatArray
from engine.models.complex_modes import complex_modes, followed_eigenvalues

COUNT, COORDINATES = 20, 4


def blocks(generator: np.random.Generator) -> FloatArray:
    """Return random lower halves of matrices of the state (q, q'), with zeros above: (COUNT, 2 m, 2 m)."""
    lower = generator.normal(size=(COUNT, COORDINATES, 2 * COORDINATES))
    return np.concatenate([np.zeros_like(lower), lower], axis=1)


def states(generator: np.random.Generator) -> FloatArray:
    """Return matrices A of oscillators with frequencies of 3 to 6 rad/s, coupled at random: (COUNT, 2 m, 2 m)."""
    matrices = blocks(generator)
    matrices[:, :COORDINATES, COORDINATES:] = np.eye(COORDINATES)
    matrices[:, COORDINATES:, :COORDINATES] -= 9.0 * np.diag(np.arange(1.0, COORDINATES + 1.0))
    return matrices


def fastest(matrices: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """Return the eigenvalue of the largest imaginary part of each matrix, and its vector."""
    values, vectors = np.linalg.eig(matrices)
    row, top = np.arange(COUNT), values.imag.argmax(axis=-1)
    return values[row, top], vectors[row, :, top]


def test_modes_are_the_displacements_of_the_eigenvectors() -> None:
    matrices = states(np.random.default_rng(1))
    value, vector = fastest(matrices)
    found = complex_modes(matrices, value)
    expected = vector[:, :COORDINATES] / np.linalg.norm(vector[:, :COORDINATES], axis=-1, keepdims=True)
    assert np.abs(np.einsum("ki,ki->k", found.conj(), expected)) == pytest.approx(np.ones(COUNT), rel=1e-12)
    assert np.linalg.norm(found, axis=-1) == pytest.approx(np.ones(COUNT), rel=1e-12)


def test_modes_of_equal_oscillators_that_move_against_each_other_are_found_too() -> None:
    """Their left vectors are orthogonal to any motion in which both take equal parts."""
    generator = np.random.default_rng(4)
    own, spring = generator.uniform(1.0, 100.0, COUNT), generator.uniform(0.1, 10.0, COUNT)
    matrices = np.zeros((COUNT, 4, 4))
    matrices[:, :2, 2:] = np.eye(2)
    matrices[:, 2:, :2] = spring[:, None, None] * np.array([[-1.0, 1.0], [1.0, -1.0]]) - own[:, None, None] * np.eye(2)
    matrices[:, 2:, 2:] = -0.01 * np.eye(2)
    value = -0.005 + 1j * np.sqrt(own + 2.0 * spring - 0.005**2)
    found = complex_modes(matrices, value)
    against = np.abs(found @ np.array([1.0, -1.0])) / np.sqrt(2.0)
    assert against == pytest.approx(np.ones(COUNT), rel=1e-12)


def test_a_step_squares_the_error_of_an_eigenvalue() -> None:
    matrices = states(np.random.default_rng(2))
    value, _ = fastest(matrices)
    found, _ = followed_eigenvalues(matrices, np.zeros_like(matrices), value * (1.0 + 1e-5))
    assert np.abs(found / value - 1.0).max() < 1e-8
    again, _ = followed_eigenvalues(matrices, np.zeros_like(matrices), found)
    assert np.abs(again / value - 1.0).max() < 1e-13


def test_derivatives_are_the_differences_of_eigenvalues() -> None:
    generator = np.random.default_rng(3)
    matrices, slopes = states(generator), blocks(generator)
    above, below = (fastest(matrices + change * slopes)[0] for change in (1e-5, -1e-5))
    _, found = followed_eigenvalues(matrices, slopes, fastest(matrices)[0])
    assert np.abs(found - (above - below) / 2e-5).max() < 1e-6 * np.abs(found).max()
