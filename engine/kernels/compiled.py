"""Calls of the compiled kernels (engine/kernels/*.c), one for each function that uses one. Decision 0010.

AVAILABLE is False where the kernels were not built. The callers then run their own numpy forms, against which the
kernels are tested.
"""

from typing import TYPE_CHECKING, Protocol

import numpy as np

from engine.arrays import AnyArray, ComplexArray, FloatArray, IntArray
from engine.kernels.layout import contiguous, model_parts, model_shape, unexpanded_parts
from engine.numerics.newton import NewtonOptions, Solution
from engine.spec import AerodynamicModel

if TYPE_CHECKING:  # kernels stand below the models, whose arrays they read
    from engine.models.reduced_model import ReducedModel
    from engine.models.relative_wind import NodalMotion
    from engine.models.unexpanded_load import UnexpandedLoad


class UnexpandedStarts(Protocol):
    """The terms of an unexpanded load in the equations of starts, as `engine.checks.settled_motion` sets them up."""

    @property
    def gain(self) -> FloatArray: ...  # noqa: D102
    @property
    def linear(self) -> FloatArray: ...  # noqa: D102
    @property
    def wind_speed(self) -> FloatArray: ...  # noqa: D102
    @property
    def member(self) -> IntArray: ...  # noqa: D102
    @property
    def load(self) -> "UnexpandedLoad": ...  # noqa: D102


try:
    from engine.kernels._kernels import eigenvalues, even_parts, flows, linearization, monodromies, newton, reaches

    AVAILABLE = True
except ImportError:
    AVAILABLE = False


def solved_balances(
    model: "ReducedModel",
    member: IntArray,
    wind_speed: FloatArray,
    phase: FloatArray,
    guess: tuple[FloatArray, FloatArray, NewtonOptions],
) -> Solution:
    """Solve harmonic balances by Newton's method, for `engine.cycles.harmonic_balance.balance`.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member, wind_speed : (cycles,)
        The index of each cycle's model, and its wind speed [m/s].
    phase : (cycles, m (2 H + 1))
        The row of the phase condition.
    guess : tuple
        Starts and scales (cycles, m (2 H + 1) + 1), and options.

    Returns
    -------
    Solution
    """
    start, scale, options = guess
    none = np.empty(0)
    return _newton(model, (member, wind_speed, phase, start, scale, none, none), (start, none), options)


def followed_balances(
    model: "ReducedModel",
    member: IntArray,
    phase: tuple[FloatArray, FloatArray],
    condition: tuple[FloatArray, FloatArray],
    guess: tuple[FloatArray, FloatArray, NewtonOptions],
) -> tuple[Solution, FloatArray]:
    """Solve harmonic balances with one more unknown, the wind speed, and one more linear condition, for branches.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (cycles,)
    phase : pair of arrays
        The row of the phase condition (cycles, m (2 H + 1)), and the points from which it measures (cycles, unknowns).
    condition : pair of arrays
        A row (cycles, unknowns) and the value (cycles,) that its product with the unknowns must have.
    guess : tuple
        Starts and scales (cycles, unknowns), unknowns = m (2 H + 1) + 2, and options.

    Returns
    -------
    Solution, (cycles, unknowns)
        The solution, and the tangent: the direction in which the residuals stay and the row's product grows by one, at
        the point before the last step.
    """
    start, scale, options = guess
    reference, anchor = phase
    tangent = np.full(start.shape, np.nan)
    cycles = (member, np.empty(0), reference, anchor, scale, *condition)
    return _newton(model, cycles, (start, tangent), options), tangent


def _newton(
    model: "ReducedModel", cycles: tuple[AnyArray, ...], guess: tuple[FloatArray, FloatArray], options: NewtonOptions
) -> Solution:
    start, tangent = guess
    x = np.array(start, order="C")
    step, iterations = np.full(x.shape[0], np.inf), np.zeros(x.shape[0], dtype=np.intp)
    harmonics = cycles[2].shape[-1] // model.mass.shape[-1] // 2
    residual = np.full(cycles[2].shape, np.nan)  # without the conditions
    limits = (options.tolerance, options.largest_step, options.iterations)
    size = (x.shape[0], harmonics, tangent.size > 0)
    reach = np.broadcast_to(options.reach, step.shape)
    results = (x, step, iterations, residual, tangent)
    newton(model_parts(model), model_shape(model), size, contiguous(*cycles, reach), limits, results)
    return Solution(x, step <= options.tolerance, step, iterations, residual)


