"""Explicit first-harmonic limit cycles of the published closure. Theory section 7.1.

The load depends on one scalar alpha' = alpha_0 + R cos(w t) and therefore acts through gains. With these gains the
characteristic polynomial is an affine combination of known polynomials. It has an imaginary pair where its even and its
odd part vanish together. The odd part is quadratic in w^2, which leaves one scalar equation in R; it is solved for all
members side by side.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import AnyArray, BoolArray, ComplexArray, FloatArray, IntArray, merge_axes
from engine.cycles.at_rest import eigenvalues_at_rest
from engine.cycles.harmonic_balance import Orbits, basis, linearized
from engine.kernels import compiled
from engine.models.complex_modes import complex_modes
from engine.models.critical_wind_speeds import at_wind, state_matrices
from engine.models.reduced_model import ReducedModel, diagonals, gradient_at_rest, of_each_member, with_samples
from engine.numerics import polynomial

LARGEST_ANGLE = 0.5 * np.pi  # rad; an amplitude beyond broadside has no meaning
GRID = 40  # amplitudes at which the scalar equation is evaluated
HALVINGS = 14  # of each bracket
SIZE = 2.0  # kg^(1/2) m, the amplitude at which work is looked at: a few centimetres
ORDER = 6  # degree of the characteristic polynomial of three degrees of freedom


@dataclass(frozen=True, slots=True)
class FirstHarmonic:
    """Explicit cycles q = mean + Re(amplitude exp(i w t)) of a stack of models.

    member, wind: (cycles,), indices of the model and of its wind speed; angular_frequency: (cycles,) [rad/s]; angle:
    (cycles,), R [rad]; mean: (cycles, 3); amplitude: (cycles, 3), complex.
    """

    member: IntArray
    wind: IntArray
    angular_frequency: FloatArray
    angle: FloatArray
    mean: FloatArray
    amplitude: ComplexArray


@dataclass(frozen=True, slots=True)
class _ScalarEquation:
    """The scalar equation of each member at each wind speed, both one after another along the first axis.

    The gains act through U^2 B_j; alpha' = r q is a linear form in q and q'. polynomials: (places, 4, 7), coefficients
    in powers of s/scale of det Z and of r adj(Z) U^2 B_j; static: (places, 3), alpha_0 per unit of each mean load;
    scale: (places,) [rad/s].
    """

    polynomials: FloatArray
    static: FloatArray
    scale: FloatArray


def explicit_cycles(model: ReducedModel, wind_speeds: FloatArray) -> FirstHarmonic:
    """Return every first-harmonic cycle of each model.

    Parameters
    ----------
    model : ReducedModel
        Of three degrees of freedom with the published closure, leading axis (members,).
    wind_speeds : (winds,) or (members, winds)
        Of all members or of each [m/s].

    Returns
    -------
    FirstHarmonic
    """
    speeds = of_each_member(model, wind_speeds)
    equation = _scalar_equation(model, speeds)
    angle = np.concatenate([[0.0], np.geomspace(1e-4, LARGEST_ANGLE, GRID - 1)])
    angles = np.broadcast_to(angle, (speeds.size, GRID))
    even, _ = _even_part(equation, np.arange(speeds.size)[:, None], angles)
    known = np.isfinite(even)
    changes = known[:, 1:] & known[:, :-1] & (np.sign(even[:, 1:]) != np.sign(even[:, :-1]))
    place, cell, root = np.nonzero(changes | (known[:, 1:] ^ known[:, :-1]))
    left, right = _cut_to_real_roots(equation, (place, root), (angle[cell], angle[cell + 1]))
    ends = [np.sign(_even_part_at_root(equation, place, root, end)) for end in (left, right)]
    bracket = ends[0] * ends[1] < 0.0
    place, root, sign = place[bracket], root[bracket], ends[0][bracket]
    refined = _bisect(
        lambda middle: np.sign(_even_part_at_root(equation, place, root, middle)) == sign,
        left[bracket],
        right[bracket],
    )
    return _cycles_at_roots(model, speeds, equation, (place, root), 0.5 * (refined[0] + refined[1]))


def _scalar_equation(model: ReducedModel, wind_speeds: FloatArray) -> _ScalarEquation:
    """Interpolate the characteristic polynomials from values on a circle, and solve the statics.

    The structure Z does not know the wind, and r is the sum of a row for q and one for q'/U, eq. (A16).
    """
    m = model.mass.shape[-1]
    columns = np.swapaxes(_load_vectors(model), -1, -2)
    frequency = np.sqrt(np.abs(diagonals(model.stiffness))) / np.sqrt(model.modal_masses)
    scale = np.exp(np.log(frequency).mean(axis=-1))
    points = np.exp(2j * np.pi * np.arange(ORDER + 1) / (ORDER + 1))
    s = _complex(points * scale[:, None])
    dynamic = _dynamic_stiffness(model, np.arange(scale.size)[:, None], s)
    response = np.linalg.solve(dynamic, columns[:, None].astype(np.complex128))
    by_motion, by_velocity = (model.load.forms[:, None, 0, :1, part] @ response for part in (slice(m), slice(m, None)))
    determinant = np.linalg.det(dynamic)[..., None]
    parts = (np.ones((*s.shape, 1)), by_motion[..., 0, :], s[..., None] * by_velocity[..., 0, :])
    values = determinant * np.concatenate(parts, axis=-1)
    coefficients = (np.fft.fft(values, axis=1).real / (ORDER + 1)).swapaxes(-1, -2)[:, None]
    speed = wind_speeds[..., None, None]
    numerators = speed**2 * coefficients[:, :, 1 : 1 + m] + speed * coefficients[:, :, 1 + m :]
    polynomials = np.empty((*wind_speeds.shape, 1 + m, ORDER + 1))
    polynomials[..., :1, :], polynomials[..., 1:, :] = coefficients[:, :, :1], numerators
    at_rest = model.load.forms[:, 0, :1, :m] @ np.linalg.solve(model.stiffness, columns)
    return _ScalarEquation(
        merge_axes(polynomials, -4, -3),
        merge_axes(speed[..., 0] ** 2 * at_rest, -3, -2),
        np.repeat(scale, wind_speeds.shape[-1]),
    )


def _load_vectors(model: ReducedModel) -> FloatArray:
    """Return B_j, the coefficients of the powers of alpha' in the load over U^2: (members, 3, 3), j first."""
    return model.load.table[:, 0].swapaxes(-1, -2)


