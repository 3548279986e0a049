"""Stability of quasi-periodic motions from the linearized equations over long times. Theory section 7.3.

Over one period of w, disturbances of a torus are mapped by a matrix that depends on the phase theta_2 alone. This
matrix is computed at some phases and interpolated between them, so the map over thousands of periods is a product of
small matrices. After a number of periods in which theta_2 also returns, the torus is back at its starting point. The
map then decides stability as for a cycle, restricted to the space across the two neutral directions along the torus.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from engine.arrays import ComplexArray, FloatArray, merge_axes
from engine.cycles.floquet import MOST_STEPS, gauss_phases, ordered_product, state_matrix, step_maps, steps_needed
from engine.models.reduced_model import ReducedModel
from engine.outcome import Stability
from engine.tori.two_frequency_balance import Tori, derivative, fourier_basis, harmonic_lattice, states

SAMPLES = 64  # phases theta_2 at which the period map is computed
PERIODS = 50_000  # after which the stability is left unknown
BLOCK = 4096  # periods whose maps are in memory at a time
MARGIN = 3.0  # on the error of the map, for a decision


@dataclass(frozen=True, slots=True)
class TorusStability:
    """Growth of disturbances across a torus after a number of periods.

    largest: modulus of the largest multiplier, NaN if it could not be computed; error: of that modulus; periods: number
    of periods of w; stability: UNKNOWN where the error does not allow a decision.
    """

    largest: float
    error: float
    periods: int
    stability: Stability


def torus_stability(model: ReducedModel, torus: Tori) -> TorusStability:
    """Return the stability of one torus of one model, both with a leading axis of length 1.

    Ever better returns of theta_2 are tried until the largest multiplier differs from 1 by more than its error.
    """
    maps = _period_maps(model, torus)
    if maps is None:
        return TorusStability(np.nan, np.nan, 0, Stability.UNKNOWN)
    weight = np.sqrt(np.tile(model.modal_masses[0], 2))
    series = np.fft.rfft(weight[:, None] * maps / weight, axis=0) / SAMPLES
    turn = float(torus.angular_frequency[0, 1] / torus.angular_frequency[0, 0])
    long_map, done, result = np.eye(weight.size), 0, TorusStability(np.nan, np.nan, 0, Stability.UNKNOWN)
    for periods in _return_periods(turn):
        with np.errstate(over="ignore", invalid="ignore"):
            for first in range(done, periods, BLOCK):
                long_map = _product(series, turn, first, min(first + BLOCK, periods)) @ long_map
        if not np.isfinite(long_map).all():
            break
        done = periods
        result = _verdict_across(torus, weight, long_map, periods)
        if result.stability is not Stability.UNKNOWN:
            break
    return result


def _period_maps(model: ReducedModel, torus: Tori) -> FloatArray | None:
    """Return the maps of (q, dq/dtau) over one period from theta_1 = 0, theta_2 evenly spaced: (samples, 2 m, 2 m)."""
    m = model.mass.shape[-1]
    fast = torus.angular_frequency[:, 0]
    steps = int(steps_needed(np.linalg.inv(model.mass) @ model.stiffness, fast)[0])
    if steps > MOST_STEPS:
        return None
    turn = torus.angular_frequency[0, 1] / fast[0]
    start = 2.0 * np.pi * np.arange(SAMPLES)[:, None] / SAMPLES
    generators = []
    for tau in gauss_phases(steps):
        phases = np.stack(np.broadcast_arrays(tau, start + turn * tau), axis=-1).reshape(-1, 2)
        matrices = state_matrix(model, states(torus, phases), fast, torus.wind_speed)
        generators.append(matrices.reshape(SAMPLES, steps, 2 * m, 2 * m))
    return ordered_product(step_maps(generators[0], generators[1], 2.0 * np.pi / steps))


def _return_periods(turn: float) -> Iterator[int]:
    """Yield numbers of periods after which theta_2 returns ever closer: denominators of the continued fraction."""
    before, here, remainder = 0, 1, abs(turn) % 1.0
    while remainder > 1e-9:
        whole, remainder = divmod(1.0 / remainder, 1.0)
        before, here = here, int(whole) * here + before
        if here > PERIODS:
            return
        yield here


def _product(series: ComplexArray, turn: float, first: int, stop: int) -> FloatArray:
    """Return the product of the interpolated maps of the periods from first to stop."""
    phase = 2.0 * np.pi * turn * np.arange(first, stop)
    order = np.arange(len(series))
    weight = np.where((order == 0) | (order == SAMPLES // 2), 1.0, 2.0)
    rotations = weight * np.exp(1j * phase[:, None] * order)
    size = series.shape[-1]
    maps = (rotations @ merge_axes(series, -2)).real.reshape(-1, size, size)
    whole = np.broadcast_to(np.eye(size), (2 ** int(np.ceil(np.log2(len(maps)))), size, size)).copy()
    whole[: len(maps)] = maps
    return np.asarray(ordered_product(whole[None])[0])


def _verdict_across(torus: Tori, weight: FloatArray, long_map: FloatArray, periods: int) -> TorusStability:
    """Return the stability that the map has in the space across the torus, its neutral directions removed."""
    turn = torus.angular_frequency[0, 1] / torus.angular_frequency[0, 0]
    start, end = (weight[:, None] * _tangents(torus, 2.0 * np.pi * turn * n) for n in (0, periods))
    length = np.linalg.norm(start, axis=0)
    if not length.all():
        return TorusStability(np.nan, np.inf, periods, Stability.UNKNOWN)
    closing = abs(np.angle(np.exp(2j * np.pi * turn * periods)))
    slip = np.linalg.norm(long_map @ start - end, axis=0) / length
    across = np.linalg.qr(start / length, mode="complete")[0][:, 2:]
    values = np.linalg.eigvals(across.T @ long_map @ across)
    error = float(slip.max() + torus.order[1] * closing)
    largest = float(np.abs(values).max(initial=0.0))
    verdict = Stability.UNKNOWN
    if largest > 1.0 + MARGIN * error:
        verdict = Stability.UNSTABLE
    elif largest < 1.0 - MARGIN * error:
        verdict = Stability.STABLE
    return TorusStability(largest, error, periods, verdict)


def _tangents(torus: Tori, phase: float) -> FloatArray:
    """Return the directions along both phases in (q, dq/dtau) at theta_1 = 0 and theta_2 = phase: (2 m, 2)."""
    pairs = harmonic_lattice(torus.order).pairs
    basis = fourier_basis(np.array([0.0, phase]), pairs)
    rate = torus.angular_frequency @ pairs.T / torus.angular_frequency[:, :1]
    columns = []
    for axis in (0, 1):
        along = derivative(torus.coefficients, pairs[None, :, axis].astype(float))
        columns.append(np.concatenate([along[0] @ basis, derivative(along, rate)[0] @ basis]))
    return np.stack(columns, axis=-1)
