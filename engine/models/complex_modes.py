"""Complex modes of small motion about the static state in wind, from matrices of half the size of the state's.

A motion x exp(lambda t) solves P(lambda) x = 0 with P = lambda^2 - lambda A_22 - A_21, where A_21 and A_22 are the
lower blocks of A in y' = A y, y = (q, q'). Beside an eigenvalue, the inverse of P holds all that is wanted of this one:
by Jacobi's formula, d log det P = tr(P^-1 dP), Newton's step towards it and its derivatives.
"""

import numpy as np

from engine.arrays import ComplexArray, FloatArray

APART = 1e-9  # relative distance from an eigenvalue at which P is inverted


def complex_modes(matrices: FloatArray, values: ComplexArray) -> ComplexArray:
    """Return the displacements, of unit norm, of the modes to given eigenvalues.

    Beside an eigenvalue, P^-1 is nearly the product of its mode and its left vector. The largest column has a large
    entry of the left vector, so it is close to the mode, whatever the symmetry of both; one step of inverse iteration
    from there leaves an error of the square of the distance.

    Parameters
    ----------
    matrices : (k, 2 m, 2 m)
        A.
    values : (k,)
        lambda, not 0 [1/s].

    Returns
    -------
    (k, m)
    """
    inverse = np.linalg.inv(_pencils(matrices, values * (1.0 + APART)))
    largest = np.linalg.norm(inverse, axis=1).argmax(axis=-1)
    first = np.take_along_axis(inverse, largest[:, None, None], axis=-1)
    vector = (inverse @ (first / np.linalg.norm(first, axis=1, keepdims=True)))[..., 0]
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True))


def followed_eigenvalues(
    matrices: FloatArray, slopes: FloatArray, guess: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Return the eigenvalues next to guesses, by a step of Newton's method, and their derivatives by a parameter.

    Parameters
    ----------
    matrices, slopes : (k, 2 m, 2 m)
        A and its derivative by the parameter.
    guess : (k,)
        lambda, not 0 [1/s]; the step squares its relative error.

    Returns
    -------
    (k,), (k,)
    """
    beside = guess * (1.0 + APART)
    m = matrices.shape[-1] // 2
    inverse = np.linalg.inv(_pencils(matrices, beside))
    by_value = 2.0 * beside[:, None, None] * np.eye(m) - matrices[:, m:, m:]
    by_parameter = -beside[:, None, None] * slopes[:, m:, m:] - slopes[:, m:, :m]
    growth, drift = (np.einsum("kij,kji->k", inverse, part) for part in (by_value, by_parameter))
    return np.asarray(beside - 1.0 / growth), np.asarray(-drift / growth)


def _pencils(matrices: FloatArray, values: ComplexArray) -> ComplexArray:
    """Return P at values (k,): (k, m, m)."""
    m = matrices.shape[-1] // 2
    laplace = values[:, None, None]
    return np.asarray(laplace**2 * np.eye(m) - laplace * matrices[:, m:, m:] - matrices[:, m:, :m])
