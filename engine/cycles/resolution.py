"""How many harmonics cycles need, and their stability with that many. Theory sections 7.2 and 7.3."""

from collections.abc import Sequence

import numpy as np

from engine.arrays import AnyArray, BoolArray, FloatArray, IntArray
from engine.cycles.branch_set import BranchSet
from engine.cycles.floquet import Floquet, floquet
from engine.cycles.harmonic_balance import Orbits, balance, oscillation_size, resized, select
from engine.cycles.refinement import crowded
from engine.models.reduced_model import ReducedModel, diagonals, gradient_at_rest, lowest_frequency

LARGEST_TAIL = 1e-4  # share of the last harmonics, or relative error of the multipliers, above which a cycle is refined
MOST_HARMONICS = 12
COARSE = 1e-3  # share of the last harmonics, and error of the multipliers, above which a branch needs more harmonics
MOST_FOLLOWED = 8  # harmonics of a branch: those beyond the sixth multiple of the lowest frequency are hardly driven
LIGHT = 0.15  # growth rate over the lowest natural frequency, below which a resonance is sharp
SUPERHARMONIC = 1.5  # ratio of a natural frequency to the lowest one, above which a multiple of it can be met
STEP_FACTOR = 4  # on the number of steps of the Floquet integration, for cycles that need more harmonics


def harmonics_needed(model: ReducedModel, wind_speeds: FloatArray, asked: int) -> IntArray:
    """Return the number of harmonics with which the branches of each model are followed: (members,).

    A lightly damped mode resonates with the harmonic that meets its frequency. Where a multiple of the lowest natural
    frequency can meet one at any wind speed up to the highest, two more harmonics than that multiple are kept.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    wind_speeds : (winds,) or (members, winds)
        Of all members or of each, in rising order [m/s].
    asked : int
        The least number.
    """
    m = model.mass.shape[-1]
    slope = gradient_at_rest(model)[..., :m]
    by_wind = wind_speeds[..., -1:] ** 2 * diagonals(slope) / model.modal_masses
    square = np.maximum(model.uncoupled_squares, model.uncoupled_squares - by_wind)
    lowest = lowest_frequency(model)[:, None]
    ratio = np.sqrt(np.maximum(square, 0.0)) / lowest
    light = diagonals(model.damping) / (2.0 * model.modal_masses * lowest) < LIGHT
    order = np.ceil(np.where(light & (ratio > SUPERHARMONIC), ratio, 0.0)).max(axis=-1, initial=0.0)
    # A model without stiffness has no frequencies, and no branches either.
    order = np.where(np.isfinite(order), order, 0.0).astype(np.intp)
    return np.where(order > 0, np.maximum(asked, np.minimum(order + 2, MOST_FOLLOWED)), asked)


def unresolved_members(model: ReducedModel, branch_sets: Sequence[BranchSet]) -> BoolArray:
    """Return which members have points on followed branches whose last harmonics do not fall off: (members,).

    Where multipliers crowd at 1, harmonics matter that are small in the motion: the error of the multipliers tells.
    """
    coarse = np.zeros(model.mass.shape[0], dtype=np.bool_)
    for branch_set in branch_sets:
        judged = branch_set.floquet
        coarse[branch_set.member[crowded(judged) & (judged.trivial_error > LARGEST_TAIL)]] = True
        moving = np.flatnonzero(branch_set.floquet.trivial_error > COARSE)
        member = branch_set.member[moving]
        coarse[member[_tail(model, member, select(branch_set.orbits, moving)) > COARSE]] = True
    return coarse


