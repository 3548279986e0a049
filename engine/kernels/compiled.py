"""The compiled kernels (engine/kernels/*.c) for the functions that they serve. Decision 0010.

Where they were not built AVAILABLE is False, and the numpy forms beside the callers, which are their tests, serve.
"""

import numpy as np

from engine.arrays import AnyArray, FloatArray, IntArray
from engine.models.reduced_model import ReducedModel
from engine.numerics.newton import NewtonOptions, Solution, solution_from_steps

try:
    from engine.kernels._kernels import even_parts, flows, linearization, monodromies, newton

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
    """Solve harmonic balances by Newton's method as `engine.numerics.newton.newton` would.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member, wind_speed : (cycles,)
        The model of each cycle, and its wind speed [m/s].
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
    """Solve harmonic balances with the wind speed as one more unknown and one more linear condition.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (cycles,)
    phase : pair of arrays
        The row of the phase condition (cycles, m (2 H + 1)), and the points that it is relative to (cycles, unknowns).
    condition : pair of arrays
        A row (cycles, unknowns) and the value (cycles,) that its product with the unknowns must have.
    guess : tuple
        Starts and scales (cycles, unknowns), unknowns = m (2 H + 1) + 2, and options.

    Returns
    -------
    Solution, (cycles, unknowns)
        With the direction in which the row's product alone grows, at the point before the last step.
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
    """Evaluate the harmonic balance with its slopes as `engine.cycles.harmonic_balance.linearized` would.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (cycles,)
    orbits : tuple of arrays
        Coefficients (cycles, m, 2 H + 1), angular frequency and wind speed (cycles,).

    Returns
    -------
    (cycles, n), (cycles, n, n + 2)
    """
    cycles, m, size = orbits[0].shape
    n = m * size
    residuals, slopes = np.empty((cycles, n)), np.empty((cycles, n, n + 2))
    places = _contiguous(member, *orbits)
    linearization(_parts(model), _shape(model), (cycles, size // 2), places, (residuals, slopes))
    return residuals, slopes


def products_over_period(
    model: ReducedModel,
    orbits: tuple[AnyArray, ...],
    basis: tuple[FloatArray, FloatArray],
    steps: tuple[IntArray, IntArray],
) -> FloatArray:
    """Integrate the linearized equations over one period as `engine.cycles.floquet` would.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    orbits : tuple of arrays
        The model of each (cycles,), inverse mass (members, m, m), coefficients (cycles, m, 2 H + 1), angular frequency
        and wind speed (cycles,).
    basis : pair of arrays (rows, 2 H + 1)
        The Fourier basis and its derivative at Gauss points.
    steps : pair of arrays (cycles,)
        Number of steps, a multiple of four, and the row where the cycle's Gauss points begin: first those of all steps
        that come first, then the others.

    Returns
    -------
    (cycles, 2 m, 2 m)
        NaN where the number of steps is 0.
    """
    cycles, m, size = orbits[2].shape
    matrices = np.empty((cycles, 2 * m, 2 * m))
    places = _contiguous(*orbits, *basis, *steps)
    monodromies(_parts(model), _shape(model), (cycles, basis[0].shape[0], size // 2), places, matrices)
    return matrices


def even_part(
    polynomials: FloatArray, statics: FloatArray, member: IntArray, angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Evaluate the scalar equation of the explicit first harmonic as `engine.cycles.first_harmonic` would.

    Parameters
    ----------
    polynomials, statics : (members, 4, 7) and (members, 3)
    member, angle : arrays that broadcast to (...)
        Where, and the amplitude R [rad].

    Returns
    -------
    pair of arrays (..., 2)
        The even part of the polynomial at both roots w^2 of its odd part, and those roots.
    """
    even, square = np.empty((2, *angle.shape, 2))
    places = (polynomials, statics, np.broadcast_to(member, angle.shape), angle)
    even_parts((polynomials.shape[0], angle.size), _contiguous(*places), (even, square))
    return even, square


def integrated_block(
    equations: tuple[FloatArray, ...], state: FloatArray, window: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate the equations of motion over the window's steps, as `engine.checks.settled_motion` would.

    Parameters
    ----------
    equations : tuple of arrays
        The fields of `engine.checks.settled_motion.LawsonEquations`.
    state : (2 m, starts)
    window : (steps,)

    Returns
    -------
    (2 m, starts), (2 m, starts), (starts,)
        The states at the end, the sums of their squares times the window, and the largest angle of attack [rad].
    """
    _, nonlinear, forms, *_ = equations
    points, m, _, starts = nonlinear.shape
    moved = np.array(state, order="C")
    square, largest = np.empty(moved.shape), np.empty(starts)
    size = (starts, window.size, m, points, forms.shape[1])
    flows(size, _contiguous(*equations, window), (moved, square, largest))
    return moved, square, np.sqrt(largest)


def _shape(model: ReducedModel) -> tuple[int, int, int, int]:
    """Return members, coordinates, points and local variables."""
    members, points, local, twice = model.load.forms.shape
    return members, twice // 2, points, local


def _parts(model: ReducedModel) -> tuple[AnyArray, ...]:
    load = model.load
    return _contiguous(model.mass, model.damping, model.stiffness, load.forms, load.table, load.slopes)


def _contiguous(*arrays: AnyArray) -> tuple[AnyArray, ...]:
    return tuple(np.ascontiguousarray(array) for array in arrays)
