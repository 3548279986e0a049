"""Harmonic balance with two base frequencies: quasi-periodic motions of the reduced models. Theory section 7.3.

A motion is q(theta_1, theta_2) with theta_1 = w t and theta_2 = W t: w is the frequency of the cycle that it
bifurcates from, W the slower frequency of its modulation. The coefficients of each coordinate are ordered as mean, then
cos and sin of k_1 theta_1 + k_2 theta_2 for each pair (k_1, k_2) of `harmonic_lattice`. The forces are cubic
polynomials, so a grid of more than four samples per harmonic yields their harmonics without aliasing.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.arrays import ComplexArray, FloatArray, IntArray, merge_axes
from engine.models.reduced_model import ReducedModel, force, resultant, resultant_gradient, take
from engine.numerics.newton import NewtonOptions, Solution, newton

Order = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Tori:
    """Quasi-periodic motions of a stack of models.

    coefficients: (tori, m, 2 n - 1) for n pairs of harmonics; angular_frequency: (tori, 2), w and W [rad/s];
    wind_speed: (tori,) [m/s]; order: the largest |k_1| and |k_2|.
    """

    coefficients: FloatArray
    angular_frequency: FloatArray
    wind_speed: FloatArray
    order: Order

    def select(self, index: IntArray) -> "Tori":
        """Select or repeat tori of the stack."""
        return Tori(self.coefficients[index], self.angular_frequency[index], self.wind_speed[index], self.order)


@dataclass(frozen=True, slots=True)
class HarmonicLattice:
    """Fourier basis of two phases on a grid of samples.

    pairs: (n, 2), the multiples (k_1, k_2), of k and -k only one, (0, 0) first; values: (samples, 2 n - 1), the basis
    at the samples; grid: number of samples over each phase; apart, together: (n, n), indices of the harmonics k - l and
    k + l in the Fourier transform over the grid.
    """

    pairs: IntArray
    values: FloatArray
    grid: Order
    apart: IntArray
    together: IntArray


@lru_cache
def harmonic_lattice(order: Order) -> HarmonicLattice:
    """Return the basis of all harmonics k_1 w + k_2 W with |k_1| and |k_2| up to the order."""
    first, second = order
    both = [(0, k) for k in range(second + 1)]
    pairs = np.array([*both, *((j, k) for j in range(1, first + 1) for k in range(-second, second + 1))])
    grid = (4 * first + 2, 4 * second + 2)
    phases = np.stack(np.meshgrid(*(2.0 * np.pi * np.arange(n) / n for n in grid), indexing="ij"), axis=-1)

    def place(multiples: IntArray) -> IntArray:
        return np.asarray(multiples[..., 0] % grid[0] * grid[1] + multiples[..., 1] % grid[1])

    apart, together = place(pairs[:, None] - pairs), place(pairs[:, None] + pairs)
    return HarmonicLattice(pairs, fourier_basis(phases.reshape(-1, 2), pairs), grid, apart, together)


def fourier_basis(phases: FloatArray, pairs: IntArray) -> FloatArray:
    """Return 1, then cos and sin of each pair (n, 2), at phases (..., 2): (..., 2 n - 1)."""
    angle = phases @ pairs[1:].T
    both = merge_axes(np.stack([np.cos(angle), np.sin(angle)], axis=-1), -2)
    return np.concatenate([np.ones((*angle.shape[:-1], 1)), both], axis=-1)


def phasors(coefficients: FloatArray) -> ComplexArray:
    """Return the phasors a - i b of a cos + b sin for every pair: (..., 2 n - 1) to (..., n)."""
    residual = coefficients[..., 1::2] - 1j * coefficients[..., 2::2]
    return np.concatenate([coefficients[..., :1].astype(np.complex128), residual], axis=-1)


def _real_coefficients(phasor: ComplexArray) -> FloatArray:
    residual = np.stack([phasor[..., 1:].real, -phasor[..., 1:].imag], axis=-1)
    return np.concatenate([phasor[..., :1].real, merge_axes(residual, -2)], axis=-1)


def derivative(coefficients: FloatArray, rate: FloatArray) -> FloatArray:
    """Differentiate in time, each pair's phase advancing at a rate (..., n): (..., m, 2 n - 1)."""
    return _real_coefficients(1j * rate[..., None, :] * phasors(coefficients))


def states(tori: Tori, phases: FloatArray) -> FloatArray:
    """Return (q, q'/U) at phases (samples, 2): (tori, samples, 2 m)."""
    lattice = harmonic_lattice(tori.order)
    basis = fourier_basis(phases, lattice.pairs)
    slope = derivative(tori.coefficients, tori.angular_frequency @ lattice.pairs.T) / tori.wind_speed[:, None, None]
    return np.concatenate([tori.coefficients @ basis.T, slope @ basis.T], axis=1).swapaxes(-1, -2)


