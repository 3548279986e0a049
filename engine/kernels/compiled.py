"""Calls of the compiled kernels (engine/kernels/*.c), one for each function that uses one. Decision 0010.

AVAILABLE is False where the kernels were not built. The callers then run their own numpy forms, against which the
kernels are tested.
"""

from typing import Protocol

import numpy as np

from engine.arrays import AnyArray, FloatArray, IntArray
from engine.models.reduced_model import ReducedModel
from engine.models.relative_wind import NodalMotion
from engine.models.unexpanded_load import UnexpandedLoad
from engine.numerics.newton import NewtonOptions, Solution, solution_from_steps
from engine.spec import AerodynamicModel


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
    def load(self) -> UnexpandedLoad: ...  # noqa: D102


try:
    from engine.kernels._kernels import even_parts, flows, linearization, monodromies, newton, reaches

    AVAILABLE = True
except ImportError:
    AVAILABLE = False


def solved_balances(
    model: ReducedModel,
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
    model: ReducedModel,
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
    model: ReducedModel, cycles: tuple[AnyArray, ...], guess: tuple[FloatArray, FloatArray], options: NewtonOptions
) -> Solution:
    start, tangent = guess
    x = np.array(start, order="C")
    step, iterations = np.full(x.shape[0], np.inf), np.zeros(x.shape[0], dtype=np.intp)
    harmonics = cycles[2].shape[-1] // model.mass.shape[-1] // 2
    limits = (options.tolerance, options.largest_step, options.iterations)
    size = (x.shape[0], harmonics, tangent.size > 0)
    newton(_parts(model), _shape(model), size, _contiguous(*cycles), limits, (x, step, iterations, tangent))
    return solution_from_steps(x, step, iterations, options)


def balance_slopes(
    model: ReducedModel, member: IntArray, orbits: tuple[FloatArray, ...]
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
    cycle_arrays = _contiguous(member, *orbits)
    linearization(_parts(model), _shape(model), (cycles, size // 2), cycle_arrays, (residuals, slopes))
    return residuals, slopes


def products_over_period(
    model: ReducedModel,
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
    cycle_arrays = _contiguous(*orbits, *basis, *steps)
    monodromies(_parts(model), _shape(model), (cycles, basis[0].shape[0], size // 2), cycle_arrays, matrices)
    return matrices


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
    even_parts((polynomials.shape[0], angle.size), _contiguous(*inputs), (even, square))
    return even, square


def largest_reaches(motion: NodalMotion, member: IntArray, state: FloatArray) -> FloatArray:
    """Find the largest angles of attack and velocity ratios; as `engine.models.relative_wind.largest_reach`."""
    motions, samples, width = state.shape
    (members, nodes, *_), subconductors = motion.forms.shape, motion.arms.shape[-2]
    arms = np.broadcast_to(motion.arms, (members, nodes, subconductors, 2))
    reach = np.empty((2, motions))
    published = motion.model is AerodynamicModel.PUBLISHED
    size = (members, motions, samples, nodes, width // 2, subconductors, published)
    reaches(size, _contiguous(motion.forms, arms, motion.diameter, member, state), reach)
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
        flows(size, _contiguous(*equations, window), results)
    else:
        load = unexpanded.load
        extra = _contiguous(unexpanded.gain, unexpanded.linear, unexpanded.wind_speed, unexpanded.member)
        shape = load.fields.shape[-3], load.present.shape[-1]
        none = (load.fields,) * 5  # of the model's structure only the number of members is read
        flows(size, _contiguous(*equations, window), results, (*extra, *shape), (*none, *_unexpanded_parts(load)))
    return end, square, np.sqrt(largest)


def _shape(model: ReducedModel) -> tuple[int, int, int, int, bool, int]:
    """Return members, coordinates, points, local variables, whether the model stretches, and samples in a period.

    An unexpanded load has sub-conductors in place of local variables; otherwise the number of samples is 0.
    """
    load, m = model.unexpanded, model.mass.shape[-1]
    members, stretches = model.mass.shape[0], model.stretching is not None
    if load is not None:
        return members, m, load.fields.shape[-3], load.present.shape[-1], stretches, load.samples
    return members, m, *model.load.forms.shape[1:3], stretches, 0


def _parts(model: ReducedModel) -> tuple[AnyArray, ...]:
    load, stretching, none = model.load, model.stretching, np.empty(0)
    own = (none, none) if stretching is None else (stretching.table, stretching.slopes)
    structure = (model.mass, model.damping, model.stiffness, *own)
    if model.unexpanded is not None:
        return (*_contiguous(*structure), *_unexpanded_parts(model.unexpanded))
    return _contiguous(*structure, load.forms, load.table, load.slopes)


def _unexpanded_parts(load: UnexpandedLoad) -> tuple[AnyArray, ...]:
    curves = load.curves
    first, begins = curves.pieces
    return _contiguous(
        load.which,
        first,
        curves.periodic.astype(np.intp),
        curves.turning.astype(np.intp),
        load.fields,
        load.strength,
        load.factor,
        load.diameter,
        load.positions,
        load.present,
        load.rest_angle,
        load.at_rest,
        curves.origin,
        curves.density,
        begins,
        curves.knots,
        curves.powers,
    )


def _contiguous(*arrays: AnyArray) -> tuple[AnyArray, ...]:
    return tuple(np.ascontiguousarray(array) for array in arrays)
