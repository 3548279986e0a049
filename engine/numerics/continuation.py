"""Pseudo-arclength continuation of stacks of branches, and points on them where a test function vanishes.

It knows no physics: a problem gives residuals and their slopes by the unknowns and by one parameter, the last entry of
each point. Branches run side by side, each with a step of its own. Theory section 7.2.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, filled, lengths
from engine.numerics.newton import NewtonOptions, Solution, newton, solve_systems
from engine.outcome import Outcome

CONTINUATION_OPTIONS = NewtonOptions(tolerance=1e-4, iterations=8)
LOCATION_OPTIONS = NewtonOptions(iterations=8)
MOST_ITERATIONS = 30
ALL_UNKNOWNS = slice(None)


class Problem(Protocol):
    """Equations of a stack of branches: n of them in n unknowns and a parameter, which is the last of n + 1 entries."""

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals (k, n) and slopes (k, n, n + 1) at points (k, n + 1) of branches (k,).

        anchor (k, n + 1) is a point nearby, for conditions that fix a phase relative to it.
        """
        ...

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Return the size by which each entry of the points is measured: (k, n + 1)."""
        ...

    def correct(
        self, start: "NewtonStart", branch: IntArray, condition: tuple[FloatArray, FloatArray], options: NewtonOptions
    ) -> tuple[Solution, FloatArray]:
        """Solve together with the condition row . z = value, of shapes (k, n + 1) and (k,), by Newton's method.

        Return the solution, and the direction (k, n + 1) in which row . z alone grows before the last step.
        A problem that has no faster way keeps this one.
        """
        return correct_by_newton(self, start, branch, condition, options)


@dataclass(frozen=True, slots=True)
class NewtonStart:
    """Where Newton's method begins: guess, anchor of the phase, and scale of the step, all (k, n + 1)."""

    guess: FloatArray
    anchor: FloatArray
    scale: FloatArray


def correct_by_newton(
    problem: Problem,
    start: NewtonStart,
    branch: IntArray,
    condition: tuple[FloatArray, FloatArray],
    options: NewtonOptions,
) -> tuple[Solution, FloatArray]:
    """Solve a problem and one linear condition more by Newton's method on its slopes; see `Problem.correct`."""
    row, value = condition
    matrices = np.full((*row.shape, row.shape[-1]), np.nan)

    def system(z: FloatArray, index: IntArray) -> tuple[FloatArray, FloatArray]:
        residual, slopes = problem.system(z, start.anchor[index], branch[index])
        condition_residual = np.einsum("ki,ki->k", row[index], z) - value[index]
        matrices[index] = np.concatenate([slopes, row[index][:, None]], axis=1)
        return np.concatenate([residual, condition_residual[:, None]], axis=-1), matrices[index]

    solution = newton(system, start.guess, start.scale, options)
    return solution, _branch_direction(matrices)


@dataclass(frozen=True, slots=True)
class BranchPoints:
    """Points on branches: branch (k,); z, the problem's scale there, and the unit tangent in it, (k, n + 1) each."""

    branch: IntArray
    z: FloatArray
    scale: FloatArray
    tangent: FloatArray

    def select(self, index: IntArray | BoolArray) -> "BranchPoints":
        """Pick points of the stack."""
        return BranchPoints(self.branch[index], self.z[index], self.scale[index], self.tangent[index])

    def overwrite(self, other: "BranchPoints") -> None:
        """Overwrite the points of the branches that the others lie on; here branch i has row i."""
        self.z[other.branch], self.scale[other.branch] = other.z, other.scale
        self.tangent[other.branch] = other.tangent


def make_points(problem: Problem, branch: IntArray, z: FloatArray, direction: FloatArray) -> BranchPoints:
    """Make points (k, n + 1) of branches (k,) with tangents along given directions."""
    scale = problem.scale(z, branch)
    return BranchPoints(branch, z, scale, direction / lengths(direction / scale)[:, None])


TestFunction = Callable[[BranchPoints], FloatArray]


