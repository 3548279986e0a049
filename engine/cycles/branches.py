"""Branches of limit cycles over the wind speed: their starting points, continuation and ends. Theory section 7.2.

A point z of a branch holds the Fourier coefficients of the cycle, its angular frequency and the wind speed.
"""

from dataclasses import replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray
from engine.cycles.branch_ends import Limits, from_start, limits_of, meets_the_wind, passed_equilibrium, stays_in_range
from engine.cycles.branch_set import BranchSet, CycleProblem, points_of
from engine.cycles.floquet import Floquet
from engine.cycles.harmonic_balance import Orbits, first_harmonic_angle, total_size
from engine.cycles.known_cycles import SLOWEST
from engine.cycles.refinement import KnownExponents, judged_points, refined
from engine.models.critical_wind_speeds import Crossings, critical_modes
from engine.models.reduced_model import ReducedModel, lowest_frequency, of_each_member
from engine.numerics.continuation import (
    BranchPoints,
    StepControl,
    concatenated,
    continue_branches,
    interpolate,
    make_points,
    tangents,
)
from engine.outcome import Outcome
from engine.progress import driven

FIRST_STEP = 0.2  # from a cycle; the branch from a Hopf point is a parabola, so nothing keeps the first step short
REFERENCE_ANGLE = 0.05  # rad; the amplitude with this angle of attack is the smallest scale of a branch
REACHED = 0.02  # relative distance in wind speed and frequency at which a branch ends in a Hopf point
CLOSED = 0.7  # scaled distance from its start within which a branch that had left it farther than LEFT is closed
LEFT = 1.0
MOST_CUTS = 3  # times that a branch is followed on after the continuation had left it
LAST = slice(-1, None)
CELLS = 8  # parts of a segment between two points that are searched for a given wind speed
LOWEST_WIND = 0.25  # of the lowest requested wind speed: branches are not followed below it
HIGHEST_WIND = 1.05  # of the highest wind speed: a branch may fold just above it and return


