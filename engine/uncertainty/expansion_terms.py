"""Orthonormal functions of uncertain inputs, and their products: the terms of a polynomial chaos expansion."""

from collections.abc import Iterator, Sequence
from itertools import combinations, product

import numpy as np
from numpy.polynomial import legendre

from engine.arrays import FloatArray, IntArray
from engine.uncertainty.inputs import Choice, Uncertain

NORM = 0.75  # of the degrees of a product: below 1 it prefers few high degrees to many mixed ones
TOLERANCE = 1e-9


def terms_up_to(inputs: Sequence[Uncertain], degree: int) -> IntArray:
    """Return the terms of one and two inputs up to a degree, the constant first: number of the function in each input.

    Parameters
    ----------
    inputs : sequence of Uncertain
    degree : int
        Largest (a^q + b^q)^(1/q) of the degrees a and b of a product, q = 0.75: the hyperbolic index set of Blatman
        and Sudret 2011, Adaptive sparse polynomial chaos expansion based on least angle regression. A contrast between
        choices has degree 1.

    Returns
    -------
    (terms, inputs)
    """
    return np.array(list(_terms(inputs, degree)), dtype=np.intp).reshape(-1, len(inputs))


def design(inputs: Sequence[Uncertain], unit: FloatArray, terms: IntArray) -> FloatArray:
    """Return every term at every sample (samples, terms); each has mean 0 and mean square 1 except the constant."""
    result = np.ones((unit.shape[0], terms.shape[0]))
    for i, one in enumerate(inputs):
        result *= _functions(one, unit[:, i], int(terms[:, i].max(initial=0)))[:, terms[:, i]]
    return result


def _terms(inputs: Sequence[Uncertain], degree: int) -> Iterator[list[int]]:
    single = [_numbers(one, degree) for one in inputs]
    yield [0] * len(inputs)
    for i, numbers in enumerate(single):
        for number, _ in numbers:
            yield _term(len(inputs), {i: number})
    for i, j in combinations(range(len(inputs)), 2):
        for (number, a), (other, b) in product(single[i], single[j]):
            if (a**NORM + b**NORM) ** (1.0 / NORM) <= degree + TOLERANCE:
                yield _term(len(inputs), {i: number, j: other})


def _term(count: int, numbers: dict[int, int]) -> list[int]:
    return [numbers.get(i, 0) for i in range(count)]


def _numbers(one: Uncertain, degree: int) -> list[tuple[int, int]]:
    """Return the functions of an input besides the constant, each with its degree."""
    if isinstance(one, Choice):
        return [(number, 1) for number in range(1, len(one.weights))]
    return [(number, number) for number in range(1, degree + 1)]


def _functions(one: Uncertain, unit: FloatArray, most: int) -> FloatArray:
    """Return the first functions of an input (samples, most + 1)."""
    if isinstance(one, Choice):
        return _contrasts(one)[one.number(unit)]
    norms = np.sqrt(2.0 * np.arange(most + 1) + 1.0)
    return np.asarray(legendre.legvander(2.0 * unit - 1.0, most) * norms)


def _contrasts(choice: Choice) -> FloatArray:
    """Return a constant and contrasts (choices, functions), orthonormal under the choices' probabilities."""
    count, root = len(choice.shares), np.sqrt(choice.shares)
    indicators = np.hstack([np.ones((count, 1)), np.eye(count)[:, :-1]])
    orthonormal, triangle = np.linalg.qr(root[:, None] * indicators)
    return np.asarray(orthonormal * np.sign(np.diagonal(triangle)) / root[:, None])