def linearized(model: ReducedModel, tori: Tori) -> tuple[FloatArray, FloatArray]:
    """Return the residual of the balance and its derivatives, for a model with leading axis (tori,).

    The residual holds the harmonics of M q'' + C q' + K q - U^2 f + g.

    Returns
    -------
    (tori, N), (tori, N, N + 3)
        N = m (2 n - 1); derivatives by the coefficients, by w, by W and by the wind speed.
    """
    lattice = harmonic_lattice(tori.order)
    m = model.mass.shape[-1]
    speed = tori.wind_speed[:, None, None]
    rate = tori.angular_frequency @ lattice.pairs.T
    slope = derivative(tori.coefficients, rate)
    state = np.concatenate([tori.coefficients, slope / speed], axis=1) @ lattice.values.T
    state = state.swapaxes(-1, -2)
    gradient = resultant_gradient(model, state, tori.wind_speed)
    by_q, by_velocity = gradient[..., :m], gradient[..., m:]
    residual = model.mass @ derivative(slope, rate) + model.damping @ slope + model.stiffness @ tori.coefficients
    residual = residual - speed**2 * _projected(resultant(model, state, tori.wind_speed), lattice)
    columns = [_by_coefficients(model, tori, _spectrum(by_q, lattice), _spectrum(by_velocity, lattice))]
    for axis in (0, 1):
        along = derivative(tori.coefficients, np.broadcast_to(lattice.pairs[:, axis].astype(float), rate.shape))
        linear = 2.0 * model.mass @ derivative(along, rate) + model.damping @ along
        by_frequency = (by_velocity @ (along @ lattice.values.T).swapaxes(-1, -2)[..., None])[..., 0]
        columns.append(merge_axes(linear - speed * _projected(by_frequency, lattice), -2)[..., None])
    by_wind = (by_velocity @ state[..., m:, None])[..., 0]
    columns.append(merge_axes(speed * _projected(by_wind - 2.0 * force(model, state), lattice), -2)[..., None])
    return merge_axes(residual, -2), np.concatenate(columns, axis=-1)


def balance(
    model: ReducedModel, member: IntArray, start: Tori, options: NewtonOptions | None = None
) -> tuple[Tori, Solution]:
    """Solve the two-frequency balance at given wind speeds from many starts side by side.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (tori,)
        The model of each start.
    start : Tori
        Initial guesses; both phases of each solution are those of its start.
    options : NewtonOptions, optional

    Returns
    -------
    Tori
        The solutions, also where Newton's method did not converge.
    Solution
        Outcome and iterations; a start may have converged to a cycle or to the equilibrium.
    """
    m = model.mass.shape[-1]
    start_unknowns = points_of(start)[:, :-1]
    weight = model.modal_masses[member]
    phase = phase_rows(start, weight)
    scale = scales(start, weight)[:, :-1] / np.sqrt(start_unknowns.shape[-1])

    def system(x: FloatArray, active: IntArray) -> tuple[FloatArray, FloatArray]:
        here = np.concatenate([x, start.wind_speed[active, None]], axis=-1)
        residual, slopes = linearized(take(model, member[active]), tori_of(here, m, start.order))
        drift = np.einsum("kpx,kx->kp", phase[active], x - start_unknowns[active])
        matrix = np.concatenate([slopes[..., :-1], phase[active]], axis=1)
        return np.concatenate([residual, drift], axis=-1), matrix

    solution = newton(system, start_unknowns, scale, options)
    points = np.concatenate([solution.x, start.wind_speed[:, None]], axis=-1)
    return tori_of(points, m, start.order), solution


def phase_rows(anchor: Tori, weight: FloatArray) -> FloatArray:
    """Return the phase conditions <dq_anchor/dtheta_p, .> weighted with the mass (tori, m), of unit norm.

    Shape (tori, 2, N + 2).
    """
    pairs = harmonic_lattice(anchor.order).pairs.astype(float)
    count = anchor.wind_speed.size
    rows = [derivative(anchor.coefficients, np.broadcast_to(pairs[:, p], (count, len(pairs)))) for p in (0, 1)]
    flat = merge_axes(np.stack(rows, axis=1) * weight[:, None, :, None], -2)
    flat = flat / np.maximum(np.linalg.norm(flat, axis=-1, keepdims=True), 1e-300)
    return np.concatenate([flat, np.zeros((count, 2, 2))], axis=-1)


