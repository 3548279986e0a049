"""Branches of limit cycles over the wind speed: their starting points, continuation and ends. Theory section 7.2.

A point z of a branch holds the Fourier coefficients of the cycle, its angular frequency and the wind speed.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, lengths, merge_axes
from engine.cycles.harmonic_balance import Orbits, basis, first_harmonic_angle, linearized, select, total_size
from engine.kernels import compiled
from engine.models.critical_wind_speeds import Crossings, critical_modes
from engine.models.reduced_model import ReducedModel, lowest_frequency
from engine.numerics.continuation import (
    BranchPoints,
    NewtonStart,
    Problem,
    StepControl,
    continue_branches,
    correct_by_newton,
    interpolate,
    make_points,
    tangents,
)
from engine.numerics.newton import NewtonOptions, Solution
from engine.progress import driven

STEPS = StepControl(first=0.2)
REFERENCE_ANGLE = 0.05  # rad; the amplitude with this angle of attack is the smallest scale of a branch
SMALLEST_SHARE = 0.2  # of the cycle's size: smallest scale of a coordinate that hardly moves
LARGEST_ANGLE = 0.5 * np.pi  # rad; an amplitude beyond broadside has no meaning
SLOWEST = 0.1  # of the lowest natural frequency: a slower solution is really a static one
REACHED = 0.02  # relative distance in wind speed and frequency at which a branch ends in a Hopf point
LAST = slice(-1, None)
CELLS = 8  # parts of a segment between two points that are searched for a given wind speed
LOWEST_WIND = 0.25  # of the lowest wind speed asked for: branches are not followed below it
HIGHEST_WIND = 1.05  # of the highest wind speed: a branch may fold just above it and return


@dataclass(frozen=True, slots=True)
class CycleProblem(Problem):
    """Harmonic balance with the wind speed as parameter, in the form of `engine.numerics.continuation.Problem`.

    model: leading axis (members,); member: (branches,), model of each branch; reference: (branches,), smallest scale of
    the amplitudes on each branch, measured as the root of sum M_ii |q_i|^2.
    """

    model: ReducedModel
    member: IntArray
    reference: FloatArray

    def orbits(self, z: FloatArray, branch: IntArray) -> Orbits:
        """Return the cycles at points (k, n + 1) of branches (k,)."""
        return orbits_of(z, self.model.mass.shape[-1])

    def repeated(self, branch: IntArray) -> "CycleProblem":
        """Return the problem for selected, possibly repeated branches."""
        return CycleProblem(self.model, self.member[branch], self.reference[branch])

    def models(self, z: FloatArray, branch: IntArray) -> tuple[ReducedModel, IntArray]:
        """Return a stack of models and, for points (k, n + 1) of branches (k,), the index of each one's model: (k,)."""
        return self.model, self.member[branch]

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals and slopes of the balance and of the phase condition <q - q_anchor, dq_anchor/dtau> = 0."""
        member, m = self.member[branch], self.model.mass.shape[-1]
        phase = self.phase(anchor, branch)
        drift = np.einsum("kx,kx->k", phase, z[:, :-2] - anchor[:, :-2])
        residuals, slopes = linearized(self.model, member, orbits_of(z, m))
        last = np.concatenate([phase, np.zeros((phase.shape[0], 2))], axis=-1)
        return np.concatenate([residuals, drift[:, None]], axis=-1), np.concatenate([slopes, last[:, None]], axis=1)

    def phase(self, anchor: FloatArray, branch: IntArray) -> FloatArray:
        """Return the derivative of the phase condition by the coefficients: (k, m (2 H + 1))."""
        near = orbits_of(anchor, self.model.mass.shape[-1]).coefficients
        weight = self.model.modal_masses[self.member[branch]][..., None]
        return merge_axes(weight * (near @ basis(near.shape[-1] // 2).derivative.T), -2)

    def correct(
        self, start: NewtonStart, branch: IntArray, condition: tuple[FloatArray, FloatArray], options: NewtonOptions
    ) -> tuple[Solution, FloatArray]:
        """Solve the balance with one additional linear condition, by the compiled kernel where it is available."""
        if not compiled.AVAILABLE:
            return correct_by_newton(self, start, branch, condition, options)
        phase = (self.phase(start.anchor, branch), start.anchor)
        return compiled.followed_balances(
            self.model, self.member[branch], phase, condition, (start.guess, start.scale, options)
        )

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Return the scales of points: each coordinate's size or a share of the cycle's, frequency and wind speed."""
        weight = np.sqrt(self.model.modal_masses)[self.member[branch]]
        coefficients = orbits_of(z, weight.shape[-1]).coefficients
        own = weight * lengths(coefficients)
        whole = np.maximum(lengths(own), self.reference[branch])
        size = np.maximum(own, SMALLEST_SHARE * whole[:, None]) / weight
        return np.concatenate([np.repeat(size, coefficients.shape[-1], axis=-1), np.abs(z[:, -2:])], axis=-1)


