"""Points on branches that meet a condition: the nearest ones to given points, and zeros of a test function.

Theory section 7.2. Like the continuation, nothing here depends on physics.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.numerics.continuation import BranchPoints, Problem, concatenated, interpolate, solve_at_length
from engine.numerics.newton import NewtonOptions

LOCATION_OPTIONS = NewtonOptions(iterations=8)
MOST_ITERATIONS = 30

TestFunction = Callable[[BranchPoints, IntArray], FloatArray]


def project_onto_branches(problem: Problem, points: BranchPoints) -> BranchPoints:
    """Solve for the branch points in the planes normal to the tangents of these points; NaN where the solver failed."""
    return solve_at_length(problem, points, np.zeros(points.branch.size), points.z, points.z, LOCATION_OPTIONS)[0]


@dataclass(frozen=True, slots=True)
class LocatedZeros:
    """Zeros of a test function: the points, and the change of the parameter in the last step towards each, (k,)."""

    points: BranchPoints
    uncertainty: FloatArray


def locate_zeros(
    problem: Problem, left: BranchPoints, right: BranchPoints, test: TestFunction, accuracy: float
) -> LocatedZeros:
    """Locate zeros of test functions between successive points of branches by the Illinois method.

    The test function takes points (k,) and, for each, the index of the pair between which it is searched, so that each
    may have a function of its own; it returns (k,), with opposite signs at the left and right points, which lie on the
    same branches. accuracy is the relative change of the parameter at which the search stops. The uncertainty is
    infinite where the search left the branch, or where the function is NaN.
    """
    whole = np.einsum("ki,ki->k", left.tangent / left.scale, (right.z - left.z) / left.scale)
    end, other = whole.copy(), np.zeros_like(whole)
    active = np.arange(whole.size)
    value, other_value = test(concatenated([right, left]), np.tile(active, 2)).reshape(2, -1)
    found = right.select(active)
    moved = np.full(whole.size, np.inf)
    for _ in range(MOST_ITERATIONS):
        a, b, f_a, f_b = other[active], end[active], other_value[active], value[active]
        middle = (a * f_b - b * f_a) / np.where(f_b == f_a, np.nan, f_b - f_a)
        guess = interpolate(left.select(active), right.select(active), middle / whole[active])
        point, _ = solve_at_length(problem, left.select(active), middle, guess, left.z[active], LOCATION_OPTIONS)
        f = test(point, active)
        moved[active] = np.abs(point.z[:, -1] - found.z[active, -1])
        found.z[active], found.scale[active], found.tangent[active] = point.z, point.scale, point.tangent
        flips = f * f_b < 0.0
        # Halve the value of an end that is kept twice, so that it moves in the next step (Illinois).
        other[active], other_value[active] = np.where(flips, b, a), np.where(flips, f_b, 0.5 * f_a)
        end[active], value[active] = middle, f
        active = active[np.isfinite(f) & (moved[active] > accuracy * np.abs(point.z[:, -1]))]
        if active.size == 0:
            break
    return LocatedZeros(found, np.where(np.isfinite(moved), moved, np.inf))