def resolved_in_groups(
    model: ReducedModel, member: IntArray, orbits: Orbits, harmonics: IntArray
) -> tuple[Orbits, Floquet, BoolArray, IntArray]:
    """Return what `resolved_stability` does, for cycles (k,) with numbers of harmonics of their own, padded."""
    counts = np.unique(harmonics).tolist()
    if len(counts) == 1:
        return resolved_stability(model, member, orbits)
    groups = [np.flatnonzero(harmonics == count) for count in counts]
    parts = [
        resolved_stability(model, member[index], resized(select(orbits, index), count))
        for index, count in zip(groups, counts, strict=True)
    ]
    order = np.argsort(np.concatenate(groups))
    most = max(part[0].coefficients.shape[-1] // 2 for part in parts)
    padded, judged = [resized(part[0], most) for part in parts], [part[1] for part in parts]
    return (
        Orbits(*(_joined(padded, name, order) for name in ("coefficients", "angular_frequency", "wind_speed"))),
        Floquet(*(_joined(judged, name, order) for name in ("multipliers", "trivial_error", "stability"))),
        np.concatenate([part[2] for part in parts])[order],
        np.concatenate([part[3] for part in parts])[order],
    )


def _joined(parts: Sequence[Orbits] | Sequence[Floquet], name: str, order: IntArray) -> AnyArray:
    """Return an array of several stacks in one, in a given order."""
    return np.concatenate([getattr(part, name) for part in parts])[order]


def resolved_stability(
    model: ReducedModel, member: IntArray, orbits: Orbits
) -> tuple[Orbits, Floquet, BoolArray, IntArray]:
    """Compute the stability of cycles (k,), with more harmonics and finer steps where the first ones are too coarse.

    Returns
    -------
    Orbits, Floquet, (k,), (k,)
        The cycles, their stability, which of them are resolved, and the number of harmonics of each.
    """
    floquet_result = floquet(model, member, orbits)
    largest = np.abs(floquet_result.multipliers).max(axis=-1, initial=1.0)
    coarse = np.flatnonzero(
        (_tail(model, member, orbits) > LARGEST_TAIL) | (floquet_result.trivial_error > LARGEST_TAIL * largest)
    )
    resolved = np.ones(member.size, dtype=np.bool_)
    harmonics = np.full(member.size, orbits.coefficients.shape[-1] // 2)
    if coarse.size:
        orbits, floquet_result, resolved[coarse] = _refined(model, member, orbits, floquet_result, coarse)
        harmonics[coarse] = orbits.coefficients.shape[-1] // 2
    return orbits, floquet_result, resolved, harmonics


def _tail(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the share of the last two harmonics in the size of each cycle; 0 for fewer than three harmonics.

    The share is 0 without a motion, and 1 where the size is beyond all numbers, so that it counts as unresolved.
    """
    if orbits.coefficients.shape[-1] // 2 < 3:
        return np.zeros(member.size)
    last = Orbits(orbits.coefficients[..., -5:], orbits.angular_frequency, orbits.wind_speed)
    size = oscillation_size(model, member, orbits)
    known = np.isfinite(size) & (size > 0.0)
    share = np.divide(oscillation_size(model, member, last), size, out=np.ones(size.size), where=known)
    return np.where(size == 0.0, 0.0, share)


def _refined(
    model: ReducedModel, member: IntArray, orbits: Orbits, floquet_result: Floquet, coarse: IntArray
) -> tuple[Orbits, Floquet, BoolArray]:
    """Solve coarse cycles again with more harmonics; return all cycles, their stability and which are now resolved."""
    harmonics = max(MOST_HARMONICS, orbits.coefficients.shape[-1] // 2)
    finer, solution = balance(model, member[coarse], resized(select(orbits, coarse), harmonics))
    finer_result = floquet(model, member[coarse], finer, STEP_FACTOR)
    orbits = resized(orbits, harmonics)
    orbits.coefficients[coarse] = finer.coefficients
    frequency, multipliers = orbits.angular_frequency.copy(), floquet_result.multipliers.copy()
    error, stability = floquet_result.trivial_error.copy(), floquet_result.stability.copy()
    frequency[coarse], multipliers[coarse] = finer.angular_frequency, finer_result.multipliers
    error[coarse], stability[coarse] = finer_result.trivial_error, finer_result.stability
    resolved_again = solution.converged & (_tail(model, member[coarse], finer) <= LARGEST_TAIL)
    return (
        Orbits(orbits.coefficients, frequency, orbits.wind_speed),
        Floquet(multipliers, error, stability),
        resolved_again,
    )