@dataclass(frozen=True, slots=True)
class BranchSet:
    """Branches that were followed together.

    problem: with one entry per branch; points: sorted by branch, in the order in which they were computed; outcome:
    (branches,) of Outcome, CONVERGED where a branch ended or left the range of wind speeds; ended_at_equilibrium:
    (branches,), whether it ended at the equilibrium, in another Hopf point; hopf_wind_speed: (branches,), wind speed of
    the Hopf point where it started, infinite if it did not start at one [m/s].
    """

    problem: CycleProblem
    points: BranchPoints
    outcome: ObjectArray
    ended_at_equilibrium: BoolArray
    hopf_wind_speed: FloatArray

    @property
    def orbits(self) -> Orbits:
        """The cycle of each point."""
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
    """Convert points (k, m (2 H + 1) + 2) to orbits."""
    return Orbits(z[:, :-2].reshape(z.shape[0], m, (z.shape[1] - 2) // m), z[:, -2], z[:, -1])


def points_of(orbits: Orbits) -> FloatArray:
    """Convert orbits to points (k, m (2 H + 1) + 2)."""
    tail = np.stack([orbits.angular_frequency, orbits.wind_speed], axis=-1)
    return np.concatenate([merge_axes(orbits.coefficients, -2), tail], axis=-1)


def follow_from_hopf_points(
    model: ReducedModel, crossings: Crossings, hopf: IntArray, harmonics: int, winds: FloatArray
) -> BranchSet:
    """Follow the branches that start at Hopf points.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    crossings : Crossings
        Of these models.
    hopf : (branches,)
        Indices of the crossings that are Hopf points.
    harmonics : int
        H of the balance.
    winds : (winds,)
        Wind speeds asked for in rising order [m/s]; branches are followed a little beyond the highest.
    """
    member, speed = crossings.member[hopf], crossings.wind_speed[hopf]
    shape = critical_modes(model, member, speed)
    first = np.zeros((hopf.size, shape.shape[-1], 2 * harmonics + 1))
    first[..., 1], first[..., 2] = shape.real, -shape.imag
    hopf_wind_speed = Orbits(first, crossings.angular_frequency[hopf], speed)
    size, angle = total_size(model, member, first), first_harmonic_angle(model, member, hopf_wind_speed)
    reference = size * REFERENCE_ANGLE / np.maximum(angle, 1e-300)
    problem = CycleProblem(model, member, reference)
    start = points_of(Orbits(np.zeros_like(first), hopf_wind_speed.angular_frequency, speed))
    direction = points_of(Orbits(first, np.zeros(hopf.size), np.zeros(hopf.size)))
    return follow_branches(problem, start, direction, _wind_limits(winds), speed)


def follow_from_cycles(model: ReducedModel, member: IntArray, orbits: Orbits, winds: FloatArray) -> BranchSet:
    """Follow the branch of each cycle (k,): 2 k branches, k to higher wind speeds, then k to lower ones."""
    problem = CycleProblem(model, member, reference_size(model, member, orbits))
    return follow_both_ways(problem, points_of(orbits), _wind_limits(winds))


def reference_size(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the smallest scale of the amplitudes on the branch of each cycle: (k,)."""
    angle = first_harmonic_angle(model, member, orbits)
    return total_size(model, member, orbits.coefficients) * REFERENCE_ANGLE / np.maximum(angle, REFERENCE_ANGLE)


def follow_both_ways(problem: CycleProblem, start: FloatArray, limits: tuple[float, float]) -> BranchSet:
    """Follow branches from points (k, n + 1), one per entry of the problem: k to higher parameters, then k to lower."""
    both, up = np.tile(np.arange(start.shape[0]), 2), np.repeat([1.0, -1.0], start.shape[0])
    problem, start = problem.repeated(both), start[both]
    along = np.zeros_like(start)
    along[:, -1] = up * problem.scale(start, np.arange(both.size))[:, -1]
    direction = tangents(problem, start, np.arange(both.size), along)
    # Where the tangent is not defined, the direction of the parameter alone serves: the first step then fails.
    direction = np.where(np.isfinite(direction).all(axis=-1, keepdims=True), direction, along)
    return follow_branches(problem, start, direction, limits, np.full(both.size, np.inf))


def _wind_limits(winds: FloatArray) -> tuple[float, float]:
    return LOWEST_WIND * float(winds[0]), HIGHEST_WIND * float(winds[-1])


def ends_at_hopf_points(branch_sets: BranchSet, crossings: Crossings, hopf: IntArray) -> BoolArray:
    """Return which branches ended at which Hopf points (k,): (branches, k); models are not compared."""
    orbits = select(branch_sets.orbits, branch_sets.last)
    ends = np.stack([orbits.wind_speed, orbits.angular_frequency], axis=-1)
    there = np.stack([crossings.wind_speed[hopf], crossings.angular_frequency[hopf]], axis=-1)
    near = (np.abs(ends[:, None] / there - 1.0) < REACHED).all(axis=-1)
    return np.asarray(near & branch_sets.ended_at_equilibrium[:, None])


def guessed_cycles(branch_sets: BranchSet, winds: FloatArray) -> tuple[IntArray, IntArray, Orbits]:
    """Interpolate the cycles of the branches at wind speeds (winds,), as initial guesses.

    Returns branch, wind speed index and orbit of each guess: (guesses,), (guesses,), Orbits.
    """
    branch, wind, guess = guessed_points(branch_sets.points, winds)
    return branch, wind, branch_sets.problem.orbits(guess, branch)


def guessed_points(points: BranchPoints, winds: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Interpolate branches where they cross wind speeds (winds,), the last unknown.

    Returns branch, wind speed index and point of each crossing: (k,), (k,), (k, n + 1).
    """
    segment = np.flatnonzero(points.branch[1:] == points.branch[:-1])
    left, right = points.select(segment), points.select(segment + 1)
    part = np.linspace(0.0, 1.0, CELLS + 1)
    speed = interpolate(left, right, np.broadcast_to(part, (segment.size, part.size)), LAST)[..., 0]
    above = speed[:, :, None] >= winds
    row, cell, wind = np.nonzero(above[:, 1:] != above[:, :-1])
    share = (cell + (winds[wind] - speed[row, cell]) / (speed[row, cell + 1] - speed[row, cell])) / CELLS
    guess = interpolate(left.select(row), right.select(row), share)
    guess[:, -1] = winds[wind]
    return left.branch[row], wind, guess


def follow_branches(
    problem: CycleProblem,
    start: FloatArray,
    direction: FloatArray,
    limits: tuple[float, float],
    hopf_wind_speed: FloatArray,
) -> BranchSet:
    """Follow branches from points (branches, n + 1) until they end or leave the limits of the parameter."""
    before = make_points(problem, np.arange(start.shape[0]), start, direction)
    found, last = [before], before.select(before.branch)
    ended = np.zeros(start.shape[0], dtype=np.bool_)
    slowest = SLOWEST * lowest_frequency(problem.model)[problem.member]

    def goes_on(new: BranchPoints) -> BoolArray:
        ended_at_equilibrium = _passed_equilibrium(problem, last.select(new.branch), new)
        ended[new.branch] = ended_at_equilibrium
        found.append(new.select(~ended_at_equilibrium))
        last.overwrite(new)
        alive = ~ended_at_equilibrium & _stays_in_range(problem, new, limits, slowest)
        return np.asarray(alive & ~_returned_to_start(problem, before.select(new.branch), new, len(found)))

    outcome = driven(continue_branches(problem, start, direction, STEPS), goes_on)
    names = ("branch", "z", "scale", "tangent")
    every = BranchPoints(*(np.concatenate([getattr(p, name) for p in found]) for name in names))
    return BranchSet(problem, every.select(np.argsort(every.branch, kind="stable")), outcome, ended, hopf_wind_speed)


def _passed_equilibrium(problem: CycleProblem, before: BranchPoints, new: BranchPoints) -> BoolArray:
    """Return which branches passed through the equilibrium, where the first harmonic changes its sign."""
    m = problem.model.mass.shape[-1]
    weight = problem.model.modal_masses[problem.member[new.branch]]
    first, second = (orbits_of(p.z, m).coefficients[..., 1:3] for p in (before, new))
    return np.asarray(np.einsum("kmc,kmc,km->k", first, second, weight) < 0.0)


def _stays_in_range(
    problem: CycleProblem, new: BranchPoints, limits: tuple[float, float], slowest: FloatArray
) -> BoolArray:
    """Return which branches stay within the limits of parameter, angle of attack and frequency."""
    member = problem.member[new.branch]
    orbits = problem.orbits(new.z, new.branch)
    rising, value = new.tangent[:, -1] > 0.0, new.z[:, -1]
    inside = (rising | (value > limits[0])) & (~rising | (value < limits[1]))
    quick = orbits.angular_frequency > slowest[new.branch]
    return np.asarray(inside & quick & (first_harmonic_angle(problem.model, member, orbits) < LARGEST_ANGLE))


def _returned_to_start(problem: CycleProblem, start: BranchPoints, new: BranchPoints, count: int) -> BoolArray:
    """Return which branches have returned to their starting point and so are closed."""
    if count < 5:
        return np.zeros(new.branch.size, dtype=np.bool_)
    scale = start.scale
    first, second = (_phase_invariants(p.z / scale, problem.model.mass.shape[-1]) for p in (start, new))
    near = lengths(first - second) < STEPS.largest
    along = np.einsum("ki,ki->k", (start.tangent / scale)[:, -2:], (new.tangent / scale)[:, -2:]) > 0.0
    return np.asarray(near & along)


def _phase_invariants(z: FloatArray, m: int) -> FloatArray:
    """Return the quantities of scaled points that do not depend on the phase: means, amplitudes, frequency, wind."""
    c = orbits_of(z, m).coefficients
    return np.concatenate([c[..., 0], merge_axes(np.hypot(c[..., 1::2], c[..., 2::2]), -2), z[:, -2:]], axis=-1)
