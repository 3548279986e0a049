"""Where branches of limit cycles end: at the equilibrium, at their limits, or where they began. Theory section 7.2."""

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, lengths, merge_axes
from engine.cycles.branch_set import CycleProblem, orbits_of
from engine.cycles.harmonic_balance import first_harmonic_angle, select
from engine.numerics.continuation import BranchPoints

LARGEST_ANGLE = 0.5 * np.pi  # rad; an amplitude beyond broadside has no meaning

Limits = tuple[float | FloatArray, float | FloatArray]
"""Lowest and highest value of the parameter, of all branches or (branches,)."""


def limits_of(limits: Limits, branch: IntArray) -> Limits:
    """Return the limits of selected, possibly repeated branches (k,)."""
    low, high = (bound[branch] if isinstance(bound, np.ndarray) else bound for bound in limits)
    return low, high


def passed_equilibrium(problem: CycleProblem, before: BranchPoints, new: BranchPoints) -> BoolArray:
    """Return which branches passed through the equilibrium, where the first harmonic changes its sign."""
    m = problem.model.mass.shape[-1]
    weight = problem.model.modal_masses[problem.member[new.branch]]
    first, second = (orbits_of(p.z, m).coefficients[..., 1:3] for p in (before, new))
    return np.asarray(np.einsum("kmc,kmc,km->k", first, second, weight) < 0.0)


def stays_in_range(problem: CycleProblem, new: BranchPoints, limits: Limits, slowest: FloatArray) -> BoolArray:
    """Return which branches stay within the limits of parameter and frequency."""
    rising, value = new.tangent[:, -1] > 0.0, new.z[:, -1]
    lowest, highest = limits_of(limits, new.branch)
    inside = (rising | (value > lowest)) & (~rising | (value < highest))
    return np.asarray(inside & (problem.orbits(new.z, new.branch).angular_frequency > slowest[new.branch]))


def meets_the_wind(problem: CycleProblem, new: BranchPoints, steepest: FloatArray) -> BoolArray:
    """Return which branches stay within the limit of the angle of attack.

    steepest: (members, 2 m), the largest coefficients of the angle along the span. The sum of what they make of each
    coordinate bounds the angle, so few points need it from the whole span.
    """
    member, orbits = problem.member[new.branch], problem.orbits(new.z, new.branch)
    amplitude = np.hypot(orbits.coefficients[..., 1], orbits.coefficients[..., 2])
    rate = (orbits.angular_frequency / orbits.wind_speed)[:, None]
    bound = (steepest[member] * np.concatenate([amplitude, np.abs(rate) * amplitude], axis=-1)).sum(axis=-1)
    within = bound < LARGEST_ANGLE
    far = np.flatnonzero(~within)
    within[far] = first_harmonic_angle(problem.model, member[far], select(orbits, far)) < LARGEST_ANGLE
    return np.asarray(within)


def from_start(
    problem: CycleProblem, start: BranchPoints, new: BranchPoints, far: float
) -> tuple[FloatArray, BoolArray]:
    """Return the distance of points from the start of their branch, and whether they go on in its direction.

    A distance beyond `far` is only bounded from below, by the difference of the sizes of both points.
    """
    scale = start.scale
    distance = np.abs(lengths(new.z / scale) - lengths(start.z / scale))
    near = np.flatnonzero(~(distance > far))
    first, second = (_phase_invariants(p.z[near] / scale[near], problem.model.mass.shape[-1]) for p in (start, new))
    distance[near] = lengths(first - second)
    along = np.einsum("ki,ki->k", (start.tangent / scale)[:, -2:], (new.tangent / scale)[:, -2:]) > 0.0
    return distance, along


def _phase_invariants(z: FloatArray, m: int) -> FloatArray:
    """Return the quantities of scaled points that do not depend on the phase: means, amplitudes, frequency, wind."""
    c = orbits_of(z, m).coefficients
    return np.concatenate([c[..., 0], merge_axes(np.hypot(c[..., 1::2], c[..., 2::2]), -2), z[:, -2:]], axis=-1)