@dataclass(frozen=True, slots=True)
class StepControl:
    """Lengths of steps in the problem's scale, and when a branch is given up.

    A step grows where Newton's method needs fewer than `iterations` and shrinks where it needs more; it is halved where
    the method fails, the direction turns by more than the angle whose cosine is `straightness`, or the prediction
    missed by more than the share `miss` of the step.
    """

    first: float = 0.05
    largest: float = 0.7
    smallest: float = 1e-5
    iterations: float = 2.5
    straightness: float = 0.85
    miss: float = 0.08
    points: int = 400


def tangents(problem: Problem, z: FloatArray, branch: IntArray, along: FloatArray) -> FloatArray:
    """Return the unit tangents at points of branches on the side of `along`, all (k, n + 1).

    NaN where the branch has no single direction.
    """
    scale = problem.scale(z, branch)
    _, slopes = problem.system(z, z, branch)
    matrix = np.concatenate([slopes, (along / scale**2)[:, None]], axis=1)
    return make_points(problem, branch, z, _branch_direction(matrix)).tangent


def continue_branches(
    problem: Problem, start: FloatArray, direction: FloatArray, steps: StepControl | None = None
) -> Generator[BranchPoints, BoolArray | None, ObjectArray]:
    """Follow branches from a point each, side by side, also through folds.

    Parameters
    ----------
    problem : Problem
    start : (branches, n + 1)
        A point on each branch.
    direction : (branches, n + 1)
        Tangent along which each is left, of any length.
    steps : StepControl, optional

    Yields
    ------
    BranchPoints
        The next point of every branch whose step was accepted. Send back which of them go on, (k,); all do if nothing
        is sent.

    Returns
    -------
    (branches,) of Outcome
        CONVERGED where the caller ended the branch, LIMIT_REACHED after the largest number of points, NO_CONVERGENCE
        where the smallest step failed.
    """
    steps = steps or StepControl()
    active = np.arange(start.shape[0])
    last = make_points(problem, active, start.copy(), direction)
    before = BranchPoints(active, np.full_like(start, np.nan), last.scale.copy(), last.tangent.copy())
    length, count = np.full(active.size, steps.first), np.zeros(active.size, dtype=np.intp)
    outcome = filled(active.size, Outcome.CONVERGED)
    while active.size:
        here = last.select(active)
        guess = _predict(before.select(active), here, length[active])
        anchor = np.where(np.isnan(before.z[active]), guess, here.z)  # a start may have no phase of its own
        new, solution = _solve_at_length(problem, here, length[active], guess, anchor, CONTINUATION_OPTIONS)
        good = solution.converged & _stays_on_branch(here, new, guess, steps)
        growth = 2.0 ** ((steps.iterations - solution.iterations) / steps.iterations)
        length[active] = np.minimum(length[active] * np.where(good, growth, 0.5), steps.largest)
        accepted = new.select(good)
        before.overwrite(here.select(good))
        last.overwrite(accepted)
        count[accepted.branch] += 1
        outcome[active[length[active] < steps.smallest]] = Outcome.NO_CONVERGENCE
        outcome[active[count[active] >= steps.points]] = Outcome.LIMIT_REACHED
        goes_on = outcome == Outcome.CONVERGED
        if accepted.branch.size:
            alive = yield accepted
            if alive is not None:
                goes_on[accepted.branch[~alive]] = False
        active = active[goes_on[active]]
    return outcome


def interpolate(
    left: BranchPoints, right: BranchPoints, share: FloatArray, unknowns: slice = ALL_UNKNOWNS
) -> FloatArray:
    """Return Hermite's cubic through successive points of branches at shares (k, ...) of the way: (k, ..., n + 1).

    Or some of the unknowns alone.
    """
    length = lengths((right.z - left.z) / left.scale)
    after = (length / lengths(right.tangent / left.scale))[:, None] * right.tangent
    ends = (left.z, right.z, length[:, None] * left.tangent, after)
    cube, square = share**3, share**2
    weights = [2.0 * cube - 3.0 * square + 1.0, 3.0 * square - 2.0 * cube, cube - 2.0 * square + share, cube - square]
    between = (ALL_UNKNOWNS,) + (None,) * (share.ndim - 1)
    parts = [weight[..., None] * end[:, unknowns][between] for weight, end in zip(weights, ends, strict=True)]
    return np.asarray(parts[0] + parts[1] + parts[2] + parts[3])


