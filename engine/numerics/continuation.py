"""Pseudo-arclength continuation of stacks of branches.

Theory section 7.2. Nothing here depends on physics: a problem provides residuals and their derivatives by the unknowns
and by one parameter, the last entry of each point. Branches run side by side, each with its own step length.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, filled, lengths
from engine.numerics.newton import NewtonOptions, Solution, newton, solve_systems
from engine.outcome import Outcome

MOST_ITERATIONS = 5  # of Newton's method: a step that needs more of them is too long
ALL_UNKNOWNS = slice(None)
LOST = 1.5  # times the largest miss: a first step of Newton's method beyond which its end is not looked for
QUICKEST = 2.0  # largest growth of a step from one point to the next


class Problem(Protocol):
    """Equations of a stack of branches: n equations in n unknowns and a parameter, the last of n + 1 entries."""

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals (k, n) and derivatives (k, n, n + 1) at points (k, n + 1) of branches (k,).

        anchor (k, n + 1) is a nearby point, for conditions that fix a phase relative to it.
        """

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Return the scale of each entry of the points, for norms of steps: (k, n + 1)."""

    def correct(
        self, start: "NewtonStart", branch: IntArray, condition: tuple[FloatArray, FloatArray], options: NewtonOptions
    ) -> tuple[Solution, FloatArray]:
        """Solve the equations with the condition row . z = value, of shapes (k, n + 1) and (k,), by Newton's method.

        Return the solution and the direction (k, n + 1) in which only row . z grows, at the point before the last step.
        A problem with a faster solver overrides this method.
        """
        return correct_by_newton(self, start, branch, condition, options)


@dataclass(frozen=True, slots=True)
class NewtonStart:
    """Where Newton's method starts: guess, anchor of the phase and scale of the step, each (k, n + 1)."""

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
    """Solve a problem with one additional linear condition by Newton's method; see `Problem.correct`."""
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
    """Points on branches.

    branch: (k,), index of each point's branch; z: (k, n + 1), the points; scale: (k, n + 1), the problem's scale there;
    tangent: (k, n + 1), of unit norm in that scale.
    """

    branch: IntArray
    z: FloatArray
    scale: FloatArray
    tangent: FloatArray

    def select(self, index: IntArray | BoolArray) -> "BranchPoints":
        """Select points of the stack, by `take`, which gathers rows in half of the time of an index."""
        rows = np.flatnonzero(index) if index.dtype == np.bool_ else index
        z, scale, tangent = (part.take(rows, axis=0) for part in (self.z, self.scale, self.tangent))
        return BranchPoints(self.branch[rows], z, scale, tangent)

    def overwrite(self, other: "BranchPoints") -> None:
        """Overwrite the points of the other points' branches; in this stack branch i has row i."""
        self.z[other.branch], self.scale[other.branch] = other.z, other.scale
        self.tangent[other.branch] = other.tangent


