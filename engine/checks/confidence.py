"""Measures of confidence in each cycle: residual, truncation, sensitivity to detuning. Theory sections 7.3 to 7.5."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.cycles.harmonic_balance import Orbits, balance, half_peak_to_peak, linearized, resized, select
from engine.cycles.search import Cycles
from engine.models.reduced_model import ReducedModel, take
from engine.numerics.newton import NewtonOptions
from engine.outcome import Stability
from engine.spec import Check

DETUNING = 1e-3  # relative shift of the horizontal frequencies, either way
ONE_STEP = NewtonOptions(iterations=1)  # one more harmonic changes little, so one Newton step is enough
HORIZONTAL = 1
COARSE = NewtonOptions(tolerance=1e-3)  # convergence is quadratic: the error is 1e-6 of the amplitude
LINEAR = (
    1e-2  # change of the amplitude up to which the mirror image of one shift stands for the other: its square counts
)
PERIODS = 50  # of direct integration from a cycle


@dataclass(frozen=True, slots=True)
class Confidence:
    """Measures of confidence in a stack of cycles; every array is (cycles,).

    residual: largest residual of the equations relative to the largest elastic force; truncation: relative change of
    the largest amplitude with one more harmonic; detuning: of its relative changes if the horizontal frequencies rise
    and if they fall by 0.1 % the one of larger size, NaN if one of the shifts leaves no such cycle; direct: its
    relative change in 50 periods of direct integration, NaN if that was not asked for or the cycle is unstable.
    """

    residual: FloatArray
    truncation: FloatArray
    detuning: FloatArray
    direct: FloatArray


def confidence(model: ReducedModel, cycles: Cycles, check: Check) -> Confidence:
    """Compute the measures of confidence in the cycles of a stack of models.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    cycles : Cycles
    check : Check
        Whether stable cycles are integrated directly as well.

    Returns
    -------
    Confidence
    """
    member, orbits = cycles.member, cycles.orbits
    direct = np.full(member.size, np.nan)
    if member.size == 0:
        return Confidence(direct, direct, direct, direct)
    parts = np.empty((3, member.size))
    for harmonics in np.unique(cycles.harmonics):
        here = np.flatnonzero(cycles.harmonics == harmonics)
        parts[:, here] = _measures(model, member[here], resized(select(orbits, here), int(harmonics)))
    if check is Check.DIRECT:
        stable = np.flatnonzero(cycles.floquet.stability == Stability.STABLE)
        direct[stable] = integration_drift(model, member[stable], select(orbits, stable))
    return Confidence(parts[0], parts[1], parts[2], direct)


def _measures(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return residual, truncation and detuning of cycles with the same number of harmonics: (3, cycles).

    Truncation and detuning refer to the amplitude of largest M_ii |q_i|^2.
    """
    residual, _ = linearized(model, member, orbits)
    elastic = np.abs(model.stiffness[member] @ orbits.coefficients).max(axis=(1, 2))
    with_one_more, _ = balance(model, member, resized(orbits, orbits.coefficients.shape[-1] // 2 + 1), ONE_STEP)
    before, by_harmonic = (half_peak_to_peak(o.coefficients) for o in (orbits, with_one_more))
    main = (before * np.sqrt(model.modal_masses)[member]).argmax(axis=-1)
    row = np.arange(member.size)
    truncation = np.abs(by_harmonic[row, main] / before[row, main] - 1.0)

    def change(coefficients: FloatArray) -> FloatArray:
        return np.asarray(half_peak_to_peak(coefficients)[row, main] / before[row, main] - 1.0)

    detuning = _largest_change(model, member, orbits, change)
    return np.stack([np.abs(residual).max(axis=-1) / elastic, truncation, detuning])


def _largest_change(
    model: ReducedModel, member: IntArray, orbits: Orbits, change: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Return the larger of the changes under higher and under lower horizontal frequencies, NaN where a cycle is lost.

    change: returns the relative change of the amplitudes of coefficients (cycles, m, 2 H + 1).
    """
    # Near a resonance even 0.1 % of detuning is nonlinear, so a single linear step would not be enough.
    higher, first = balance(_detuned(model, DETUNING), member, orbits, COARSE)
    rise = np.where(first.converged, change(higher.coefficients), np.nan)
    soft = np.flatnonzero(np.abs(rise) > LINEAR)
    lower = 2.0 * orbits.coefficients - higher.coefficients
    frequency = 2.0 * orbits.angular_frequency - higher.angular_frequency
    start = Orbits(lower[soft], frequency[soft], orbits.wind_speed[soft])
    solved, second = balance(_detuned(model, -DETUNING), member[soft], start, COARSE)
    lower[soft] = np.where(second.converged[:, None, None], solved.coefficients, np.nan)
    fall = change(lower)
    # Where one of the two is NaN, the comparison is false and the sum is NaN.
    return np.where(np.abs(rise) >= np.abs(fall), rise, fall + 0.0 * rise)


def integration_drift(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the relative change of each cycle's largest amplitude under direct integration: (cycles,)."""
    return np.array(
        [_amplitude_drift(take(model, int(i)), select(orbits, np.array([at]))) for at, i in enumerate(member)]
    )


def _amplitude_drift(model: ReducedModel, orbit: Orbits) -> float:
    from engine.checks.time_integration import amplitude_after_periods  # noqa: PLC0415 - import scipy's integrators only when asked for

    own = half_peak_to_peak(orbit.coefficients)[0]
    main = int((own * np.sqrt(model.modal_masses)).argmax())
    return float(amplitude_after_periods(model, orbit, PERIODS)[main] / own[main] - 1.0)


def _detuned(model: ReducedModel, shift: float) -> ReducedModel:
    """Change the stiffness of the horizontal coordinates so that their frequencies shift by a share of themselves."""
    factor = np.where(model.direction == HORIZONTAL, 1.0 + shift, 1.0)
    return replace(model, stiffness=model.stiffness * factor[:, None] * factor)
