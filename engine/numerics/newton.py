"""Newton's method on stacks of independent systems of equations; no convergence is an outcome, not an exception."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, filled
from engine.outcome import Outcome

System = Callable[[FloatArray, IntArray], tuple[FloatArray, FloatArray]]

BLOCK_NUMBERS = 2_000_000  # largest number of entries in the Jacobians of one block


@dataclass(frozen=True, slots=True)
class NewtonOptions:
    """Tolerance of the scaled step, largest scaled step, and largest number of iterations.

    Convergence is quadratic: after a step of 1e-6 the error is of the order of its square. A member whose first step is
    longer than `reach`, of all or (members,), is given up: what it would find is too far from where it starts.
    """

    tolerance: float = 1e-6
    largest_step: float = 0.5
    iterations: int = 20
    reach: float | FloatArray = np.inf


@dataclass(frozen=True, slots=True)
class Solution:
    """Result of Newton's method for each member of a stack.

    x: (members, unknowns); converged: (members,), which met the tolerance; step: (members,), scaled size of the last
    step; iterations: (members,); residual: (members, equations), that of the start, NaN where no step was taken.
    """

    x: FloatArray
    converged: BoolArray
    step: FloatArray
    iterations: IntArray
    residual: FloatArray

    @property
    def outcome(self) -> ObjectArray:
        """CONVERGED or NO_CONVERGENCE, (members,)."""
        outcome = filled(self.step.size, Outcome.NO_CONVERGENCE)
        outcome[self.converged] = Outcome.CONVERGED
        return outcome


def newton(system: System, x: FloatArray, scale: FloatArray, options: NewtonOptions | None = None) -> Solution:
    """Solve many systems of nonlinear equations side by side.

    Parameters
    ----------
    system : callable
        Takes x (active, unknowns) and the indices (active,) of the members they belong to; returns residuals
        (active, unknowns) and Jacobians (active, unknowns, unknowns).
    x : (members, unknowns)
        Initial guesses; members that are not finite are not solved.
    scale : (members, unknowns)
        Scale of each unknown; the size of a step is the root mean square of step / scale. A step larger than
        `largest_step` is shortened to it.
    options : NewtonOptions, optional

    Returns
    -------
    Solution
    """
    options = options or NewtonOptions()
    x = x.copy()
    step = np.full(x.shape[0], np.inf)
    iterations = np.zeros(x.shape[0], dtype=np.intp)
    residual = np.full(x.shape, np.nan)
    active = np.flatnonzero(np.isfinite(x).all(axis=-1))
    limit = np.maximum(options.tolerance, np.broadcast_to(options.reach, step.shape))
    for _ in range(options.iterations):
        if active.size == 0:
            break
        here, change = _newton_steps(system, x, active)
        starts = iterations[active] == 0
        residual[active[starts]] = here[starts]
        size = np.sqrt(np.mean((change / scale[active]) ** 2, axis=-1))
        finite = np.isfinite(size)
        active, change, size = active[finite], change[finite], size[finite]
        x[active] += change * np.minimum(1.0, options.largest_step / np.maximum(size, 1e-300))[:, None]
        step[active] = size
        iterations[active] += 1
        lost = starts[finite] & (size > limit[active])
        active = active[(size > options.tolerance) & ~lost]
    return Solution(x, step <= options.tolerance, step, iterations, residual)


def _newton_steps(system: System, x: FloatArray, active: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return residuals and Newton steps of the active members, computed in blocks so that memory stays bounded."""
    size = max(1, BLOCK_NUMBERS // x.shape[1] ** 2)
    blocks = [active[first : first + size] for first in range(0, active.size, size)]
    parts = [_newton_step(*system(x[block], block)) for block in blocks]
    residuals, steps = (np.concatenate(part) for part in zip(*parts, strict=True))
    return residuals, steps


def _newton_step(residual: FloatArray, jacobian: FloatArray) -> tuple[FloatArray, FloatArray]:
    return residual, -solve_systems(jacobian, residual)


def solve_systems(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solve linear systems with matrices (..., n, n) and right sides (..., n): (..., n), NaN where singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0], dtype=np.float64)
    except np.linalg.LinAlgError:
        if matrix.ndim == 2:
            return np.full_like(right, np.nan)
        return np.stack([solve_systems(m, r) for m, r in zip(matrix, right, strict=True)])


def downhill(tangent: FloatArray) -> FloatArray:
    """Replace negative eigenvalues by their absolute values: (lines, freedoms, freedoms)."""
    if _are_positive_definite(tangent):
        return tangent
    upward = np.flatnonzero(~(np.linalg.eigvalsh(tangent)[:, 0] > 0.0))
    values, vectors = np.linalg.eigh(tangent[upward])
    result = tangent.copy()
    result[upward] = (vectors * np.abs(values)[:, None, :]) @ vectors.swapaxes(-1, -2)
    return result


def _are_positive_definite(matrices: FloatArray) -> bool:
    """Return whether all of a stack are, several times faster than by their eigenvalues."""
    try:
        np.linalg.cholesky(matrices)
    except np.linalg.LinAlgError:
        return False
    return True
