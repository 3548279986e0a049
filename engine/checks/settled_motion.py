"""Integrate reduced models directly from many starts side by side, until every motion has settled.

Only the nonlinear terms are stepped by the fourth-order Runge-Kutta method; the linear part, the load's linear terms
included, is integrated exactly by its matrix exponential (Lawson 1967). The step only has to resolve the nonlinear
terms, so weak damping is not lost in the error of the method.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, filled
from engine.checks.wind_polynomials import WindPolynomials, wind_polynomials
from engine.kernels import compiled
from engine.models.reduced_model import ReducedModel, force_gradient
from engine.models.unexpanded_load import UnexpandedLoad
from engine.models.unexpanded_load import force as unexpanded_force
from engine.outcome import Outcome

STEPS = 24  # in the shortest natural period
BLOCK_PERIODS = 50  # shortest natural periods in a block; the motion is examined after each block
SETTLED_CHANGE = 4e-6  # change of the motion's size in a block, relative to it, below which it has settled
REST = 1e-4  # size relative to the start's, below which the motion counts as at rest
LARGEST_ANGLE = np.pi  # rad of angle of attack, beyond which a motion has diverged


@dataclass(frozen=True, slots=True)
class SettledMotions:
    """The motions that starts settled on, one entry per start.

    size, before: (starts, 2 m), root mean square of q and q' over the last block and over the one before it; state:
    (starts, 2 m), q and q' at the end; blocks: (starts,), number of blocks integrated; outcome: (starts,) of Outcome,
    CONVERGED where the motion settled or came to rest, LIMIT_REACHED where it was still changing, NO_CONVERGENCE where
    it diverged; at_rest: (starts,), True where it came to rest.
    """

    size: FloatArray
    before: FloatArray
    state: FloatArray
    blocks: IntArray
    outcome: ObjectArray
    at_rest: BoolArray


@dataclass(frozen=True, slots=True)
class UnexpandedTerms:
    """The nonlinear part of an unexpanded load in q'', gain f(q, q'/U) - linear (q, q'); starts on the last axis.

    gain: (m, m, starts); linear: (m, 2 m, starts); wind_speed: (starts,) [m/s]; member: (starts,), index of the load of
    each start; load: leading axis (members,).
    """

    gain: FloatArray
    linear: FloatArray
    wind_speed: FloatArray
    member: IntArray
    load: UnexpandedLoad

    def select(self, index: IntArray) -> "UnexpandedTerms":
        """Select starts by their indices."""
        gain, linear = self.gain[..., index], self.linear[..., index]
        return UnexpandedTerms(gain, linear, self.wind_speed[index], self.member[index], self.load)

    def acceleration(self, state: FloatArray) -> FloatArray:
        """Return this part of q'' at states (2 m, starts): (m, starts)."""
        m = self.gain.shape[0]
        scaled = np.concatenate([state[:m], state[m:] / self.wind_speed]).T[:, None]
        load = unexpanded_force(self.load.take(self.member), scaled)[:, 0].T
        return np.asarray(np.einsum("ijs,js->is", self.gain, load) - np.einsum("iks,ks->is", self.linear, state))


@dataclass(frozen=True, slots=True)
class LawsonEquations:
    """The equations of motion of a stack of starts in the form that Lawson's method steps; starts on the last axis.

    half_step: (2 m, 2 m, starts), matrix exponential of the linear part over half a step; nonlinear: (points, rows,
    monomials of degree 2 and 3, starts), coefficients of the wind's forces; outward: (points, m, rows, starts), the
    share of each force in q''; forms: (points, local variables, 2 m, starts), the linear forms in (q, q') that these
    monomials are taken of; restoring: (m, monomials of degree 2 and 3 of q, starts), coefficients of the part of
    stretching, no monomials where it is neglected; step:
    (starts,) [s]; angle: (2 m, starts), largest coefficients of the angle of attack along the span; unexpanded: the
    wind's part where its load is unexpanded, and then no points.
    """

    half_step: FloatArray
    nonlinear: FloatArray
    outward: FloatArray
    forms: FloatArray
    restoring: FloatArray
    step: FloatArray
    angle: FloatArray
    unexpanded: UnexpandedTerms | None = None

    def select(self, index: IntArray) -> "LawsonEquations":
        """Select starts by their indices."""
        unexpanded = None if self.unexpanded is None else self.unexpanded.select(index)
        half_step, nonlinear, outward, forms, restoring, step, angle = (part[..., index] for part in self.parts)
        return LawsonEquations(half_step, nonlinear, outward, forms, restoring, step, angle, unexpanded)

    @property
    def parts(self) -> tuple[FloatArray, ...]:
        """The arrays in their order."""
        return self.half_step, self.nonlinear, self.outward, self.forms, self.restoring, self.step, self.angle


def natural_frequency_range(model: ReducedModel, member: IntArray) -> FloatArray:
    """Return the lowest and the highest natural angular frequency of members (starts,): (2, starts) [rad/s].

    The members must be statically stable; the other models of the stack need not be.
    """
    known, own = np.unique(member, return_inverse=True)
    square = np.linalg.eigvals(np.linalg.solve(model.mass[known], model.stiffness[known])).real
    return np.asarray(np.sqrt(np.stack([square.min(axis=-1), square.max(axis=-1)]))[:, own])


def lawson_equations(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, steps: int = STEPS
) -> LawsonEquations:
    """Set up the equations of members (starts,) of a stack of models at wind speeds (starts,)."""
    from scipy.linalg import expm  # noqa: PLC0415 - import scipy only when integration is asked for

    m = model.mass.shape[-1]
    inverse = np.asarray(np.linalg.inv(model.mass)[member], dtype=np.float64)
    speed = wind_speed[:, None, None]
    slope = force_gradient(model, np.zeros((model.mass.shape[0], 1, 2 * m)))[member, 0]
    by_q = inverse @ (speed**2 * slope[..., :m] - model.stiffness[member])
    by_rate = inverse @ (speed * slope[..., m:] - model.damping[member])
    linear = np.zeros((member.size, 2 * m, 2 * m))
    linear[:, :m, m:] = np.eye(m)
    linear[:, m:] = np.concatenate([by_q, by_rate], axis=-1)
    by_wind = np.repeat([np.ones(member.size), wind_speed], m, axis=0)
    wind, unexpanded = _wind_terms(model, member, wind_speed, speed**2 * inverse)
    step = 2.0 * np.pi / (natural_frequency_range(model, member)[1] * steps)
    angle = np.abs(model.load.angle[member]).max(axis=1).T / by_wind
    half_step = expm(0.5 * step[:, None, None] * linear)
    return LawsonEquations(
        np.moveaxis(half_step, 0, -1).copy(),
        np.moveaxis(wind.table, 0, -1).copy(),
        np.moveaxis((speed**2 * inverse)[:, None] @ wind.outward, 0, -1).copy(),
        np.moveaxis(wind.forms, 0, -1) / by_wind,
        np.moveaxis(_restoring_coefficients(model, inverse, member), 0, -1).copy(),
        step,
        angle.copy(),
        unexpanded,
    )


def _wind_terms(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, gain: FloatArray
) -> tuple[WindPolynomials, UnexpandedTerms | None]:
    """Return the wind's nonlinear polynomials, or the terms of an unexpanded load, and then no points.

    gain: (starts, m, m), U^2 M^-1.
    """
    m = model.mass.shape[-1]
    if model.unexpanded is None:
        return wind_polynomials(model.load, member), None
    slope = force_gradient(model, np.zeros((model.mass.shape[0], 1, 2 * m)))[member, 0]
    linear = gain @ slope / np.repeat([np.ones(member.size), wind_speed], m, axis=0).T[:, None]
    gain, linear = (np.moveaxis(part, 0, -1).copy() for part in (gain, linear))
    unexpanded = UnexpandedTerms(gain, linear, wind_speed, member, model.unexpanded)
    shapes = ((1, 2 * m), (1, 2), (m, 1))
    return WindPolynomials(*(np.zeros((member.size, 0, *shape)) for shape in shapes)), unexpanded


def _restoring_coefficients(model: ReducedModel, inverse: FloatArray, member: IntArray) -> FloatArray:
    """Return the coefficients of -M^-1 g over the monomials of degree 2 and 3: (starts, m, monomials)."""
    if model.stretching is None:
        return np.zeros((*inverse.shape[:2], 0))
    return np.asarray(-inverse @ model.stretching.table[member][..., inverse.shape[-1] :])


def lawson_step(equations: LawsonEquations, state: FloatArray) -> FloatArray:
    """Return the states (2 m, starts) after one step of Lawson's fourth-order Runge-Kutta method."""
    step, half_step = equations.step, equations.half_step
    m = equations.outward.shape[1]

    def propagate(y: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("ijs,js->is", half_step, y))

    def add_acceleration(y: FloatArray, share: float, k: FloatArray) -> FloatArray:
        return np.concatenate([y[:m], y[m:] + share * step * k])

    first = _nonlinear_acceleration(equations, state)
    here = propagate(state)
    second = _nonlinear_acceleration(equations, propagate(add_acceleration(state, 0.5, first)))
    third = _nonlinear_acceleration(equations, add_acceleration(here, 0.5, second))
    fourth = _nonlinear_acceleration(equations, propagate(add_acceleration(here, 1.0, third)))
    middle = add_acceleration(propagate(add_acceleration(state, 1.0 / 6.0, first)), 1.0 / 3.0, second + third)
    return add_acceleration(propagate(middle), 1.0 / 6.0, fourth)


def _nonlinear_acceleration(equations: LawsonEquations, state: FloatArray) -> FloatArray:
    """Return the quadratic and cubic part of q'' at states (2 m, starts): (m, starts)."""
    terms = _higher_monomials(np.einsum("plks,ks->lps", equations.forms, state))
    by_wind = np.einsum("pors,prs->os", equations.outward, np.einsum("prts,tps->prs", equations.nonlinear, terms))
    if equations.unexpanded is not None:
        by_wind = by_wind + equations.unexpanded.acceleration(state)
    m, count, _ = equations.restoring.shape
    if not count:
        return np.asarray(by_wind)
    return np.asarray(by_wind + np.einsum("ots,ts->os", equations.restoring, _higher_monomials(state[:m])))


def _higher_monomials(x: FloatArray) -> FloatArray:
    """Return the monomials of degree 2 and 3 of variables (variables, ...): (monomials, ...)."""
    numbers = range(x.shape[0])
    square = {pair: x[pair[0]] * x[pair[1]] for pair in itertools.combinations_with_replacement(numbers, 2)}
    cubes = itertools.combinations_with_replacement(numbers, 3)
    return np.stack([*square.values(), *(square[i, j] * x[k] for i, j, k in cubes)])


def integrate_until_settled(
    model: ReducedModel,
    member: IntArray,
    wind_speed: FloatArray,
    start: FloatArray,
    most_blocks: IntArray | int,
    steps: int = STEPS,
) -> SettledMotions:
    """Integrate starts until their motion no longer changes.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member, wind_speed : (starts,)
    start : (starts, 2 m)
        q and q'.
    most_blocks : (starts,) or int
        Number of blocks after which the integration of a start stops.
    steps : int
        Number of steps in the shortest natural period.

    Returns
    -------
    SettledMotions
    """
    equations = lawson_equations(model, member, wind_speed, steps)
    linearly_stable = np.abs(np.linalg.eigvals(np.moveaxis(equations.half_step, -1, 0))).max(axis=-1, initial=0.0) < 1.0
    mass = model.modal_masses[member].T
    rate = np.sqrt(model.uncoupled_squares[member].T)
    weight = np.sqrt(np.concatenate([mass * rate**2, mass]))
    state, size, before = start.T.copy(), np.full_like(start.T, np.inf), np.full_like(start.T, np.inf)
    blocks, at_rest = np.zeros(member.size, dtype=np.intp), np.zeros(member.size, dtype=np.bool_)
    outcome = filled(member.size, Outcome.LIMIT_REACHED)
    first, last = np.linalg.norm(weight * start.T, axis=0), np.broadcast_to(most_blocks, member.shape)
    active = np.arange(member.size)
    while active.size:
        state[:, active], now, angle = _block(equations, state[:, active], steps)
        before[:, active], size[:, active] = size[:, active], now
        blocks[active] += 1
        total, change = (np.linalg.norm(weight[:, active] * x, axis=0) for x in (now, now - before[:, active]))
        diverged, at_rest_now = ~(angle < LARGEST_ANGLE), (total < REST * first[active]) & linearly_stable[active]
        done = at_rest_now | (change < SETTLED_CHANGE * total)
        at_rest[active], outcome[active[done]] = at_rest_now, Outcome.CONVERGED
        outcome[active[diverged]] = Outcome.NO_CONVERGENCE
        kept = np.flatnonzero(~done & ~diverged & (blocks[active] < last[active]))
        active, equations = active[kept], equations.select(kept)
    return SettledMotions(size.T, before.T, state.T, blocks, outcome, at_rest)


def _block(equations: LawsonEquations, state: FloatArray, steps: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate one block.

    Returns the state at its end, the root mean square of q and q' weighted with Hann's window, and the largest angle of
    attack [rad]. The window falls off smoothly towards both ends, so an incomplete period at the end counts little.
    """
    count = BLOCK_PERIODS * steps
    window = 2.0 / count * np.sin(np.pi * np.arange(count) / count) ** 2
    if compiled.AVAILABLE:
        state, square, largest = compiled.integrated_block(equations.parts, equations.unexpanded, state, window)
        return state, np.sqrt(square), largest
    square, largest = np.zeros_like(state), np.zeros(state.shape[1])
    with np.errstate(over="ignore", invalid="ignore"):
        for share in window.tolist():
            state = lawson_step(equations, state)
            square += share * state**2
            largest = np.maximum(largest, np.linalg.norm(equations.angle * state, axis=0))
    return state, np.sqrt(square), largest
