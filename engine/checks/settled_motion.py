"""Direct integration of reduced models from many starts side by side, until every motion has settled.

The linear part of the equations, that of the load included, is taken exactly by its matrix exponential; what is
quadratic and cubic goes through the Runge-Kutta method of fourth order in the co-ordinates that turn with it (Lawson
1967). A step has to resolve the bend of the load alone, so that weak damping is not drowned in errors of the method.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray
from engine.kernels import compiled
from engine.models.aerodynamic_load import force_gradient
from engine.models.reduced_model import ReducedModel
from engine.outcome import Outcome

STEPS = 24  # in the shortest natural period
BLOCK_PERIODS = 50  # shortest natural ones between two looks at the motion
CHANGE = 4e-6  # of the motion's size in a block, below which it counts as settled
REST = 1e-4  # of the size at the start, below which a motion counts as at rest
FARTHEST = np.pi  # rad of angle of attack, beyond which a motion has diverged


@dataclass(frozen=True, slots=True)
class Runs:
    """Where starts ended, one entry each.

    size, before: (starts, 2 m), root mean square of q and q' over the last block and over the one before it; state:
    (starts, 2 m), q and q' at the end; blocks: (starts,), number integrated; outcome: (starts,) of Outcome, CONVERGED
    where the motion settled or came to rest, LIMIT_REACHED where it still changed, NO_CONVERGENCE where it diverged;
    at_rest: (starts,).
    """

    size: FloatArray
    before: FloatArray
    state: FloatArray
    blocks: IntArray
    outcome: ObjectArray
    at_rest: BoolArray


@dataclass(frozen=True, slots=True)
class Flow:
    """The equations of a stack of starts, with the starts on the last axis.

    half: (2 m, 2 m, starts), the exponential of half a step of the linear part; bend: (points, m, monomials of degree 2
    and 3, starts), the rest of q''; forms: (points, locals, 2 m, starts), the linear forms in (q, q') that it is a
    polynomial of; step: (starts,) [s]; angle: (2 m, starts), the largest coefficients of the angle of attack along the
    span.
    """

    half: FloatArray
    bend: FloatArray
    forms: FloatArray
    step: FloatArray
    angle: FloatArray

    def pick(self, index: IntArray) -> "Flow":
        """Pick starts."""
        return Flow(*(part[..., index] for part in self.parts))

    @property
    def parts(self) -> tuple[FloatArray, ...]:
        """The fields one after another."""
        return self.half, self.bend, self.forms, self.step, self.angle


def natural_rates(model: ReducedModel, member: IntArray) -> FloatArray:
    """Return the lowest and the highest natural angular frequency of members (starts,): (2, starts) [rad/s].

    Others of the stack may be statically unstable.
    """
    known, own = np.unique(member, return_inverse=True)
    square = np.linalg.eigvals(np.linalg.solve(model.mass[known], model.stiffness[known])).real
    return np.asarray(np.sqrt(np.stack([square.min(axis=-1), square.max(axis=-1)]))[:, own])


def flow(model: ReducedModel, member: IntArray, wind_speed: FloatArray, steps: int = STEPS) -> Flow:
    """Set up the equations of members (starts,) of a stack of models at wind speeds (starts,)."""
    from scipy.linalg import expm  # noqa: PLC0415 - only who asks for the integration waits for scipy

    m, load = model.mass.shape[-1], model.load
    inverse = np.linalg.inv(model.mass)[member]
    speed = wind_speed[:, None, None]
    slope = force_gradient(load, np.zeros((model.mass.shape[0], 1, 2 * m)))[member, 0]
    by_q = inverse @ (speed**2 * slope[..., :m] - model.stiffness[member])
    by_rate = inverse @ (speed * slope[..., m:] - model.damping[member])
    linear = np.zeros((member.size, 2 * m, 2 * m))
    linear[:, :m, m:] = np.eye(m)
    linear[:, m:] = np.concatenate([by_q, by_rate], axis=-1)
    bend = speed[..., None] ** 2 * (inverse[:, None] @ load.table[member][..., load.forms.shape[-2] :])
    by_wind = np.repeat([np.ones(member.size), wind_speed], m, axis=0)
    forms = np.moveaxis(load.forms[member], 0, -1) / by_wind
    step = 2.0 * np.pi / (natural_rates(model, member)[1] * steps)
    angle = np.abs(load.angle[member]).max(axis=1).T / by_wind
    half = expm(0.5 * step[:, None, None] * linear)
    return Flow(np.moveaxis(half, 0, -1).copy(), np.moveaxis(bend, 0, -1).copy(), forms.copy(), step, angle.copy())


def advanced(equations: Flow, state: FloatArray) -> FloatArray:
    """Return the states (2 m, starts) one step later."""
    step, half = equations.step, equations.half
    m = equations.bend.shape[1]

    def turned(y: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("ijs,js->is", half, y))

    def kick(y: FloatArray, share: float, k: FloatArray) -> FloatArray:
        return np.concatenate([y[:m], y[m:] + share * step * k])

    first = _bend(equations, state)
    here = turned(state)
    second = _bend(equations, turned(kick(state, 0.5, first)))
    third = _bend(equations, kick(here, 0.5, second))
    fourth = _bend(equations, turned(kick(here, 1.0, third)))
    middle = kick(turned(kick(state, 1.0 / 6.0, first)), 1.0 / 3.0, second + third)
    return kick(turned(middle), 1.0 / 6.0, fourth)


def _bend(equations: Flow, state: FloatArray) -> FloatArray:
    """Return the quadratic and cubic part of q'': (m, starts)."""
    x = np.einsum("plks,ks->lps", equations.forms, state)
    numbers = range(x.shape[0])
    square = {pair: x[pair[0]] * x[pair[1]] for pair in itertools.combinations_with_replacement(numbers, 2)}
    cubes = itertools.combinations_with_replacement(numbers, 3)
    terms = np.stack([*square.values(), *(square[i, j] * x[k] for i, j, k in cubes)])
    return np.asarray(np.einsum("pots,tps->os", equations.bend, terms))


def settled(
    model: ReducedModel,
    member: IntArray,
    wind_speed: FloatArray,
    start: FloatArray,
    longest: IntArray | int,
    steps: int = STEPS,
) -> Runs:
    """Integrate starts until their motion changes no more.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member, wind_speed : (starts,)
    start : (starts, 2 m)
        q and q'.
    longest : (starts,) or int
        Number of blocks after which a start is given up.
    steps : int
        In the shortest natural period.

    Returns
    -------
    Runs
    """
    equations = flow(model, member, wind_speed, steps)
    decays = np.abs(np.linalg.eigvals(np.moveaxis(equations.half, -1, 0))).max(axis=-1, initial=0.0) < 1.0
    mass = np.diagonal(model.mass, axis1=-2, axis2=-1)[member].T
    rate = np.sqrt(np.diagonal(model.stiffness, axis1=-2, axis2=-1)[member].T / mass)
    weight = np.sqrt(np.concatenate([mass * rate**2, mass]))
    state, size, before = start.T.copy(), np.full_like(start.T, np.inf), np.full_like(start.T, np.inf)
    blocks, at_rest = np.zeros(member.size, dtype=np.intp), np.zeros(member.size, dtype=np.bool_)
    outcome = np.full(member.size, Outcome.LIMIT_REACHED, dtype=np.object_)
    first, last = np.linalg.norm(weight * start.T, axis=0), np.broadcast_to(longest, member.shape)
    active = np.arange(member.size)
    while active.size:
        state[:, active], now, angle = _block(equations, state[:, active], steps)
        before[:, active], size[:, active] = size[:, active], now
        blocks[active] += 1
        whole, change = (np.linalg.norm(weight[:, active] * x, axis=0) for x in (now, now - before[:, active]))
        far, rest = ~(angle < FARTHEST), (whole < REST * first[active]) & decays[active]
        done = rest | (change < CHANGE * whole)
        at_rest[active], outcome[active[done]] = rest, Outcome.CONVERGED
        outcome[active[far]] = Outcome.NO_CONVERGENCE
        kept = np.flatnonzero(~done & ~far & (blocks[active] < last[active]))
        active, equations = active[kept], equations.pick(kept)
    return Runs(size.T, before.T, state.T, blocks, outcome, at_rest)


def _block(equations: Flow, state: FloatArray, steps: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate one block: the state after it, the root mean square of q and q' under Hann's window, and the angle.

    The window falls off smoothly to both ends, so that the part of a period that does not fill the block counts little.
    """
    count = BLOCK_PERIODS * steps
    window = 2.0 / count * np.sin(np.pi * np.arange(count) / count) ** 2
    if compiled.AVAILABLE:
        state, square, largest = compiled.integrated_block(equations.parts, state, window)
        return state, np.sqrt(square), largest
    square, largest = np.zeros_like(state), np.zeros(state.shape[1])
    with np.errstate(over="ignore", invalid="ignore"):
        for share in window.tolist():
            state = advanced(equations, state)
            square += share * state**2
            largest = np.maximum(largest, np.linalg.norm(equations.angle * state, axis=0))
    return state, np.sqrt(square), largest