def _dynamic_stiffness(model: ReducedModel, member: IntArray, s: ComplexArray) -> ComplexArray:
    """Return Z(s) = M s^2 + C s + K of members at points, arrays that broadcast to (...): (..., 3, 3)."""
    laplace = s[..., None, None]
    return np.asarray(model.mass[member] * laplace**2 + model.damping[member] * laplace + model.stiffness[member])


def _mean_angle(static: FloatArray, angle: FloatArray) -> FloatArray:
    """Return the mean angle alpha_0 under an oscillation of amplitude R [rad], by Newton's method from zero."""
    g_1, g_2, g_3 = (static[..., j] for j in range(3))
    half = 0.5 * angle**2
    alpha = np.zeros_like(angle)
    for _ in range(6):
        value = g_1 * alpha + g_2 * (alpha**2 + half) + g_3 * (alpha**3 + 3.0 * alpha * half) - alpha
        slope = g_1 + 2.0 * g_2 * alpha + 3.0 * g_3 * (alpha**2 + half) - 1.0
        step = value / np.where(slope == 0.0, np.inf, slope)
        alpha = alpha - np.minimum(np.maximum(step, -0.5), 0.5)
    return np.asarray(alpha)


def _gains(alpha: FloatArray, angle: FloatArray) -> FloatArray:
    """Return the factors of B_1, B_2, B_3 in the gain N of section 7.1: (..., 3)."""
    return np.stack([np.ones_like(alpha), 2.0 * alpha, 3.0 * alpha**2 + 0.75 * angle**2], axis=-1)


