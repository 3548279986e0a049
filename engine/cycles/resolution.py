"""How many harmonics cycles need, and their stability with that many. Theory sections 7.2 and 7.3."""

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.cycles.floquet import Floquet, floquet
from engine.cycles.harmonic_balance import Orbits, balance, oscillation_size, resized, select
from engine.models.reduced_model import ReducedModel

LARGEST_TAIL = 1e-4  # share of the last harmonics, or relative error of the multipliers, above which a cycle is refined
MOST_HARMONICS = 12
STEP_FACTOR = 4  # on the number of steps of the Floquet integration, for cycles that need more harmonics


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
    """Return the share of the last two harmonics in the size of each cycle; 0 for fewer than three harmonics."""
    if orbits.coefficients.shape[-1] // 2 < 3:
        return np.zeros(member.size)
    last = Orbits(orbits.coefficients[..., -5:], orbits.angular_frequency, orbits.wind_speed)
    return oscillation_size(model, member, last) / oscillation_size(model, member, orbits)


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
