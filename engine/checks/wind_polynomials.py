"""The expanded load of the wind in the form that costs least at every step of direct integration.

At a point of the span only three forces act, along V, W and Theta: the polynomials of all coordinates are combinations
of three.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.models.aerodynamic_load import PolynomialLoad

DIRECTIONS = 3  # of forces at a point
INDEPENDENT = 1e-12  # share of the largest singular value, up to which polynomials count as combinations of others


@dataclass(frozen=True, slots=True)
class WindPolynomials:
    """The quadratic and cubic terms of loads divided by U^2, one load per start.

    forms: (starts, points, local variables, 2 m), linear forms in (q, q'/U); table: (starts, points, rows, monomials of
    degree 2 and 3), polynomials in the local variables; outward: (starts, points, m, rows), the share of each of them
    in the generalized force.
    """

    forms: FloatArray
    table: FloatArray
    outward: FloatArray


def wind_polynomials(load: PolynomialLoad, member: IntArray) -> WindPolynomials:
    """Return the terms of the loads of members (starts,) of a stack (members,), with three rows where they suffice."""
    known, own = np.unique(member, return_inverse=True)
    table, outward = _factored(load.table[known][..., load.forms.shape[-2] :])
    return WindPolynomials(load.forms[member], table[own], outward[own])


def _factored(table: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Write polynomials (..., m, monomials) as combinations of three where they are: (..., 3, monomials), (..., m, 3).

    Otherwise they stay as they are.
    """
    outputs = table.shape[-2]
    if outputs > DIRECTIONS and np.isfinite(table).all():
        left, size, right = np.linalg.svd(table, full_matrices=False)
        if (size[..., DIRECTIONS:] <= INDEPENDENT * size[..., :1]).all():
            return right[..., :DIRECTIONS, :], left[..., :DIRECTIONS] * size[..., None, :DIRECTIONS]
    return table, np.broadcast_to(np.eye(outputs), (*table.shape[:-1], outputs))
