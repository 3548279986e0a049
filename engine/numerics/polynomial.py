"""Cubic polynomials without constant term in a few variables, as tables of coefficients over monomials.

The monomials of n variables are ordered x_0 ... x_(n-1), then products of two (i <= j), then of three (i <= j <= k). A
table is an array whose last axis runs over the monomials; its other axes are arbitrary.
"""

from functools import lru_cache
from itertools import combinations_with_replacement
from math import comb

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes

DEGREE = 3
FEW = 4  # variables, up to which a dense product collects equal monomials faster than an index


@lru_cache
def monomials(variables: int) -> tuple[tuple[int, ...], ...]:
    """Return the monomials of degree 1 to 3, each as the sorted tuple of its factors."""
    return tuple(m for degree in (1, 2, 3) for m in combinations_with_replacement(range(variables), degree))


def count(variables: int, degree: int) -> int:
    """Return the number of monomials of exactly this degree."""
    return comb(variables + degree - 1, degree)


def powers(x: FloatArray, degree: int = DEGREE) -> FloatArray:
    """Evaluate all monomials up to a degree at x (..., variables): shape (..., monomials), one by one in memory."""
    variables = x.shape[-1]
    terms = np.empty((sum(count(variables, d + 1) for d in range(degree)), *x.shape[:-1]))
    terms[:variables] = np.moveaxis(x, -1, 0)
    below, end = [(i, i) for i in range(variables)], variables  # place and last factor of those of one degree less
    for _ in range(degree - 1):
        here: list[tuple[int, int]] = []
        for place, last in below:
            size = variables - last
            np.multiply(terms[place], terms[last:variables], out=terms[end : end + size])
            here += [(end + i, last + i) for i in range(size)]
            end += size
        below = here
    return np.moveaxis(terms, 0, -1)


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
    index, factor = _derivative_map(_variables_of(table.shape[-1]))
    return np.asarray(np.take(table, index, axis=-1) * factor)  # several times as fast as an index on the last axis


def _variables_of(size: int) -> int:
    for variables in range(1, 64):
        if len(monomials(variables)) == size:
            return variables
    raise ValueError(f"no number of variables has {size} monomials up to the third degree")


@lru_cache
def _derivative_map(variables: int) -> tuple[IntArray, FloatArray]:
    """Return, for each variable and each monomial of degree 0 to 2, the monomial that their product is, and its power.

    Shape (variables, 1 + monomials of degree 1 and 2) each: the derivative by that variable of that monomial alone
    holds the lower one, with the power as factor.
    """
    every = monomials(variables)
    position = {monomial: i for i, monomial in enumerate(every)}
    lower = [(), *(monomial for monomial in every if len(monomial) < DEGREE)]
    products = [[tuple(sorted((*monomial, variable))) for monomial in lower] for variable in range(variables)]
    index = np.array([[position[product] for product in row] for row in products])
    factor = np.array([[float(product.count(variable)) for product in row] for variable, row in enumerate(products)])
    return index, factor


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
    local, variables = forms.shape[-2:]
    pair, factor = _products(local)[0]
    squares = merge_axes(multiply_forms(forms[..., pair, :], forms[..., factor, :]), -3, -2)
    linear, quadratic = (
        merge_axes(np.moveaxis(table[..., part], -3, -2), -2)
        for part in (slice(local), slice(local, local + pair.size))
    )
    # The third factor first, so that products of three are collected only once, after the sum over the points.
    padded = np.concatenate([table, np.zeros((*table.shape[:-1], 1))], axis=-1)[..., _cubes(local)]
    by_last = np.moveaxis(
        padded @ forms[..., None, :, :], (-4, -2), (-2, -1)
    )  # (..., outputs, variables, points, pairs)
    cubic = (merge_axes(merge_axes(by_last, -2), -3, -2) @ squares).reshape(*by_last.shape[:-2], squares.shape[-1])
    cubic = collected(merge_axes(cubic.swapaxes(-1, -2), -2), variables, DEGREE)
    return np.concatenate([linear @ merge_axes(forms, -3, -2), quadratic @ squares, cubic], axis=-1)


@lru_cache
def _cubes(variables: int) -> IntArray:
    """Return the monomials x_i x_j x_k, i <= j <= k, by the pair (i, j) and k, else their count: (pairs, variables)."""
    position = {monomial: i for i, monomial in enumerate(monomials(variables))}
    pairs = combinations_with_replacement(range(variables), 2)
    return np.array([[position.get((*pair, k), len(position)) for k in range(variables)] for pair in pairs])


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
    if variables <= FEW:
        return np.asarray(products @ _fold(variables, degree))
    index, known = _equal_products(variables, degree)
    return np.asarray((products[..., index] * known).sum(axis=-1))


@lru_cache
def _equal_products(variables: int, degree: int) -> tuple[IntArray, FloatArray]:
    """Return the products of which each monomial is the sum, and 1, or 0 on padding: (monomials, degree) each."""
    below = {m: i for i, m in enumerate(combinations_with_replacement(range(variables), degree - 1))}
    here = list(combinations_with_replacement(range(variables), degree))
    index, known = np.zeros((len(here), degree), dtype=np.intp), np.zeros((len(here), degree))
    for row, monomial in enumerate(here):
        for column, variable in enumerate(dict.fromkeys(monomial)):
            rest = list(monomial)
            rest.remove(variable)
            index[row, column], known[row, column] = below[tuple(rest)] * variables + variable, 1.0
    return index, known


@lru_cache
def _fold(variables: int, degree: int) -> FloatArray:
    below = list(combinations_with_replacement(range(variables), degree - 1))
    here = {m: i for i, m in enumerate(combinations_with_replacement(range(variables), degree))}
    result = np.zeros((len(below) * variables, len(here)))
    for row, (monomial, variable) in enumerate((m, v) for m in below for v in range(variables)):
        result[row, here[tuple(sorted((*monomial, variable)))]] = 1.0
    return result