def balance_slopes(
    model: "ReducedModel", member: IntArray, orbits: tuple[FloatArray, ...]
) -> tuple[FloatArray, FloatArray]:
    """Evaluate the harmonic balance and its slopes, for `engine.cycles.harmonic_balance.linearized`.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (cycles,)
    orbits : tuple of arrays
        Coefficients (cycles, m, 2 H + 1), angular frequency [rad/s] and wind speed [m/s] (cycles,).

    Returns
    -------
    (cycles, n), (cycles, n, n + 2)
        Residuals, and their derivatives by the n = m (2 H + 1) coefficients, the angular frequency and the wind speed.
    """
    cycles, m, size = orbits[0].shape
    n = m * size
    residuals, slopes = np.empty((cycles, n)), np.empty((cycles, n, n + 2))
    cycle_arrays = contiguous(member, *orbits)
    linearization(model_parts(model), model_shape(model), (cycles, size // 2), cycle_arrays, (residuals, slopes))
    return residuals, slopes


def products_over_period(
    model: "ReducedModel",
    orbits: tuple[AnyArray, ...],
    basis: tuple[FloatArray, FloatArray],
    steps: tuple[IntArray, IntArray],
) -> FloatArray:
    """Integrate the linearized equations over one period, for `engine.cycles.floquet.monodromy`.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    orbits : tuple of arrays
        Index of each cycle's model (cycles,), inverse mass (members, m, m), coefficients (cycles, m, 2 H + 1), angular
        frequency [rad/s] and wind speed [m/s] (cycles,).
    basis : pair of arrays (rows, 2 H + 1)
        The Fourier basis and its derivative at Gauss points.
    steps : pair of arrays (cycles,)
        Number of steps, a multiple of four, and the row of `basis` where the cycle begins: the first Gauss points of
        all its steps, then the second ones.

    Returns
    -------
    (cycles, 2 m, 2 m)
        Monodromy matrices; NaN where the number of steps is 0.
    """
    cycles, m, size = orbits[2].shape
    matrices = np.empty((cycles, 2 * m, 2 * m))
    cycle_arrays = contiguous(*orbits, *basis, *steps)
    monodromies(model_parts(model), model_shape(model), (cycles, basis[0].shape[0], size // 2), cycle_arrays, matrices)
    return matrices


def small_eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Return the eigenvalues (cycles, n) of finite matrices (cycles, n, n), NaN where the kernel's method fails."""
    values = np.empty((*matrices.shape[:2], 2))
    eigenvalues((matrices.shape[0], matrices.shape[1]), np.ascontiguousarray(matrices), values)
    return values.view(np.complex128)[..., 0]


def even_part(
    polynomials: FloatArray, statics: FloatArray, member: IntArray, angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Evaluate the scalar equation of the explicit first harmonic, for `engine.cycles.first_harmonic`.

    Parameters
    ----------
    polynomials, statics : (members, 4, 7) and (members, 3)
    member, angle : arrays that broadcast to (...)
        Index of the model, and amplitude R of the angle of attack [rad].

    Returns
    -------
    pair of arrays (..., 2)
        The even part of the polynomial at both roots w^2 of its odd part, and those roots.
    """
    even, square = np.empty((2, *angle.shape, 2))
    inputs = (polynomials, statics, np.broadcast_to(member, angle.shape), angle)
    even_parts((polynomials.shape[0], angle.size), contiguous(*inputs), (even, square))
    return even, square


def largest_reaches(motion: "NodalMotion", member: IntArray, state: FloatArray) -> FloatArray:
    """Find the largest angles of attack and velocity ratios; as `engine.models.relative_wind.largest_reach`."""
    motions, samples, width = state.shape
    (members, nodes, *_), subconductors = motion.forms.shape, motion.arms.shape[-2]
    arms = np.broadcast_to(motion.arms, (members, nodes, subconductors, 2))
    reach = np.empty((2, motions))
    published = motion.model is AerodynamicModel.PUBLISHED
    size = (members, motions, samples, nodes, width // 2, subconductors, published)
    reaches(size, contiguous(motion.forms, arms, motion.diameter, member, state.swapaxes(-1, -2)), reach)
    return reach


def integrated_block(
    equations: tuple[FloatArray, ...], unexpanded: UnexpandedStarts | None, state: FloatArray, window: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate the equations of motion over the window's steps, for `engine.checks.settled_motion`.

    Parameters
    ----------
    equations : tuple of arrays
        The arrays of `engine.checks.settled_motion.LawsonEquations`.
    unexpanded : UnexpandedStarts, optional
        Its terms of an unexpanded load.
    state : (2 m, starts)
        q and q'.
    window : (steps,)
        Weight of each step in the sums of squares.

    Returns
    -------
    (2 m, starts), (2 m, starts), (starts,)
        The states at the end, the weighted sums of squares over the steps, and the largest angle of attack [rad].
    """
    _, _, outward, forms, restoring, *_ = equations
    points, m, rows, starts = outward.shape
    end = np.array(state, order="C")
    square, largest = np.empty(end.shape), np.empty(starts)
    size = (starts, window.size, m, points, rows, forms.shape[1], restoring.size > 0)
    results = (end, square, largest)
    if unexpanded is None:
        flows(size, contiguous(*equations, window), results)
    else:
        load = unexpanded.load
        extra = contiguous(unexpanded.gain, unexpanded.linear, unexpanded.wind_speed, unexpanded.member)
        shape = load.fields.shape[-3], load.present.shape[-1]
        none = (load.fields,) * 6  # of the model's structure only the number of members is read
        flows(size, contiguous(*equations, window), results, (*extra, *shape), (*none, *unexpanded_parts(load)))
    return end, square, np.sqrt(largest)
