"""Branches of limit cycles over the wind speed: where they start, how they are followed and where they end.

Theory section 7.2. A point of a branch holds the coefficients of the cycle, its angular frequency and the wind speed.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, lengths, merged
from engine.cycles.harmonic_balance import Orbits, basis, first_angle, linearized, pick, whole_size
from engine.kernels import compiled
from engine.models.critical_wind_speeds import Crossings, critical_modes
from engine.models.reduced_model import ReducedModel, lowest_frequency
from engine.numerics.continuation import (
    Points,
    Problem,
    Start,
    Steps,
    branches,
    corrected_by_newton,
    interpolated,
    points_at,
    tangents,
)
from engine.numerics.newton import Options, Solution

STEPS = Steps(first=0.2)
REFERENCE_ANGLE = 0.05  # rad; amplitudes below the one with this angle of attack are measured by it
SMALLEST_SHARE = 0.2  # of the whole size, by which a co-ordinate that hardly moves is measured
LARGEST_ANGLE = 0.5 * np.pi  # rad; an amplitude beyond broadside has no meaning
SLOWEST = 0.1  # of the lowest natural frequency: a slower solution is a static one in disguise
REACHED = 0.02  # relative distance in wind speed and frequency at which a branch ends in a Hopf point
LAST = slice(-1, None)
PARTS = 8  # of a segment between two points, in which crossings of a wind speed are looked for
LOWEST_WIND = 0.25  # of the lowest wind speed asked for: branches are not followed below
HIGHEST_WIND = 1.05  # of the highest: a branch that turns back just beyond it has more cycles there


@dataclass(frozen=True, slots=True)
class CycleProblem(Problem):
    """Harmonic balance of models with the wind speed as parameter, for `engine.numerics.continuation`.

    model: leading axis (members,); member: (branches,); reference: (branches,), smallest size by which the amplitudes
    of each branch are measured, in the root of M_ii |q_i|^2.
    """

    model: ReducedModel
    member: IntArray
    reference: FloatArray

    def orbits(self, z: FloatArray, branch: IntArray) -> Orbits:
        """Return the cycles at points (k, n + 1) of branches (k,)."""
        return orbits_of(z, self.model.mass.shape[-1])

    def repeated(self, branch: IntArray) -> "CycleProblem":
        """Return the problem with these of its branches."""
        return CycleProblem(self.model, self.member[branch], self.reference[branch])

    def models(self, z: FloatArray, branch: IntArray) -> tuple[ReducedModel, IntArray]:
        """Return a stack of models and which of them each of the points (k, n + 1) of branches (k,) has: (k,)."""
        return self.model, self.member[branch]

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the balance and the phase condition <q - q_anchor, dq_anchor/dtau> = 0 with their slopes."""
        member, m = self.member[branch], self.model.mass.shape[-1]
        phase = self.phase(anchor, branch)
        drift = np.einsum("kx,kx->k", phase, z[:, :-2] - anchor[:, :-2])
        rows, slopes = linearized(self.model, member, orbits_of(z, m))
        last = np.concatenate([phase, np.zeros((phase.shape[0], 2))], axis=-1)
        return np.concatenate([rows, drift[:, None]], axis=-1), np.concatenate([slopes, last[:, None]], axis=1)

    def phase(self, anchor: FloatArray, branch: IntArray) -> FloatArray:
        """Return the row of the phase condition by the coefficients."""
        near = orbits_of(anchor, self.model.mass.shape[-1]).coefficients
        weight = np.diagonal(self.model.mass, axis1=-2, axis2=-1)[self.member[branch]][..., None]
        return merged(weight * (near @ basis(near.shape[-1] // 2).derivative.T), -2)

    def corrected(
        self, start: Start, branch: IntArray, condition: tuple[FloatArray, FloatArray], options: Options
    ) -> tuple[Solution, FloatArray]:
        """Solve together with one linear condition more, in compiled code where there is any."""
        if not compiled.AVAILABLE:
            return corrected_by_newton(self, start, branch, condition, options)
        phase = (self.phase(start.anchor, branch), start.anchor)
        return compiled.followed_balances(
            self.model, self.member[branch], phase, condition, (start.guess, start.scale, options)
        )

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Measure each co-ordinate by its own size, or by a share of the whole, frequency and wind by themselves."""
        weight = np.sqrt(np.diagonal(self.model.mass, axis1=-2, axis2=-1))[self.member[branch]]
        coefficients = orbits_of(z, weight.shape[-1]).coefficients
        own = weight * lengths(coefficients)
        whole = np.maximum(lengths(own), self.reference[branch])
        size = np.maximum(own, SMALLEST_SHARE * whole[:, None]) / weight
        return np.concatenate([np.repeat(size, coefficients.shape[-1], axis=-1), np.abs(z[:, -2:])], axis=-1)


@dataclass(frozen=True, slots=True)
class Traces:
    """Branches that were followed.

    problem: with one entry a branch; points: sorted by branch, in the order in which they were met; outcome:
    (branches,) of Outcome, CONVERGED where a branch ended by itself or left the range of wind speeds; returned:
    (branches,), whether it ended in the equilibrium, at another Hopf point; born: (branches,), the wind speed of the
    Hopf point where it started, infinite if it did not start at one [m/s].
    """

    problem: CycleProblem
    points: Points
    outcome: ObjectArray
    returned: BoolArray
    born: FloatArray

    @property
    def orbits(self) -> Orbits:
        """The cycles of the points."""
        return self.problem.orbits(self.points.z, self.points.branch)

    @property
    def last(self) -> IntArray:
        """Index of the last point of each branch."""
        return np.searchsorted(self.points.branch, np.arange(self.problem.member.size), side="right") - 1

    @property
    def member(self) -> IntArray:
        """The model of each point."""
        return self.problem.member[self.points.branch]


def orbits_of(z: FloatArray, m: int) -> Orbits:
    """Read points (k, m (2 H + 1) + 2) as orbits."""
    return Orbits(z[:, :-2].reshape(z.shape[0], m, (z.shape[1] - 2) // m), z[:, -2], z[:, -1])


def points_of(orbits: Orbits) -> FloatArray:
    """Write orbits as points (k, m (2 H + 1) + 2)."""
    tail = np.stack([orbits.angular_frequency, orbits.wind_speed], axis=-1)
    return np.concatenate([merged(orbits.coefficients, -2), tail], axis=-1)


def traced_from_hopf(
    model: ReducedModel, crossings: Crossings, hopf: IntArray, harmonics: int, winds: FloatArray
) -> Traces:
    """Follow the branch that each of some Hopf points gives birth to.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    crossings : Crossings
    hopf : (branches,)
        Indices of crossings that are oscillations.
    harmonics : int
    winds : (winds,)
        In rising order; branches are followed to the highest [m/s].

    Returns
    -------
    Traces
    """
    member, speed = crossings.member[hopf], crossings.wind_speed[hopf]
    shape = critical_modes(model, member, speed)
    first = np.zeros((hopf.size, shape.shape[-1], 2 * harmonics + 1))
    first[..., 1], first[..., 2] = shape.real, -shape.imag
    born = Orbits(first, crossings.angular_frequency[hopf], speed)
    size, angle = whole_size(model, member, first), first_angle(model, member, born)
    reference = size * REFERENCE_ANGLE / np.maximum(angle, 1e-300)
    problem = CycleProblem(model, member, reference)
    start = points_of(Orbits(np.zeros_like(first), born.angular_frequency, speed))
    direction = points_of(Orbits(first, np.zeros(hopf.size), np.zeros(hopf.size)))
    return traced(problem, start, direction, _limits(winds), speed)


def traced_from_cycles(model: ReducedModel, member: IntArray, orbits: Orbits, winds: FloatArray) -> Traces:
    """Follow the branch of each cycle, first all to higher, then all to lower wind speeds: 2 k branches."""
    problem = CycleProblem(model, member, reference_size(model, member, orbits))
    return traced_both_ways(problem, points_of(orbits), _limits(winds))


def reference_size(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the smallest size by which the amplitudes of the branch of each cycle are measured: (k,)."""
    angle = first_angle(model, member, orbits)
    return whole_size(model, member, orbits.coefficients) * REFERENCE_ANGLE / np.maximum(angle, REFERENCE_ANGLE)


def traced_both_ways(problem: CycleProblem, start: FloatArray, limits: tuple[float, float]) -> Traces:
    """Follow branches from points (k, n + 1), first all to higher, then all to lower parameters: 2 k branches.

    The problem has one entry a point.
    """
    both, up = np.tile(np.arange(start.shape[0]), 2), np.repeat([1.0, -1.0], start.shape[0])
    problem, start = problem.repeated(both), start[both]
    along = np.zeros_like(start)
    along[:, -1] = up * problem.scale(start, np.arange(both.size))[:, -1]
    direction = tangents(problem, start, np.arange(both.size), along)
    # At a fold the branch has no direction over the parameter: nothing is followed from there.
    direction = np.where(np.isfinite(direction).all(axis=-1, keepdims=True), direction, along)
    return traced(problem, start, direction, limits, np.full(both.size, np.inf))


def _limits(winds: FloatArray) -> tuple[float, float]:
    return LOWEST_WIND * float(winds[0]), HIGHEST_WIND * float(winds[-1])


def reaches(traces: Traces, crossings: Crossings, hopf: IntArray) -> BoolArray:
    """Tell which branches ended in which Hopf points (k,), whatever their models: (branches, k)."""
    orbits = pick(traces.orbits, traces.last)
    ends = np.stack([orbits.wind_speed, orbits.angular_frequency], axis=-1)
    there = np.stack([crossings.wind_speed[hopf], crossings.angular_frequency[hopf]], axis=-1)
    near = (np.abs(ends[:, None] / there - 1.0) < REACHED).all(axis=-1)
    return np.asarray(near & traces.returned[:, None])


def at_winds(traces: Traces, winds: FloatArray) -> tuple[IntArray, IntArray, Orbits]:
    """Guess the cycles of the branches at wind speeds (winds,) by Hermite's interpolation.

    Returns
    -------
    (guesses,), (guesses,), Orbits
        Branch and index of the wind speed of each guess, and the orbit guessed.
    """
    branch, wind, guess = passed(traces.points, winds)
    return branch, wind, traces.problem.orbits(guess, branch)


def passed(points: Points, winds: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Guess where branches pass wind speeds (winds,), their last unknown: branch, index of the wind speed, point."""
    segment = np.flatnonzero(points.branch[1:] == points.branch[:-1])
    left, right = points.pick(segment), points.pick(segment + 1)
    part = np.linspace(0.0, 1.0, PARTS + 1)
    speed = interpolated(left, right, np.broadcast_to(part, (segment.size, part.size)), LAST)[..., 0]
    above = speed[:, :, None] >= winds
    row, cell, wind = np.nonzero(above[:, 1:] != above[:, :-1])
    share = (cell + (winds[wind] - speed[row, cell]) / (speed[row, cell + 1] - speed[row, cell])) / PARTS
    guess = interpolated(left.pick(row), right.pick(row), share)
    guess[:, -1] = winds[wind]
    return left.branch[row], wind, guess


def traced(
    problem: CycleProblem, start: FloatArray, direction: FloatArray, limits: tuple[float, float], born: FloatArray
) -> Traces:
    """Run the continuation from points (branches, n + 1) and tell it where branches end: at limits of the parameter."""
    before = points_at(problem, np.arange(start.shape[0]), start, direction)
    found, last = [before], before.pick(before.branch)
    steps = branches(problem, start, direction, STEPS)
    ended = np.zeros(start.shape[0], dtype=np.bool_)
    slowest = SLOWEST * lowest_frequency(problem.model)[problem.member]
    alive: BoolArray | None = None
    while True:
        try:
            new = steps.send(alive)
        except StopIteration as stop:
            outcome = stop.value
            break
        returned = _returned(problem, last.pick(new.branch), new)
        ended[new.branch] = returned
        found.append(new.pick(~returned))
        alive = ~returned & _goes_on(problem, new, limits, slowest)
        alive &= ~_closed(problem, before.pick(new.branch), new, len(found))
        last.put(new)
    every = Points(*(np.concatenate([getattr(p, name) for p in found]) for name in ("branch", "z", "scale", "tangent")))
    return Traces(problem, every.pick(np.argsort(every.branch, kind="stable")), outcome, ended, born)


def _returned(problem: CycleProblem, before: Points, new: Points) -> BoolArray:
    """Tell which branches passed through the equilibrium, where the first harmonic turns over."""
    m = problem.model.mass.shape[-1]
    weight = np.diagonal(problem.model.mass, axis1=-2, axis2=-1)[problem.member[new.branch]]
    first, second = (orbits_of(p.z, m).coefficients[..., 1:3] for p in (before, new))
    return np.asarray(np.einsum("kmc,kmc,km->k", first, second, weight) < 0.0)


def _goes_on(problem: CycleProblem, new: Points, limits: tuple[float, float], slowest: FloatArray) -> BoolArray:
    """Tell which branches stay inside the range of the parameter, of angles and of frequencies."""
    member = problem.member[new.branch]
    orbits = problem.orbits(new.z, new.branch)
    rising, value = new.tangent[:, -1] > 0.0, new.z[:, -1]
    inside = (rising | (value > limits[0])) & (~rising | (value < limits[1]))
    quick = orbits.angular_frequency > slowest[new.branch]
    return np.asarray(inside & quick & (first_angle(problem.model, member, orbits) < LARGEST_ANGLE))


def _closed(problem: CycleProblem, start: Points, new: Points, count: int) -> BoolArray:
    """Tell which branches came back to where they started, so that they are closed."""
    if count < 5:
        return np.zeros(new.branch.size, dtype=np.bool_)
    scale = start.scale
    first, second = (_invariant(p.z / scale, problem.model.mass.shape[-1]) for p in (start, new))
    near = lengths(first - second) < STEPS.largest
    along = np.einsum("ki,ki->k", (start.tangent / scale)[:, -2:], (new.tangent / scale)[:, -2:]) > 0.0
    return np.asarray(near & along)


def _invariant(z: FloatArray, m: int) -> FloatArray:
    """Return what of scaled points does not depend on the phase."""
    c = orbits_of(z, m).coefficients
    return np.concatenate([c[..., 0], merged(np.hypot(c[..., 1::2], c[..., 2::2]), -2), z[:, -2:]], axis=-1)