def _even_part(equation: _ScalarEquation, place: IntArray, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the even part at both roots w^2 of the odd part, and these roots (NaN if not positive): (..., 2) each."""
    if compiled.AVAILABLE:
        return compiled.even_part(equation.polynomials, equation.static, place, angle)
    gains = _gains(_mean_angle(equation.static[place], angle), angle)
    factors = np.concatenate([np.ones((*angle.shape, 1)), -gains], axis=-1)
    p = (factors[..., None, :] @ equation.polynomials[place])[..., 0, :]
    discriminant = p[..., 3] ** 2 - 4.0 * p[..., 5] * p[..., 1]
    root = np.sqrt(np.where(discriminant >= 0.0, discriminant, np.nan))
    far = p[..., 3] + np.copysign(root, p[..., 3])
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([2.0 * p[..., 1] / far, far / (2.0 * p[..., 5])], axis=-1)
        square = np.where(both > 0.0, both, np.nan)
        even = p[..., 0, None] - square * (p[..., 2, None] - square * (p[..., 4, None] - square * p[..., 6, None]))
    return even, square


def _even_part_at_root(equation: _ScalarEquation, place: IntArray, root: IntArray, angle: FloatArray) -> FloatArray:
    """Return the even part at the root with index `root` (0 or 1) of the odd part: (brackets,)."""
    return np.asarray(_even_part(equation, place, angle)[0][np.arange(place.size), root])


def _cut_to_real_roots(
    equation: _ScalarEquation, at: tuple[IntArray, IntArray], cells: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Shrink cells to where the root of the odd part is real and positive; a pair of roots may begin inside one."""
    place, root = at
    left, right = (end.copy() for end in cells)
    known = [np.isfinite(_even_part_at_root(equation, place, root, end)) for end in cells]
    cut = np.flatnonzero(known[0] != known[1])
    place, root, from_left = place[cut], root[cut], known[0][cut]
    low, high = _bisect(
        lambda middle: np.isfinite(_even_part_at_root(equation, place, root, middle)) == from_left,
        left[cut],
        right[cut],
    )
    left[cut], right[cut] = np.where(from_left, left[cut], high), np.where(from_left, low, right[cut])
    return left, right


def _bisect(
    like_left: Callable[[FloatArray], BoolArray], left: FloatArray, right: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Bisect brackets; a grid cell is a third of the angle wide, so 14 halvings leave 2e-5 of the angle."""
    for _ in range(HALVINGS):
        middle = 0.5 * (left + right)
        same = like_left(middle)
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    return left, right


def _cycles_at_roots(
    model: ReducedModel,
    wind_speeds: FloatArray,
    equation: _ScalarEquation,
    at: tuple[IntArray, IntArray],
    angle: FloatArray,
) -> FirstHarmonic:
    """Return the cycles of given places and roots of the odd part, `at`, and amplitudes, (cycles,) each."""
    place, root = at
    member, wind = np.divmod(place, max(wind_speeds.shape[-1], 1))
    _, square = _even_part(equation, place, angle)
    frequency = np.sqrt(square[np.arange(place.size), root]) * equation.scale[place]
    alpha = _mean_angle(equation.static[place], angle)
    vectors = wind_speeds.ravel()[place, None, None] ** 2 * _load_vectors(model)[member]
    gain = (_gains(alpha, angle)[:, None] @ vectors)[:, 0]
    dynamic = _dynamic_stiffness(model, member, _complex(1j * frequency))
    amplitude = np.linalg.solve(dynamic, (gain * angle[:, None])[..., None].astype(np.complex128))[..., 0]
    mean_load = np.stack([alpha, alpha**2 + 0.5 * angle**2, alpha**3 + 1.5 * alpha * angle**2], axis=-1)
    mean = np.linalg.solve(model.stiffness[member], (mean_load[:, None] @ vectors)[:, 0, :, None])[..., 0]
    return FirstHarmonic(member, wind, frequency, angle, np.asarray(mean), _complex(amplitude))


def energy_balance_cycles(
    model: ReducedModel, wind_speeds: FloatArray, at_rest: ComplexArray | None = None
) -> FirstHarmonic:
    """Estimate a cycle along every unstable mode of any model by the balance of energy over one period.

    Along q = R Re(v exp(i w t)) the work of the wind minus that of the damping is p_1 R^2 + p_3 R^4 for a cubic load;
    the quadratic terms do no work, nor does stretching, which raises the frequency. The estimate is the R at which the
    work vanishes.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,), any number of degrees of freedom.
    wind_speeds : (winds,) or (members, winds)
        Of all members or of each [m/s].
    at_rest : (members, winds, 2 m), optional
        What `eigenvalues_at_rest` returns, where it is known.

    Returns
    -------
    FirstHarmonic
        With zero mean; `angle` is NaN.
    """
    speeds = of_each_member(model, wind_speeds)
    values = eigenvalues_at_rest(model, speeds) if at_rest is None else at_rest
    size = np.abs(values).max(axis=-1, initial=0.0, keepdims=True)
    member, wind, mode = np.nonzero((values.real > 0.0) & (values.imag > 1e-9 * size))
    value = values[member, wind, mode]
    matrices = at_wind(state_matrices(model), speeds)[member, wind]
    shape = _complex(complex_modes(matrices, value) / np.sqrt(model.modal_masses)[member])
    linear, cubic = _work(model, member, speeds[member, wind], value.imag, shape)
    grows = np.flatnonzero((linear > 0.0) & (cubic < 0.0))
    size = np.sqrt(-linear[grows] / cubic[grows])
    member, wind, amplitude = member[grows], wind[grows], _complex(size[:, None] * shape[grows])
    stiffened = stiffened_frequencies(model, member, value.imag[grows], amplitude)
    return FirstHarmonic(member, wind, stiffened, np.full(grows.size, np.nan), np.zeros(amplitude.shape), amplitude)


def stiffened_frequencies(
    model: ReducedModel, member: IntArray, frequency: FloatArray, amplitude: ComplexArray
) -> FloatArray:
    """Return the frequencies (cycles,) of motions Re(amplitude exp(i w t)) with stretching [rad/s].

    w^2 grows by <g . q> / <q . M q>, Rayleigh's quotient over one period. Only cubic terms of g do work in the mean,
    and three samples of half a period are exact for them. amplitude: (cycles, m).
    """
    if model.stretching is None:
        return frequency
    q = (amplitude[:, None] * np.exp(1j * np.pi * np.arange(3) / 3.0)[:, None]).real
    cubes = slice(-polynomial.count(q.shape[-1], 3), None)
    force = polynomial.powers(q)[..., cubes] @ model.stretching.table[..., cubes][member].swapaxes(-1, -2)
    work, inertia = ((part * q).sum(axis=(-1, -2)) for part in (force, q @ model.mass[member]))
    return np.asarray(np.sqrt(frequency**2 + np.maximum(work / inertia, 0.0)))


def _complex(values: AnyArray) -> ComplexArray:
    return np.asarray(values, dtype=np.complex128)


def _work(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, frequency: FloatArray, shape: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """Return p_1 from the slopes at rest, and p_3 from the work of the residual of the harmonic balance beyond that.

    Inertia and stiffness do no work over a period; ten samples resolve the fourth harmonic.
    """
    rate, speed = _complex(1j * frequency[:, None] * shape), wind_speed[:, None]
    slopes = gradient_at_rest(model)[member] @ np.concatenate([speed**2 * shape, speed * rate], axis=-1)[..., None]
    load = (slopes - model.damping[member] @ rate[..., None])[..., 0]
    linear = 0.5 * (rate.conj() * load).real.sum(axis=-1)
    first = np.stack([np.zeros(shape.shape), shape.real, -shape.imag], axis=-1)
    velocity = frequency[:, None, None] * (first @ basis(1).derivative.T)
    lost, _ = linearized(with_samples(model, 10), member, Orbits(SIZE * first, frequency, wind_speed))
    work = -0.5 * SIZE * (lost.reshape(first.shape) * velocity).sum(axis=(1, 2))
    return linear, (work - SIZE**2 * linear) / SIZE**4
