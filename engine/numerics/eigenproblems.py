"""Symmetric generalized eigenproblems K x = lambda M x on stacks of matrices, and how good approximate vectors are."""

import numpy as np

from engine.arrays import FloatArray

SMALL = 24  # rows of a triangular matrix, up to which halving it does not make its inversion faster


def solve_symmetric(stiffness: FloatArray, mass: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Solve K x = lambda M x on stacks: eigenvalues (..., n) ascending and vectors (..., n, n) with X^T M X = 1."""
    inverse, standard = standard_form(stiffness, mass)
    values, vectors = np.linalg.eigh(standard)
    return values, inverse.swapaxes(-1, -2) @ vectors


def eigenvalues_alone(stiffness: FloatArray, mass: FloatArray) -> FloatArray:
    """Return the eigenvalues of K x = lambda M x (..., n) ascending, in less than half of the time."""
    _, standard = standard_form(stiffness, mass)
    return np.asarray(np.linalg.eigvalsh(standard), dtype=np.float64)


def standard_form(stiffness: FloatArray, mass: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return L^-1 with M = L L^T, and L^-1 K L^-T, of which numpy reads the lower triangle: (..., n, n) each."""
    inverse = _inverted(np.asarray(np.linalg.cholesky(mass), dtype=np.float64))
    return inverse, inverse @ stiffness @ inverse.swapaxes(-1, -2)


def largest_sines(approximate: FloatArray, values: FloatArray) -> FloatArray:
    """Return bounds on the sines of the angles between vectors of the same place, in a subspace and in the whole.

    By Ky Fan's theorem the excess of the lowest i eigenvalues, summed, is no less than the gap above them times the sum
    of the squared sines between the spans of their vectors. The i-th vector lies in the i-th span and is orthogonal to
    the one before.

    Parameters
    ----------
    approximate : (..., k)
        Eigenvalues of the problem in a subspace (Rayleigh and Ritz), ascending.
    values : (..., n)
        Eigenvalues of the whole problem, or of one in a larger subspace that stands for it, ascending, n > k.

    Returns
    -------
    (..., k)
        Infinite or NaN beside an eigenvalue that occurs twice, whose vectors are not unique.
    """
    count = approximate.shape[-1]
    excess = np.cumsum(np.abs(approximate - values[..., :count]), axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        above = excess / np.diff(values[..., : count + 1], axis=-1)
    below = np.concatenate([np.zeros_like(above[..., :1]), above[..., :-1]], axis=-1)
    return np.asarray(np.sqrt(above + below))


def _inverted(lower: FloatArray) -> FloatArray:
    """Invert lower triangular matrices (..., n, n) by halves; numpy takes them for full ones, at thrice the cost."""
    n = lower.shape[-1]
    if n <= SMALL:
        return np.asarray(np.linalg.inv(lower), dtype=np.float64)
    first, second = slice(n // 2), slice(n // 2, n)
    inverse = np.zeros(lower.shape)
    inverse[..., first, first] = _inverted(lower[..., first, first])
    inverse[..., second, second] = _inverted(lower[..., second, second])
    inverse[..., second, first] = -inverse[..., second, second] @ lower[..., second, first] @ inverse[..., first, first]
    return inverse