def concatenated(parts: Sequence[BranchPoints]) -> BranchPoints:
    """Return the points of several stacks in one."""
    names = ("branch", "z", "scale", "tangent")
    return BranchPoints(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def make_points(problem: Problem, branch: IntArray, z: FloatArray, direction: FloatArray) -> BranchPoints:
    """Return points z (k, n + 1) of branches (k,) with unit tangents along directions (k, n + 1)."""
    scale = problem.scale(z, branch)
    return BranchPoints(branch, z, scale, direction / lengths(direction / scale)[:, None])


@dataclass(frozen=True, slots=True)
class StepControl:
    """Step lengths in the problem's scale, and the limits at which a branch is abandoned.

    A step grows or shrinks so that the prediction misses the next solution by the fraction `aim` of the step. It is
    halved if Newton's method fails, if the cosine between successive tangents falls below `straightness`, or if the
    prediction misses by more than the fraction `miss`. `tolerance` is that of Newton's method, `points` the largest
    number of points. First and largest steps may differ between branches: (branches,).
    """

    first: float | FloatArray = 0.05
    largest: float | FloatArray = 0.7
    smallest: float = 1e-5
    aim: float = 0.02
    straightness: float = 0.85
    miss: float = 0.08
    tolerance: float = 3e-5
    points: int = 400


def tangents(problem: Problem, z: FloatArray, branch: IntArray, along: FloatArray) -> FloatArray:
    """Return the unit tangents (k, n + 1) at points z of branches (k,), directed towards `along` (k, n + 1).

    NaN where the tangent is not unique.
    """
    scale = problem.scale(z, branch)
    _, slopes = problem.system(z, z, branch)
    matrix = np.concatenate([slopes, (along / scale**2)[:, None]], axis=1)
    return make_points(problem, branch, z, _branch_direction(matrix)).tangent


def continue_branches(
    problem: Problem, start: FloatArray, direction: FloatArray, steps: StepControl | None = None
) -> Generator[BranchPoints, BoolArray | None, ObjectArray]:
    """Follow branches side by side from one point each, through folds as well.

    Parameters
    ----------
    problem : Problem
    start : (branches, n + 1)
        A point on each branch.
    direction : (branches, n + 1)
        Direction in which each branch is followed, of any length.
    steps : StepControl, optional

    Yields
    ------
    BranchPoints
        The next point of every branch whose step was accepted. The caller may send back which of them continue, a
        boolean array (k,); without it all do.

    Returns
    -------
    (branches,) of Outcome
        CONVERGED if the caller ended the branch, LIMIT_REACHED at the largest number of points, NO_CONVERGENCE if the
        smallest step failed.
    """
    steps = steps or StepControl()
    active = np.arange(start.shape[0])
    last = make_points(problem, active, start.copy(), direction)
    before = BranchPoints(active, np.full_like(start, np.nan), last.scale.copy(), last.tangent.copy())
    length, largest = (np.array(np.broadcast_to(size, active.shape)) for size in (steps.first, steps.largest))
    count = np.zeros(active.size, dtype=np.intp)
    outcome = filled(active.size, Outcome.CONVERGED)
    options = NewtonOptions(tolerance=steps.tolerance, iterations=MOST_ITERATIONS)
    while active.size:
        here = last.select(active)
        guess = _predict(before.select(active), here, length[active])
        # A starting point may have no phase, as an equilibrium has none.
        anchor = np.where(np.isnan(before.z[active]), guess, here.z)
        near = replace(options, reach=LOST * steps.miss * length[active])
        new, solution = solve_at_length(problem, here, length[active], guess, anchor, near)
        missed = _relative_miss(here, new, guess)
        good = solution.converged & (missed < steps.miss) & (_cosine(here, new) > steps.straightness)
        growth = np.where(good, _growth(missed, steps), 0.5)
        length[active] = np.minimum(length[active] * growth, largest[active])
        accepted = new.select(good)
        before.overwrite(here.select(good))
        last.overwrite(accepted)
        count[accepted.branch] += 1
        failed, full = length[active] < steps.smallest, count[active] >= steps.points
        outcome[active[failed]] = Outcome.NO_CONVERGENCE
        outcome[active[full]] = Outcome.LIMIT_REACHED
        goes_on = np.ones(outcome.size, dtype=np.bool_)
        goes_on[active[failed | full]] = False
        if accepted.branch.size:
            alive = yield accepted
            if alive is not None:
                goes_on[accepted.branch[~alive]] = False
        active = active[goes_on[active]]
    return outcome


def interpolate(
    left: BranchPoints, right: BranchPoints, share: FloatArray, unknowns: slice = ALL_UNKNOWNS
) -> FloatArray:
    """Interpolate between successive points of branches by Hermite's cubic: (k, ..., n + 1).

    share (k, ...) is 0 at the left and 1 at the right point; a slice of the unknowns restricts the last axis.
    """
    length = lengths((right.z - left.z) / left.scale)
    after = (length / lengths(right.tangent / left.scale))[:, None] * right.tangent
    return _cubic((left.z, right.z, length[:, None] * left.tangent, after), share, unknowns)


def _cubic(ends: tuple[FloatArray, ...], share: FloatArray, unknowns: slice = ALL_UNKNOWNS) -> FloatArray:
    """Evaluate Hermite's cubic from its values at both ends and its slopes there by the share, each (k, n + 1)."""
    cube, square = share**3, share**2
    weights = [2.0 * cube - 3.0 * square + 1.0, 3.0 * square - 2.0 * cube, cube - 2.0 * square + share, cube - square]
    between = (ALL_UNKNOWNS,) + (None,) * (share.ndim - 1)
    parts = [weight[..., None] * end[:, unknowns][between] for weight, end in zip(weights, ends, strict=True)]
    return np.asarray(parts[0] + parts[1] + parts[2] + parts[3])


def _predict(before: BranchPoints, here: BranchPoints, length: FloatArray) -> FloatArray:
    """Extrapolate Hermite's cubic through the last two points, or the tangent if there is only one point.

    The cubic's variable is the one that a step prescribes, the length along the tangent of the last point.
    """
    row = here.tangent / here.scale**2
    back = np.einsum("ki,ki->k", row, here.z - before.z)
    along = np.einsum("ki,ki->k", row, before.tangent)
    slopes = ((back / along)[:, None] * before.tangent, back[:, None] * here.tangent)
    cubic = _cubic((before.z, here.z, *slopes), 1.0 + length / back)
    return np.where(np.isnan(cubic), here.z + length[:, None] * here.tangent, cubic)


def _cosine(here: BranchPoints, new: BranchPoints) -> FloatArray:
    """Return the cosine between successive tangents: where it is small, the new point may lie on another branch."""
    new_tangent = new.tangent / here.scale
    return np.asarray(np.einsum("ki,ki->k", new_tangent, here.tangent / here.scale) / lengths(new_tangent))


def _relative_miss(here: BranchPoints, new: BranchPoints, guess: FloatArray) -> FloatArray:
    """Return the distance of new points from their guesses over that from the last points."""
    far, missed = (lengths((new.z - z) / here.scale) for z in (here.z, guess))
    return np.asarray(missed / far)


def _growth(missed: FloatArray, steps: StepControl) -> FloatArray:
    """Return the factor on the length of the next step: the cubic's error grows with the fourth power of the length."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.minimum(QUICKEST, np.cbrt(steps.aim / missed))


def solve_at_length(
    problem: Problem,
    base: BranchPoints,
    length: FloatArray,
    guess: FloatArray,
    anchor: FloatArray,
    options: NewtonOptions,
) -> tuple[BranchPoints, Solution]:
    """Solve for the points at given lengths (k,) along the tangents of the base points; NaN where the solver failed."""
    row = base.tangent / base.scale**2
    value = np.einsum("ki,ki->k", row, base.z) + length
    start = NewtonStart(guess, anchor, base.scale / np.sqrt(row.shape[-1]))
    solution, direction = problem.correct(start, base.branch, (row, value), options)
    good = np.flatnonzero(solution.converged)
    # The direction belongs to the point before the last step, which is close enough.
    found = make_points(problem, base.branch[good], solution.x[good], direction[good])
    if good.size == base.branch.size:
        return found, solution
    whole = BranchPoints(base.branch, *(np.full_like(guess, np.nan) for _ in range(3)))
    whole.z[good], whole.scale[good], whole.tangent[good] = found.z, found.scale, found.tangent
    return whole, solution


def _branch_direction(matrix: FloatArray) -> FloatArray:
    """Return the direction (k, n + 1) whose product with matrices (k, n + 1, n + 1) is (0, ..., 0, 1)."""
    right = np.zeros(matrix.shape[:-1])
    right[:, -1] = 1.0
    return solve_systems(matrix, right)