def scales(tori: Tori, weight: FloatArray) -> FloatArray:
    """Return the scale of each entry of the points of tori: (tori, N + 3); weight is the mass (tori, m)."""
    size = np.sqrt(np.einsum("tms,tm->t", tori.coefficients**2, weight))
    own = np.repeat((size[:, None] / np.sqrt(weight)), tori.coefficients.shape[-1], axis=-1)
    return np.concatenate([own, np.abs(tori.angular_frequency[:, :1]).repeat(2, -1), tori.wind_speed[:, None]], axis=-1)


def points_of(tori: Tori) -> FloatArray:
    """Convert tori to points (k, m (2 n - 1) + 3): coefficients, w, W and the wind speed."""
    return np.concatenate(
        [merge_axes(tori.coefficients, -2), tori.angular_frequency, tori.wind_speed[:, None]], axis=-1
    )


def tori_of(z: FloatArray, m: int, order: Order) -> Tori:
    """Convert points (k, m (2 n - 1) + 3) to tori."""
    return Tori(z[:, :-3].reshape(z.shape[0], m, (z.shape[1] - 3) // m), z[:, -3:-1], z[:, -1], order)


def stacked(parts: Sequence[Tori]) -> Tori:
    """Concatenate stacks of tori of the same order."""
    names = ("coefficients", "angular_frequency", "wind_speed")
    arrays = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    return Tori(order=parts[0].order, **arrays)


def resized(tori: Tori, order: Order) -> Tori:
    """Truncate the coefficients to another order, or pad them with zeros."""
    old, new = harmonic_lattice(tori.order).pairs, harmonic_lattice(order).pairs
    place = {tuple(pair): i for i, pair in enumerate(old.tolist())}
    before = phasors(tori.coefficients)
    after = np.zeros((*before.shape[:-1], len(new)), dtype=np.complex128)
    for i, pair in enumerate(new.tolist()):
        if tuple(pair) in place:
            after[..., i] = before[..., place[tuple(pair)]]
    return Tori(_real_coefficients(after), tori.angular_frequency, tori.wind_speed, order)


def _spectrum(samples: FloatArray, lattice: HarmonicLattice) -> ComplexArray:
    """Return the Fourier transform of samples (tori, samples, ...) over both phases: (tori, ..., samples)."""
    grid = np.moveaxis(samples, 1, -1).reshape(samples.shape[0], *samples.shape[2:], *lattice.grid)
    result = np.fft.fft2(grid) / (lattice.grid[0] * lattice.grid[1])
    return np.asarray(merge_axes(result, -2))


def _projected(samples: FloatArray, lattice: HarmonicLattice) -> FloatArray:
    """Return the coefficients (tori, m, 2 n - 1) of samples (tori, samples, m)."""
    spectrum = _spectrum(samples, lattice)[..., lattice.together[0]]
    spectrum[..., 1:] *= 2.0
    return _real_coefficients(spectrum)


def _by_coefficients(model: ReducedModel, tori: Tori, by_q: ComplexArray, by_velocity: ComplexArray) -> FloatArray:
    """Return the derivatives of the residual by the coefficients: (tori, N, N).

    Multiplication by a function of spectrum g maps phasors z_l to sum_l g(k - l) z_l + g(k + l) conj z_l, and the mean
    to half of that.
    """
    lattice = harmonic_lattice(tori.order)
    speed = tori.wind_speed[:, None, None, None, None]
    rate = (tori.angular_frequency @ lattice.pairs.T)[:, None, None, None, :]
    straight = -(speed**2) * by_q[..., lattice.apart] - 1j * speed * rate * by_velocity[..., lattice.apart]
    mirrored = -(speed**2) * by_q[..., lattice.together] + 1j * speed * rate * by_velocity[..., lattice.together]
    straight[..., 0, :] *= 0.5
    mirrored[..., 0, :] *= 0.5
    own = rate[..., 0, :]
    linear = -(own**2) * model.mass[..., None] + 1j * own * model.damping[..., None] + model.stiffness[..., None]
    every = np.arange(len(lattice.pairs))
    straight[..., every, every] += linear
    total, residual = straight + mirrored, straight - mirrored
    rows = np.stack([np.stack([total.real, residual.imag], -1), np.stack([-total.imag, residual.real], -1)], axis=-3)
    count, m, n = rows.shape[0], rows.shape[1], len(lattice.pairs)
    kept = np.delete(np.arange(2 * n), 1)  # the mean has no sine
    blocks = rows.reshape(count, m, m, 2 * n, 2 * n)[..., kept[:, None], kept]
    return np.asarray(blocks.swapaxes(2, 3).reshape(count, m * (2 * n - 1), m * (2 * n - 1)))