def follow_from_hopf_points(
    model: ReducedModel,
    crossings: Crossings,
    hopf: IntArray,
    harmonics: int,
    winds: FloatArray,
    *,
    into_range: bool = True,
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
    winds : (winds,) or (members, winds)
        Requested wind speeds in rising order [m/s]; branches are followed a little beyond the highest.
    into_range : bool
        Whether those that start beyond that are followed on where they enter it, see `entering` and `followed_into`.
    """
    member, speed = crossings.member[hopf], crossings.wind_speed[hopf]
    shape = critical_modes(model, crossings, hopf)
    first = np.zeros((hopf.size, shape.shape[-1], 2 * harmonics + 1))
    first[..., 1], first[..., 2] = shape.real, -shape.imag
    hopf_wind_speed = Orbits(first, crossings.angular_frequency[hopf], speed)
    size, angle = total_size(model, member, first), first_harmonic_angle(model, member, hopf_wind_speed)
    reference = size * REFERENCE_ANGLE / np.maximum(angle, 1e-300)
    problem = CycleProblem(model, member, reference)
    start = points_of(Orbits(np.zeros_like(first), hopf_wind_speed.angular_frequency, speed))
    direction = points_of(Orbits(first, np.zeros(hopf.size), np.zeros(hopf.size)))
    lowest, highest = wind_limits(problem, winds)
    own_lowest = np.where((speed > highest) & (not into_range), highest, lowest)
    return follow_branches(problem, start, direction, (own_lowest, highest), speed)


def entering(branch_set: BranchSet, winds: FloatArray) -> IntArray:
    """Return the branches from Hopf points beyond the highest wind speed that end where they enter the range: (k,)."""
    highest, last = wind_limits(branch_set.problem, winds)[1], branch_set.last
    inside = branch_set.points.z[last, -1] < highest
    began_beyond = np.isfinite(branch_set.hopf_wind_speed) & (branch_set.hopf_wind_speed > highest)
    return np.flatnonzero(
        began_beyond & inside & (branch_set.outcome == Outcome.CONVERGED) & ~branch_set.ended_at_equilibrium
    )


def followed_into(branch_set: BranchSet, index: IntArray, winds: FloatArray) -> BranchSet:
    """Follow some of the branches on from their last points, within the range of wind speeds."""
    if index.size == 0:
        return branch_set
    first = np.searchsorted(branch_set.points.branch, np.arange(branch_set.problem.member.size))
    origin = branch_set.points.select(first)
    limits = wind_limits(branch_set.problem, winds)
    return _refined_throughout(_followed_on(branch_set, origin, index, limits), origin, limits)


def follow_from_cycles(model: ReducedModel, member: IntArray, orbits: Orbits, winds: FloatArray) -> BranchSet:
    """Follow the branch of each cycle (k,): 2 k branches, k to higher wind speeds, then k to lower ones."""
    problem = CycleProblem(model, member, reference_size(model, member, orbits))
    return follow_both_ways(problem, points_of(orbits), wind_limits(problem, winds))


def reference_size(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the smallest scale of the amplitudes on the branch of each cycle: (k,)."""
    angle = first_harmonic_angle(model, member, orbits)
    return total_size(model, member, orbits.coefficients) * REFERENCE_ANGLE / np.maximum(angle, REFERENCE_ANGLE)


def follow_both_ways(problem: CycleProblem, start: FloatArray, limits: Limits) -> BranchSet:
    """Follow branches from points (k, n + 1), one per entry of the problem: k to higher parameters, then k to lower."""
    both, up = np.tile(np.arange(start.shape[0]), 2), np.repeat([1.0, -1.0], start.shape[0])
    limits = limits_of(limits, both)
    problem, start = problem.repeated(both), start[both]
    along = np.zeros_like(start)
    along[:, -1] = up * problem.scale(start, np.arange(both.size))[:, -1]
    direction = tangents(problem, start, np.arange(both.size), along)
    # Where the tangent is not defined, the direction of the parameter alone serves: the first step then fails.
    direction = np.where(np.isfinite(direction).all(axis=-1, keepdims=True), direction, along)
    return follow_branches(problem, start, direction, limits, np.full(both.size, np.inf))


def wind_limits(problem: CycleProblem, winds: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the wind speeds between which each branch of a problem is followed: (branches,) each [m/s].

    winds: those requested, of all members, (winds,), or of each, (members, winds) [m/s].
    """
    own = of_each_member(problem.model, winds)[problem.member]
    return LOWEST_WIND * own[:, 0], HIGHEST_WIND * own[:, -1]


def ends_at_hopf_points(branch_sets: BranchSet, crossings: Crossings, hopf: IntArray) -> BoolArray:
    """Return which branches ended at which Hopf points (k,): (branches, k); models are not compared."""
    ended = np.flatnonzero(branch_sets.ended_at_equilibrium)
    orbits = branch_sets.problem.orbits(branch_sets.points.z[branch_sets.last[ended]], ended)
    ends, there = (orbits.wind_speed, orbits.angular_frequency), (crossings.wind_speed, crossings.angular_frequency)
    speed, frequency = (
        np.abs(end[:, None] / other[hopf] - 1.0) < REACHED for end, other in zip(ends, there, strict=True)
    )
    reached = np.zeros((branch_sets.problem.member.size, hopf.size), dtype=np.bool_)
    reached[ended] = speed & frequency
    return reached


def guessed_cycles(branch_sets: BranchSet, winds: FloatArray) -> tuple[IntArray, IntArray, Orbits]:
    """Interpolate the cycles of the branches at wind speeds (winds,) or (branches, winds), as initial guesses.

    Returns branch, wind speed index and orbit of each guess: (guesses,), (guesses,), Orbits.
    """
    branch, wind, guess = guessed_points(branch_sets.points, winds)
    return branch, wind, branch_sets.problem.orbits(guess, branch)


def guessed_points(points: BranchPoints, winds: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Interpolate branches where they cross wind speeds, the last unknown: (winds,) or (branches, winds).

    Returns branch, wind speed index and point of each crossing: (k,), (k,), (k, n + 1).
    """
    segment = np.flatnonzero(points.branch[1:] == points.branch[:-1])
    left, right = points.select(segment), points.select(segment + 1)
    part = np.linspace(0.0, 1.0, CELLS + 1)
    speed = interpolate(left, right, np.broadcast_to(part, (segment.size, part.size)), LAST)[..., 0]
    own = winds[left.branch] if winds.ndim > 1 else np.broadcast_to(winds, (segment.size, winds.size))
    above = speed[:, :, None] >= own[:, None]
    row, cell, wind = np.nonzero(above[:, 1:] != above[:, :-1])
    share = (cell + (own[row, wind] - speed[row, cell]) / (speed[row, cell + 1] - speed[row, cell])) / CELLS
    guess = interpolate(left.select(row), right.select(row), share)
    guess[:, -1] = own[row, wind]
    return left.branch[row], wind, guess


def follow_branches(
    problem: CycleProblem,
    start: FloatArray,
    direction: FloatArray,
    limits: Limits,
    hopf_wind_speed: FloatArray,
) -> BranchSet:
    """Follow branches from points (branches, n + 1) until they end or leave the limits of the parameter."""
    origin = make_points(problem, np.arange(start.shape[0]), start, direction)
    points, outcome, ended = _followed(problem, origin, origin, limits)
    points = concatenated([origin, points])
    points = points.select(np.argsort(points.branch, kind="stable"))
    found = BranchSet(problem, points, outcome, ended, hopf_wind_speed, judged_points(problem, points))
    return _refined_throughout(found, origin, limits)


def _refined_throughout(found: BranchSet, origin: BranchPoints, limits: Limits) -> BranchSet:
    """Refine branches, and follow those on that the continuation had left; origin: their first points."""
    exponents: KnownExponents = {}
    for _ in range(MOST_CUTS):
        found, cut = refined(found, exponents)
        if not cut.any():
            break
        found = _followed_on(found, origin, np.flatnonzero(cut), limits)
    return found


def _followed_on(found: BranchSet, origin: BranchPoints, index: IntArray, limits: Limits) -> BranchSet:
    """Follow some of the branches on from their last points; origin: the first points of all branches."""
    own, last = found.problem.repeated(index), found.points.select(found.last[index])
    here, first = (
        make_points(own, np.arange(index.size), part.z, part.tangent) for part in (last, origin.select(index))
    )
    points, outcome, ended = _followed(own, here, first, limits_of(limits, index))
    new = BranchPoints(index[points.branch], points.z, points.scale, points.tangent)
    every, judged = concatenated([found.points, new]), judged_points(found.problem, new)
    order = np.argsort(every.branch, kind="stable")
    floquet_result = Floquet(
        *(
            np.concatenate([getattr(found.floquet, name), getattr(judged, name)])[order]
            for name in ("multipliers", "trivial_error", "stability")
        )
    )
    outcomes, at_equilibrium = found.outcome.copy(), found.ended_at_equilibrium.copy()
    outcomes[index], at_equilibrium[index] = outcome, ended
    return replace(
        found,
        points=every.select(order),
        outcome=outcomes,
        ended_at_equilibrium=at_equilibrium,
        floquet=floquet_result,
    )


def _followed(
    problem: CycleProblem, start: BranchPoints, origin: BranchPoints, limits: Limits
) -> tuple[BranchPoints, ObjectArray, BoolArray]:
    """Follow branches from start points until they end; origin: their first points, at which closed ones end.

    Returns
    -------
    BranchPoints, (branches,), (branches,)
        The points in the order in which they were computed; the outcomes; which branches ended at the equilibrium.
    """
    found, last = [start.select(start.branch[:0])], start.select(start.branch)
    ended, left_start = np.zeros((2, start.branch.size), dtype=np.bool_)
    slowest = SLOWEST * lowest_frequency(problem.model)[problem.member]
    steepest = np.abs(problem.model.load.angle).max(axis=1, initial=0.0)

    def goes_on(new: BranchPoints) -> BoolArray:
        ended_at_equilibrium = passed_equilibrium(problem, last.select(new.branch), new)
        ended[new.branch] = ended_at_equilibrium
        found.append(new.select(~ended_at_equilibrium))
        last.overwrite(new)
        alive = ~ended_at_equilibrium & stays_in_range(problem, new, limits, slowest)
        alive &= meets_the_wind(problem, new, steepest)
        distance, along = from_start(problem, origin.select(new.branch), new, LEFT)
        closed = left_start[new.branch] & along & (distance < CLOSED)
        left_start[new.branch] |= distance > LEFT
        return np.asarray(alive & ~closed)

    moving = start.z[:, :-2].any(axis=-1)
    steps = StepControl(first=np.where(moving, FIRST_STEP, StepControl().largest))
    outcome = driven(continue_branches(problem, start.z, start.tangent, steps), goes_on)
    return concatenated(found), outcome, ended
