"""Points on branches that meet a condition: the nearest ones to given points, and zeros of a test function.

Theory section 7.2. Like the continuation, nothing here depends on physics.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.numerics.continuation import BranchPoints, Problem, interpolate, solve_at_length
from engine.numerics.newton import NewtonOptions

LOCATION_OPTIONS = NewtonOptions(iterations=8)
MOST_ITERATIONS = 30

TestFunction = Callable[[BranchPoints], FloatArray]


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
    """Locate zeros of a test function between successive points of branches by the Illinois method.

    The test function takes points and returns (k,); it has opposite signs at the left and right points, which lie on
    the same branches. accuracy is the relative change of the parameter at which the search stops. The uncertainty is
    infinite where the search left the branch.
    """
    whole = np.einsum("ki,ki->k", left.tangent / left.scale, (right.z - left.z) / left.scale)
    end, other = whole.copy(), np.zeros_like(whole)
    value, other_value = test(right), test(left)
    found = right.select(np.arange(whole.size))
    moved = np.full(whole.size, np.inf)
    active = np.arange(whole.size)
    for _ in range(MOST_ITERATIONS):
        a, b, f_a, f_b = other[active], end[active], other_value[active], value[active]
        middle = (a * f_b - b * f_a) / np.where(f_b == f_a, np.nan, f_b - f_a)
        guess = interpolate(left.select(active), right.select(active), middle / whole[active])
        point, _ = solve_at_length(problem, left.select(active), middle, guess, left.z[active], LOCATION_OPTIONS)
        f = test(point)
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