def _predict(before: BranchPoints, here: BranchPoints, length: FloatArray) -> FloatArray:
    """Extrapolate Hermite's cubic through the last two points, or the tangent where there is only one."""
    step = lengths((here.z - before.z) / before.scale)
    along = lengths(here.tangent / before.scale)
    cubic = interpolate(before, here, 1.0 + length * along / step)
    return np.where(np.isnan(cubic), here.z + length[:, None] * here.tangent, cubic)


def _stays_on_branch(here: BranchPoints, new: BranchPoints, guess: FloatArray, steps: StepControl) -> BoolArray:
    """Tell where a point found lies near its guess and in the direction of the branch: else it may be on another."""
    new_tangent = new.tangent / here.scale
    cosine = np.einsum("ki,ki->k", new_tangent, here.tangent / here.scale) / lengths(new_tangent)
    far, missed = (lengths((new.z - z) / here.scale) for z in (here.z, guess))
    return np.asarray((cosine > steps.straightness) & (missed < steps.miss * far))


def _solve_at_length(
    problem: Problem,
    base: BranchPoints,
    length: FloatArray,
    guess: FloatArray,
    anchor: FloatArray,
    options: NewtonOptions,
) -> tuple[BranchPoints, Solution]:
    """Solve for the points at a given length along the tangents of the base points; NaN where that failed."""
    row = base.tangent / base.scale**2
    value = np.einsum("ki,ki->k", row, base.z) + length
    start = NewtonStart(guess, anchor, base.scale / np.sqrt(row.shape[-1]))
    solution, direction = problem.correct(start, base.branch, (row, value), options)
    good = np.flatnonzero(solution.converged)
    # The direction is that of the point to within the last step.
    found = make_points(problem, base.branch[good], solution.x[good], direction[good])
    if good.size == base.branch.size:
        return found, solution
    whole = BranchPoints(base.branch, *(np.full_like(guess, np.nan) for _ in range(3)))
    whole.z[good], whole.scale[good], whole.tangent[good] = found.z, found.scale, found.tangent
    return whole, solution


def _branch_direction(matrix: FloatArray) -> FloatArray:
    """Solve for the direction in which the last row of a matrix alone grows."""
    right = np.zeros(matrix.shape[:-1])
    right[:, -1] = 1.0
    return solve_systems(matrix, right)


def project_onto_branches(problem: Problem, points: BranchPoints) -> BranchPoints:
    """Solve for the points of the branches next to these, normal to their tangents; NaN where that failed."""
    return _solve_at_length(problem, points, np.zeros(points.branch.size), points.z, points.z, LOCATION_OPTIONS)[0]


@dataclass(frozen=True, slots=True)
class LocatedZeros:
    """Zeros of a test function: the points, and how far the parameter moved in the last step towards each, (k,)."""

    points: BranchPoints
    uncertainty: FloatArray


def locate_zeros(
    problem: Problem, left: BranchPoints, right: BranchPoints, test: TestFunction, accuracy: float
) -> LocatedZeros:
    """Find where a test function vanishes between two successive points of branches, by the Illinois method.

    Parameters
    ----------
    problem : Problem
    left, right : BranchPoints
        Of the same branches; the test function has opposite signs there.
    test : callable
        Takes BranchPoints, returns (k,).
    accuracy : float
        Relative change of the parameter at which the search stops.

    Returns
    -------
    LocatedZeros
        The uncertainty is infinite where the search left the branch.
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
        point, _ = _solve_at_length(problem, left.select(active), middle, guess, left.z[active], LOCATION_OPTIONS)
        f = test(point)
        moved[active] = np.abs(point.z[:, -1] - found.z[active, -1])
        found.z[active], found.scale[active], found.tangent[active] = point.z, point.scale, point.tangent
        flips = f * f_b < 0.0
        # The end that stays has its value halved, so that it moves in the next step.
        other[active], other_value[active] = np.where(flips, b, a), np.where(flips, f_b, 0.5 * f_a)
        end[active], value[active] = middle, f
        active = active[np.isfinite(f) & (moved[active] > accuracy * np.abs(point.z[:, -1]))]
        if active.size == 0:
            break
    return LocatedZeros(found, np.where(np.isfinite(moved), moved, np.inf))
