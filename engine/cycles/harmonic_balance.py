"""Harmonic balance of the reduced models: periodic solutions with H harmonics. Theory section 7.2.

The coefficients of each coordinate are ordered mean, cos 1, sin 1, ..., cos H, sin H of tau = w t. The forces of wind
and stretching are cubic polynomials of (q, q'/U), so 4 H + 2 samples in time yield their first H harmonics without
aliasing.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes, times_matrix
from engine.kernels import compiled
from engine.models.reduced_model import ReducedModel, force, resultant, resultant_gradient, samples_in_period, take
from engine.numerics.extremes import extremes
from engine.numerics.newton import NewtonOptions, Solution, newton

SETTLED = 1e-2  # m, rad times the tolerance: largest change of a coefficient from twice an unexpanded load's samples
MOST_SAMPLES = 1024
READ_SAMPLES = 208  # least number in a period to read amplitudes from
EXACT = 1e-5  # largest tolerance of solutions that count


@dataclass(frozen=True, slots=True)
class Orbits:
    """Periodic motions of a stack of models.

    coefficients: (cycles, m, 2 H + 1); angular_frequency: (cycles,) [rad/s]; wind_speed: (cycles,) [m/s].
    """

    coefficients: FloatArray
    angular_frequency: FloatArray
    wind_speed: FloatArray


@dataclass(frozen=True, slots=True)
class Basis:
    """Fourier basis on samples of one period.

    values, slopes: (samples, 2 H + 1), the basis functions and their derivatives by tau; projection:
    (2 H + 1, samples), from samples to coefficients; derivative: (2 H + 1, 2 H + 1), from coefficients to those of the
    derivative by tau.
    """

    values: FloatArray
    slopes: FloatArray
    projection: FloatArray
    derivative: FloatArray


@lru_cache
def basis(harmonics: int, samples: int | None = None) -> Basis:
    """Return the Fourier basis of H harmonics, on 4 H + 2 samples unless another number is given."""
    samples = samples or 4 * harmonics + 2
    tau = 2.0 * np.pi * np.arange(samples) / samples
    values = fourier(tau, harmonics)
    derivative = np.zeros((2 * harmonics + 1, 2 * harmonics + 1))
    order = np.arange(1, harmonics + 1)
    derivative[2 * order - 1, 2 * order] = order
    derivative[2 * order, 2 * order - 1] = -order
    weight = np.full(2 * harmonics + 1, 2.0 / samples)
    weight[0] = 1.0 / samples
    return Basis(values, values @ derivative, weight[:, None] * values.T, derivative)


def fourier(tau: FloatArray, harmonics: int) -> FloatArray:
    """Return 1, cos tau, sin tau, ..., cos H tau, sin H tau at phases tau: tau.shape + (2 H + 1,)."""
    angle = tau[..., None] * np.arange(1, harmonics + 1)
    waves = np.stack([np.cos(angle), np.sin(angle)], axis=-1).reshape(*tau.shape, 2 * harmonics)
    return np.concatenate([np.ones((*tau.shape, 1)), waves], axis=-1)


def states(orbits: Orbits, tau: FloatArray) -> FloatArray:
    """Return (q, q'/U) at phases tau (samples,): (cycles, samples, 2 m)."""
    harmonics = orbits.coefficients.shape[-1] // 2
    fourier_basis = basis(harmonics)
    values = fourier(tau, harmonics)
    rate = (orbits.angular_frequency / orbits.wind_speed)[:, None, None]
    q = times_matrix(orbits.coefficients, values.T)
    velocity = rate * times_matrix(orbits.coefficients, (values @ fourier_basis.derivative).T)
    return np.concatenate([q, velocity], axis=1).swapaxes(-1, -2)


def residual(model: ReducedModel, orbits: Orbits) -> FloatArray:
    """Return the residual, the harmonics of M q'' + C q' + K q - U^2 f + g: (cycles, m, 2 H + 1) [N or N m]."""
    fourier_basis = _basis_for(model, orbits)
    load = resultant(model, _sampled(orbits, fourier_basis), orbits.wind_speed)
    square = orbits.wind_speed[:, None, None] ** 2
    return _linear_part(model, orbits, fourier_basis) - square * (fourier_basis.projection @ load).swapaxes(-1, -2)


def jacobian(model: ReducedModel, orbits: Orbits) -> FloatArray:
    """Differentiate the residual by the coefficients and by w: (cycles, m (2 H + 1), m (2 H + 1) + 1).

    The block of a pair of coordinates is linear in M_ij, C_ij, K_ij and the samples of the load's gradient, so all
    blocks come from one product with a constant matrix.
    """
    fourier_basis = _basis_for(model, orbits)
    cycles, m, size = orbits.coefficients.shape
    gradient = resultant_gradient(model, _sampled(orbits, fourier_basis), orbits.wind_speed)
    omega = orbits.angular_frequency[:, None, None]
    speed = orbits.wind_speed[:, None, None]
    samples = np.moveaxis(gradient, 1, -1)
    linear = np.stack([omega**2 * model.mass, omega * model.damping, model.stiffness], axis=-1)
    parts = [linear, -((speed**2)[..., None]) * samples[:, :, :m], -((speed * omega)[..., None]) * samples[:, :, m:]]
    flat = np.concatenate(parts, axis=-1).reshape(cycles * m * m, 3 + 2 * samples.shape[-1])
    blocks = (flat @ _block_basis(size // 2, samples.shape[-1])).reshape(cycles, m, m, size, size)
    by_coefficients = blocks.swapaxes(2, 3).reshape(cycles, m * size, m * size)
    slope = orbits.coefficients @ fourier_basis.derivative.T
    by_omega = 2.0 * omega * model.mass @ (slope @ fourier_basis.derivative.T) + model.damping @ slope
    velocity = (orbits.coefficients @ fourier_basis.slopes.T).swapaxes(-1, -2)[..., None] * speed[..., None]
    by_omega -= (fourier_basis.projection @ (gradient[..., m:] @ velocity)[..., 0]).swapaxes(-1, -2)
    return np.concatenate([by_coefficients, merge_axes(by_omega, -2)[..., None]], axis=-1)


def wind_slopes(model: ReducedModel, orbits: Orbits) -> FloatArray:
    """Differentiate the residual by the wind speed at constant coefficients: (cycles, m, 2 H + 1)."""
    fourier_basis = _basis_for(model, orbits)
    m = model.mass.shape[-1]
    state = _sampled(orbits, fourier_basis)
    speed = orbits.wind_speed[:, None, None]
    by_rate = (resultant_gradient(model, state, orbits.wind_speed)[..., m:] @ state[..., m:, None])[..., 0]
    return np.asarray(
        (fourier_basis.projection @ (speed * by_rate - 2.0 * speed * force(model, state))).swapaxes(-1, -2)
    )


def balance(
    model: ReducedModel, member: IntArray, start: Orbits, options: NewtonOptions | None = None
) -> tuple[Orbits, Solution]:
    """Solve the harmonic balance from many starts side by side.

    The samples of an unexpanded load are doubled until no coefficient moves by more than `SETTLED` tolerances.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (cycles,)
        The model of each start.
    start : Orbits
        Initial guesses; <q - q_start, dq_start/dtau> = 0, weighted with the mass, fixes the phase of each solution.
    options : NewtonOptions, optional

    Returns
    -------
    Orbits
        The solutions, also where Newton's method did not converge.
    Solution
        Outcome and iterations; a start that falls to the equilibrium does not converge.
    """
    options = options or NewtonOptions()
    orbits, solution = _balanced(model, member, start, options)
    moving = np.flatnonzero(solution.converged)
    most = MOST_SAMPLES if options.tolerance <= EXACT else 0  # rough solutions only serve as starts
    while model.unexpanded is not None and moving.size and model.unexpanded.samples < most:
        model = replace(model, unexpanded=replace(model.unexpanded, samples=2 * model.unexpanded.samples))
        finer, again = _balanced(model, member[moving], select(orbits, moving), options)
        change = np.abs(finer.coefficients - orbits.coefficients[moving]).max(axis=(1, 2))
        orbits.coefficients[moving], orbits.angular_frequency[moving] = finer.coefficients, finer.angular_frequency
        solution.converged[moving] = again.converged
        moving = moving[again.converged & (change > SETTLED * options.tolerance)]
    return orbits, solution


def _balanced(model: ReducedModel, member: IntArray, start: Orbits, options: NewtonOptions) -> tuple[Orbits, Solution]:
    """Solve the harmonic balance with a fixed number of samples."""
    _, m, size = start.coefficients.shape
    weight = np.sqrt(model.modal_masses)[member]
    start_coefficients = merge_axes(start.coefficients, -2)
    reference = merge_axes(weight[..., None] ** 2 * (start.coefficients @ basis(size // 2).derivative.T), -2)
    norm = np.sqrt(np.einsum("cms,cm->c", start.coefficients**2, weight**2))
    scale = np.repeat(norm[:, None] / weight, size, axis=-1) / np.sqrt(m * size)
    scale = np.concatenate([scale, start.angular_frequency[:, None] / np.sqrt(m * size)], axis=-1)
    x = np.concatenate([start_coefficients, start.angular_frequency[:, None]], axis=-1)

    def system(x: FloatArray, active: IntArray) -> tuple[FloatArray, FloatArray]:
        here = take(model, member[active])
        orbits = _unpacked(x, m, start.wind_speed[active])
        rows = merge_axes(residual(here, orbits), -2)
        drift = np.einsum("cx,cx->c", reference[active], x[:, :-1] - start_coefficients[active])
        phase = np.concatenate([reference[active], np.zeros((active.size, 1))], axis=-1)
        matrix = np.concatenate([jacobian(here, orbits), phase[:, None]], axis=1)
        return np.concatenate([rows, drift[:, None]], axis=-1), matrix

    if compiled.AVAILABLE:
        solution = compiled.solved_balances(model, member, start.wind_speed, reference, (x, scale, options))
    else:
        solution = newton(system, x, scale, options)
    return _unpacked(solution.x, m, start.wind_speed.copy()), solution


def linearized(model: ReducedModel, member: IntArray, orbits: Orbits) -> tuple[FloatArray, FloatArray]:
    """Return residuals and all their derivatives, for members (cycles,) of a stack of models.

    Returns
    -------
    (cycles, n), (cycles, n, n + 2)
        n = m (2 H + 1); derivatives by the coefficients, by w and by the wind speed.
    """
    if compiled.AVAILABLE:
        return compiled.balance_slopes(
            model, member, (orbits.coefficients, orbits.angular_frequency, orbits.wind_speed)
        )
    here = take(model, member)
    by_wind = merge_axes(wind_slopes(here, orbits), -2)[..., None]
    return merge_axes(residual(here, orbits), -2), np.concatenate([jacobian(here, orbits), by_wind], axis=-1)


def total_size(model: ReducedModel, member: IntArray, coefficients: FloatArray) -> FloatArray:
    """Return the root of sum M_ii |q_i|^2 over coefficients (cycles, m, 2 H + 1), mean included: (cycles,)."""
    weight = model.modal_masses[member]
    return np.asarray(np.sqrt(np.einsum("kmc,km->k", coefficients**2, weight)))


def oscillation_size(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the root of sum M_ii |q_i|^2 over all harmonics but the mean: (cycles,)."""
    weight = model.modal_masses[member]
    return np.asarray(np.sqrt(np.einsum("cms,cm->c", orbits.coefficients[..., 1:] ** 2, weight)))


def first_harmonic_angle(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the largest first-harmonic amplitude of the angle of attack along the span: (k,) [rad]."""
    forms = model.load.angle[member]
    m = orbits.coefficients.shape[1]
    cosine, sine = orbits.coefficients[:, :, 1], orbits.coefficients[:, :, 2]
    rate = (orbits.angular_frequency / orbits.wind_speed)[:, None]
    states = np.stack([np.concatenate([cosine, rate * sine], -1), np.concatenate([sine, -rate * cosine], -1)], axis=-1)
    if m == 0 or forms.shape[1] == 0:
        return np.zeros(member.size)
    return np.asarray(np.sqrt(np.square(forms @ states).sum(axis=-1).max(axis=-1)))


def resized(orbits: Orbits, harmonics: int) -> Orbits:
    """Truncate the coefficients to a number of harmonics, or pad them with zeros."""
    kept = orbits.coefficients[..., : 2 * harmonics + 1]
    padded = np.zeros((*kept.shape[:-1], 2 * harmonics + 1))
    padded[..., : kept.shape[-1]] = kept
    return Orbits(padded, orbits.angular_frequency, orbits.wind_speed)


def select(orbits: Orbits, index: IntArray) -> Orbits:
    """Select or repeat orbits of a stack."""
    return Orbits(orbits.coefficients.take(index, axis=0), orbits.angular_frequency[index], orbits.wind_speed[index])


def half_peak_to_peak(coefficients: FloatArray) -> FloatArray:
    """Return half of the peak-to-peak of Fourier series (..., 2 H + 1): (...).

    The extremes on a grid, the same up to twelve harmonics, however far a stack pads, are refined by a parabola.
    """
    harmonics = coefficients.shape[-1] // 2
    values = times_matrix(coefficients, basis(harmonics, max(READ_SAMPLES, 16 * harmonics + 16)).values.T)
    smallest, largest = extremes(values)
    return np.asarray(0.5 * (largest - smallest))


@lru_cache
def _block_basis(harmonics: int, samples: int) -> FloatArray:
    """Return the flattened Jacobian blocks per unit of w^2 M, w C, K and of each sample of the gradient."""
    fourier_basis = basis(harmonics, samples)
    linear = np.stack(
        [fourier_basis.derivative @ fourier_basis.derivative, fourier_basis.derivative, np.eye(2 * harmonics + 1)]
    )
    by_value = np.einsum("as,sb->sab", fourier_basis.projection, fourier_basis.values)
    by_slope = np.einsum("as,sb->sab", fourier_basis.projection, fourier_basis.slopes)
    return merge_axes(np.concatenate([linear, by_value, by_slope]), -2)


def _basis_for(model: ReducedModel, orbits: Orbits) -> Basis:
    harmonics = orbits.coefficients.shape[-1] // 2
    return basis(harmonics, samples_in_period(model, harmonics))


def _sampled(orbits: Orbits, fourier_basis: Basis) -> FloatArray:
    rate = (orbits.angular_frequency / orbits.wind_speed)[:, None, None]
    q = orbits.coefficients @ fourier_basis.values.T
    return np.concatenate([q, rate * (orbits.coefficients @ fourier_basis.slopes.T)], axis=1).swapaxes(-1, -2)


def _linear_part(model: ReducedModel, orbits: Orbits, fourier_basis: Basis) -> FloatArray:
    omega, q = orbits.angular_frequency[:, None, None], orbits.coefficients
    slope = q @ fourier_basis.derivative.T
    bend = slope @ fourier_basis.derivative.T
    return np.asarray(omega**2 * model.mass @ bend + omega * model.damping @ slope + model.stiffness @ q)


def _unpacked(x: FloatArray, m: int, wind_speed: FloatArray) -> Orbits:
    return Orbits(x[:, :-1].reshape(x.shape[0], m, (x.shape[1] - 1) // m), x[:, -1], wind_speed)
