"""Cubic polynomials without constant term in a few variables, as tables of coefficients over monomials.

The monomials of n variables are ordered x_0 ... x_(n-1), then products of two (i <= j), then of three (i <= j <= k). A
table is an array whose last axis runs over the monomials; its other axes are arbitrary.
"""

from functools import lru_cache
from itertools import combinations_with_replacement
from math import comb

import numpy as np

from engine.arrays import FloatArray, IntArray

DEGREE = 3


@lru_cache
def monomials(variables: int) -> tuple[tuple[int, ...], ...]:
    """Return the monomials of degree 1 to 3, each as the sorted tuple of its factors."""
    return tuple(m for degree in (1, 2, 3) for m in combinations_with_replacement(range(variables), degree))


def count(variables: int, degree: int) -> int:
    """Return the number of monomials of exactly this degree."""
    return comb(variables + degree - 1, degree)


def powers(x: FloatArray, degree: int = DEGREE) -> FloatArray:
    """Evaluate all monomials up to a degree at x (..., variables): shape (..., monomials)."""
    terms = [x]
    for index, factor in _products(x.shape[-1])[: degree - 1]:
        terms.append(terms[-1][..., index] * x[..., factor])
    return np.concatenate(terms, axis=-1)


@lru_cache
def _products(
    variables: int,
) -> tuple[tuple[IntArray, IntArray], ...]:
    """Return the indices of the lower monomial and the variable whose product is each monomial of degrees 2 and 3."""
    pairs = []
    for degree in (2, 3):
        below = list(combinations_with_replacement(range(variables), degree - 1))
        position = {monomial: i for i, monomial in enumerate(below)}
        here = list(combinations_with_replacement(range(variables), degree))
        pairs.append((np.array([position[m[:-1]] for m in here]), np.array([m[-1] for m in here])))
    return tuple(pairs)


def slopes(table: FloatArray) -> FloatArray:
    """Differentiate a table (..., monomials) by each variable: (..., variables, 1 + monomials of degree 1 and 2).

    The first entry of the last axis is the constant; the others are in the order of `monomials`.
    """
    variables = _variables_of(table.shape[-1])
    derivative = _derivative_map(variables)
    flat = table @ derivative.reshape(derivative.shape[0], -1)
    return flat.reshape(*table.shape[:-1], *derivative.shape[1:])


def _variables_of(size: int) -> int:
    for variables in range(1, 64):
        if len(monomials(variables)) == size:
            return variables
    raise ValueError(f"no number of variables has {size} monomials up to the third degree")


@lru_cache
def _derivative_map(variables: int) -> FloatArray:
    """Return the linear map (monomials, variables, 1 + monomials of degree 1 and 2) from a table to its slopes."""
    every = monomials(variables)
    position = {(): 0} | {m: i + 1 for i, m in enumerate(every) if len(m) < DEGREE}
    result = np.zeros((len(every), variables, len(position)))
    for i, monomial in enumerate(every):
        for variable in set(monomial):
            rest = list(monomial)
            rest.remove(variable)
            result[i, variable, position[tuple(rest)]] = monomial.count(variable)
    return result


def substitute(table: FloatArray, forms: FloatArray) -> FloatArray:
    """Substitute linear forms for the variables of polynomials and sum over points.

    Parameters
    ----------
    table : (..., points, outputs, monomials of local variables)
    forms : (..., points, local variables, variables)
        Local variable l at a point is forms[l] . x.

    Returns
    -------
    (..., outputs, monomials of variables)
    """
    local = forms.shape[-2]
    result, start = [], 0
    products = forms
    for degree in (1, 2, 3):
        if degree > 1:
            index, factor = _products(local)[degree - 2]
            products = multiply_forms(products[..., index, :], forms[..., factor, :])
        stop = start + count(local, degree)
        coefficients = np.moveaxis(table[..., start:stop], -2, -3)
        flat = coefficients.reshape(*coefficients.shape[:-2], -1)
        result.append(flat @ products.reshape(*products.shape[:-3], -1, products.shape[-1]))
        start = stop
    return np.concatenate(result, axis=-1)


def multiply_forms(left: FloatArray, right: FloatArray) -> FloatArray:
    """Multiply homogeneous polynomials of degree 1 or 2 (..., monomials) by linear forms (..., variables).

    Returns
    -------
    (..., monomials of one degree more)
    """
    variables = right.shape[-1]
    outer = left[..., :, None] * right[..., None, :]
    return collected(outer.reshape(*outer.shape[:-2], -1), variables, 2 if left.shape[-1] == variables else 3)


def collected(products: FloatArray, variables: int, degree: int) -> FloatArray:
    """Collect equal monomials among products of each monomial of one degree less with each variable.

    products: (..., monomials of degree - 1 times variables); returns (..., monomials of degree).
    """
    return np.asarray(products @ _fold(variables, degree))


@lru_cache
def _fold(variables: int, degree: int) -> FloatArray:
    below = list(combinations_with_replacement(range(variables), degree - 1))
    here = {m: i for i, m in enumerate(combinations_with_replacement(range(variables), degree))}
    result = np.zeros((len(below) * variables, len(here)))
    for row, (monomial, variable) in enumerate((m, v) for m in below for v in range(variables)):
        result[row, here[tuple(sorted((*monomial, variable)))]] = 1.0
    return result
