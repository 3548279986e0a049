"""Measures of confidence in each cycle: residual, truncation, sensitivity to detuning. Theory sections 7.3 to 7.5."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.cycles.harmonic_balance import Orbits, balance, basis, half_peak_to_peak, resized, select
from engine.cycles.search import Cycles
from engine.models.reduced_model import ReducedModel, diagonals, take
from engine.models.stretching import restoring_force, take_stretching
from engine.numerics.newton import NewtonOptions
from engine.outcome import Stability
from engine.spec import Check

DETUNING = 1e-3  # relative shift of the horizontal frequencies, either way
ONE_STEP = NewtonOptions(iterations=1)  # one more harmonic changes little, so one Newton step is enough
HORIZONTAL = 1
COARSE = NewtonOptions(tolerance=1e-3)  # convergence is quadratic: the error is 1e-6 of the amplitude
LINEAR = 1e-2  # change of the amplitude up to which the other shift makes it the same in the other direction
PERIODS = 50  # of direct integration from a cycle


@dataclass(frozen=True, slots=True)
class Confidence:
    """Measures of confidence in a stack of cycles; every array is (cycles,).

    residual: largest residual of the equations relative to the largest elastic force; truncation: relative change of
    the largest amplitude with one more harmonic; detuning: of its relative changes if the horizontal frequencies rise
    or fall by 0.1 %, or fall by as much as stretching raises them, the one of largest size, NaN if one of the shifts
    leaves no such cycle; direct: its relative change in 50 periods of direct integration, NaN if that was not asked for
    or the cycle is unstable.
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
    _, m, size = orbits.coefficients.shape
    elastic = np.abs(model.stiffness[member] @ orbits.coefficients).max(axis=(1, 2))
    with_one_more, step = balance(model, member, resized(orbits, size // 2 + 1), ONE_STEP)
    balances = step.residual[:, : m * (size + 2)].reshape(-1, m, size + 2)  # without the phase condition
    error = np.abs(balances[..., :size]).max(axis=(1, 2))  # the harmonic more is not solved for yet
    every = half_peak_to_peak(orbits.coefficients)
    main = (every * np.sqrt(model.modal_masses)[member]).argmax(axis=-1)
    row = np.arange(member.size)

    def change(coefficients: FloatArray, here: IntArray = row) -> FloatArray:
        changed = half_peak_to_peak(coefficients[np.arange(here.size), main[here]])
        return np.asarray(changed / every[here, main[here]] - 1.0)

    detuning = _largest_change(model, member, orbits, change)
    return np.stack([error / elastic, np.abs(change(with_one_more.coefficients)), detuning])


def _largest_change(
    model: ReducedModel, member: IntArray, orbits: Orbits, change: Callable[[FloatArray, IntArray], FloatArray]
) -> FloatArray:
    """Return the largest of the changes under shifted horizontal frequencies, NaN where one shift leaves no such cycle.

    They rise and fall by DETUNING; where stretching raises them by more over the cycle, they fall by that much, too.
    change: returns the relative change of the amplitudes of coefficients (k, m, 2 H + 1) of some of the cycles (k,).
    """
    # Near a resonance even 0.1 % of detuning is nonlinear, so a single linear step would not be enough.
    higher, first = balance(_detuned(model, DETUNING), member, orbits, COARSE)
    rise = np.where(first.converged, change(higher.coefficients, np.arange(member.size)), np.nan)
    soft = np.flatnonzero(np.abs(rise) > LINEAR)
    lower = 2.0 * orbits.coefficients[soft] - higher.coefficients[soft]
    frequency = 2.0 * orbits.angular_frequency[soft] - higher.angular_frequency[soft]
    start = Orbits(lower, frequency, orbits.wind_speed[soft])
    solved, second = balance(_detuned(model, -DETUNING), member[soft], start, COARSE)
    fall = -rise  # or rounding would decide which of two equal sizes, and so which sign, is the largest
    fall[soft] = np.where(second.converged, change(solved.coefficients, soft), np.nan)
    relaxed = np.zeros(member.size)
    shift = stretching_shift(model, member, orbits)
    far = np.flatnonzero(shift > DETUNING)
    if far.size:
        own = _detuned(take(model, member[far]), -shift[far])
        solved, third = balance(own, np.arange(far.size), select(orbits, far), COARSE)
        relaxed[far] = np.where(third.converged, change(solved.coefficients, far), np.nan)
    changes = np.stack([rise, fall, relaxed])
    # argmax takes NaN for the largest.
    return np.asarray(changes[np.abs(changes).argmax(axis=0), np.arange(member.size)])


def stretching_shift(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return by what share of itself stretching raises the horizontal frequency over each cycle: (cycles,).

    Half of the mean work of stretching on the horizontal coordinates over that of their stiffness, which is exact to
    first order in the stretching.
    """
    stretching = take_stretching(model.stretching, member)
    if stretching is None:
        return np.zeros(member.size)
    harmonics = orbits.coefficients.shape[-1] // 2
    q = (orbits.coefficients @ basis(harmonics).values.T).swapaxes(-1, -2)
    horizontal = model.direction == HORIZONTAL
    work = (restoring_force(stretching, q) * q)[..., horizontal].sum(axis=(1, 2))
    elastic = (diagonals(model.stiffness)[member, None] * q**2)[..., horizontal].sum(axis=(1, 2))
    return np.asarray(0.5 * work / np.where(elastic > 0.0, elastic, np.inf))


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


def _detuned(model: ReducedModel, shift: float | FloatArray) -> ReducedModel:
    """Change the stiffness of the horizontal coordinates so that their frequencies shift by a share of themselves.

    shift: of all members, or (members,).
    """
    factor = np.where(model.direction == HORIZONTAL, 1.0 + np.asarray(shift)[..., None], 1.0)
    return replace(model, stiffness=model.stiffness * factor[..., :, None] * factor[..., None, :])
