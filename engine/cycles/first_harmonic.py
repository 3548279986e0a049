"""Explicit first-harmonic limit cycles of the published closure. Theory section 7.1.

The load depends on one scalar alpha' = alpha_0 + R cos(w t) and therefore acts through gains. With these gains the
characteristic polynomial is an affine combination of known polynomials. It has an imaginary pair where its even and its
odd part vanish together. The odd part is quadratic in w^2, which leaves one scalar equation in R; it is solved for all
members side by side.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import AnyArray, BoolArray, ComplexArray, FloatArray, IntArray, eigenvalues
from engine.cycles.harmonic_balance import Orbits, basis, linearized
from engine.kernels import compiled
from engine.models.complex_modes import complex_modes
from engine.models.critical_wind_speeds import at_wind, state_matrices
from engine.models.reduced_model import ReducedModel, diagonals, take, with_samples
from engine.models.stretching import restoring_force

LARGEST_ANGLE = 0.5 * np.pi  # rad; an amplitude beyond broadside has no meaning
GRID = 40  # amplitudes at which the scalar equation is evaluated
HALVINGS = 14  # of each bracket
ORDER = 6  # degree of the characteristic polynomial of three degrees of freedom


@dataclass(frozen=True, slots=True)
class FirstHarmonic:
    """Explicit cycles q = mean + Re(amplitude exp(i w t)) of a stack of models.

    member: (cycles,), index of the model; angular_frequency: (cycles,) [rad/s]; angle: (cycles,), R [rad];
    mean: (cycles, 3); amplitude: (cycles, 3), complex.
    """

    member: IntArray
    angular_frequency: FloatArray
    angle: FloatArray
    mean: FloatArray
    amplitude: ComplexArray


@dataclass(frozen=True, slots=True)
class _ScalarEquation:
    """The scalar equation of each member. The gains act through U^2 B_j; alpha' = r q is a linear form in q and q'.

    polynomials: (members, 4, 7), coefficients in powers of s/scale of det Z and of r adj(Z) U^2 B_j; static:
    (members, 3), alpha_0 per unit of each mean load; scale: (members,) [rad/s].
    """

    polynomials: FloatArray
    static: FloatArray
    scale: FloatArray


def explicit_cycles(model: ReducedModel, wind_speed: FloatArray) -> FirstHarmonic:
    """Return every first-harmonic cycle of each model.

    Parameters
    ----------
    model : ReducedModel
        Of three degrees of freedom with the published closure, leading axis (members,).
    wind_speed : (members,)
        [m/s].

    Returns
    -------
    FirstHarmonic
    """
    equation = _scalar_equation(model, wind_speed)
    angle = np.concatenate([[0.0], np.geomspace(1e-4, LARGEST_ANGLE, GRID - 1)])
    angles = np.broadcast_to(angle, (wind_speed.size, GRID))
    even, _ = _even_part(equation, np.arange(wind_speed.size)[:, None], angles)
    known = np.isfinite(even)
    changes = known[:, 1:] & known[:, :-1] & (np.sign(even[:, 1:]) != np.sign(even[:, :-1]))
    member, cell, root = np.nonzero(changes | (known[:, 1:] ^ known[:, :-1]))
    left, right = _cut_to_real_roots(equation, member, root, angle[cell], angle[cell + 1])
    ends = [np.sign(_even_part_at_root(equation, member, root, end)) for end in (left, right)]
    bracket = ends[0] * ends[1] < 0.0
    member, root, sign = member[bracket], root[bracket], ends[0][bracket]
    refined = _bisect(
        lambda middle: np.sign(_even_part_at_root(equation, member, root, middle)) == sign,
        left[bracket],
        right[bracket],
    )
    return _cycles_at_roots(model, wind_speed, equation, member, root, 0.5 * (refined[0] + refined[1]))


def _scalar_equation(model: ReducedModel, wind_speed: FloatArray) -> _ScalarEquation:
    """Interpolate the characteristic polynomials from values on a circle, and solve the statics."""
    square = wind_speed[:, None] ** 2
    vectors = square[..., None] * model.load.table[:, 0].swapaxes(-1, -2)
    frequency = np.sqrt(np.abs(diagonals(model.stiffness)))
    frequency /= np.sqrt(model.modal_masses)
    scale = np.exp(np.log(frequency).mean(axis=-1))
    points = np.exp(2j * np.pi * np.arange(ORDER + 1) / (ORDER + 1))
    s = points * scale[:, None]
    dynamic = _dynamic_stiffness(model, s)
    angle_rows = _angle_rows(model, wind_speed, s)
    response = np.linalg.solve(dynamic, np.swapaxes(vectors, -1, -2)[:, None].astype(np.complex128))
    determinant = np.linalg.det(dynamic)
    numerators = determinant[..., None] * (angle_rows[..., None, :] @ response)[..., 0, :]
    values = np.concatenate([determinant[..., None], numerators], axis=-1)
    coefficients = np.fft.fft(values, axis=1).real / (ORDER + 1)
    at_rest = np.linalg.solve(model.stiffness, np.swapaxes(vectors, -1, -2))
    form = model.load.forms[:, 0, 0, : model.mass.shape[-1]]
    return _ScalarEquation(coefficients.swapaxes(-1, -2), (form[:, None, :] @ at_rest)[:, 0], scale)


def _dynamic_stiffness(model: ReducedModel, s: ComplexArray) -> ComplexArray:
    """Return Z(s) = M s^2 + C s + K: (members, points, 3, 3)."""
    laplace = s[..., None, None]
    return np.asarray(model.mass[:, None] * laplace**2 + model.damping[:, None] * laplace + model.stiffness[:, None])


def _angle_rows(model: ReducedModel, wind_speed: FloatArray, s: ComplexArray) -> ComplexArray:
    """Return the rows r(s) of alpha' = r(s) q, eq. (A16): (members, points, 3)."""
    m = model.mass.shape[-1]
    form = model.load.forms[:, None, 0, 0]
    return np.asarray(form[..., :m] + form[..., m:] * (s / wind_speed[:, None])[..., None])


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


def _even_part(equation: _ScalarEquation, member: IntArray, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the even part at both roots w^2 of the odd part, and these roots (NaN if not positive): (..., 2) each."""
    if compiled.AVAILABLE:
        return compiled.even_part(equation.polynomials, equation.static, member, angle)
    gains = _gains(_mean_angle(equation.static[member], angle), angle)
    factors = np.concatenate([np.ones((*angle.shape, 1)), -gains], axis=-1)
    p = (factors[..., None, :] @ equation.polynomials[member])[..., 0, :]
    discriminant = p[..., 3] ** 2 - 4.0 * p[..., 5] * p[..., 1]
    root = np.sqrt(np.where(discriminant >= 0.0, discriminant, np.nan))
    far = p[..., 3] + np.copysign(root, p[..., 3])
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([2.0 * p[..., 1] / far, far / (2.0 * p[..., 5])], axis=-1)
        square = np.where(both > 0.0, both, np.nan)
        even = p[..., 0, None] - square * (p[..., 2, None] - square * (p[..., 4, None] - square * p[..., 6, None]))
    return even, square


def _even_part_at_root(equation: _ScalarEquation, member: IntArray, root: IntArray, angle: FloatArray) -> FloatArray:
    """Return the even part at the root with index `root` (0 or 1) of the odd part: (brackets,)."""
    return np.asarray(_even_part(equation, member, angle)[0][np.arange(member.size), root])


def _cut_to_real_roots(
    equation: _ScalarEquation, member: IntArray, root: IntArray, left: FloatArray, right: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Shrink each cell to where the root of the odd part is real and positive; a pair of roots may begin inside it."""
    known = [np.isfinite(_even_part_at_root(equation, member, root, end)) for end in (left, right)]
    low, high = _bisect(
        lambda middle: np.isfinite(_even_part_at_root(equation, member, root, middle)) == known[0],
        left.copy(),
        right.copy(),
    )
    return np.where(known[0], left, high), np.where(known[1], right, low)


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
    wind_speed: FloatArray,
    equation: _ScalarEquation,
    member: IntArray,
    root: IntArray,
    angle: FloatArray,
) -> FirstHarmonic:
    _, square = _even_part(equation, member, angle)
    frequency = np.sqrt(square[np.arange(member.size), root]) * equation.scale[member]
    alpha = _mean_angle(equation.static[member], angle)
    vectors = wind_speed[member, None, None] ** 2 * model.load.table[member, 0].swapaxes(-1, -2)
    gain = (_gains(alpha, angle)[:, None] @ vectors)[:, 0]
    dynamic = _dynamic_stiffness(take(model, member), _complex(1j * frequency[:, None]))[:, 0]
    amplitude = np.linalg.solve(dynamic, (gain * angle[:, None])[..., None].astype(np.complex128))[..., 0]
    mean_load = np.stack([alpha, alpha**2 + 0.5 * angle**2, alpha**3 + 1.5 * alpha * angle**2], axis=-1)
    mean = np.linalg.solve(model.stiffness[member], (mean_load[:, None] @ vectors)[:, 0, :, None])[..., 0]
    return FirstHarmonic(member, frequency, angle, mean, _complex(amplitude))


def energy_balance_cycles(model: ReducedModel, wind_speed: FloatArray) -> FirstHarmonic:
    """Estimate a cycle along every unstable mode of any model by the balance of energy over one period.

    Along q = R Re(v exp(i w t)) the work of the wind minus that of the damping is p_1 R^2 + p_3 R^4 for a cubic load;
    the quadratic terms do no work, nor does stretching, which raises the frequency. The estimate is the R at which the
    work vanishes.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,), any number of degrees of freedom.
    wind_speed : (members,)
        [m/s].

    Returns
    -------
    FirstHarmonic
        With zero mean; `angle` is NaN.
    """
    matrices = at_wind(state_matrices(model), wind_speed)
    values = eigenvalues(matrices)
    member, mode = np.nonzero(
        (values.real > 0.0) & (values.imag > 1e-9 * np.abs(values).max(axis=-1, initial=0.0)[:, None])
    )
    m = model.mass.shape[-1]
    weight = 1.0 / np.sqrt(model.modal_masses)[member]
    frequency = values.imag[member, mode]
    shape = _complex(complex_modes(matrices[member], values[member, mode]) * weight)
    linear, cubic = _work(model, member, wind_speed[member], frequency, shape)
    grows = (linear > 0.0) & (cubic < 0.0)
    size = np.sqrt(np.where(grows, -linear / np.where(grows, cubic, 1.0), np.nan))
    growing = np.flatnonzero(grows)
    amplitude = _complex(size[growing, None] * shape[growing])
    none = np.full(growing.size, np.nan)
    stiffened = stiffened_frequencies(model, member[growing], frequency[growing], amplitude)
    return FirstHarmonic(member[growing], stiffened, none, np.zeros((growing.size, m)), amplitude)


def stiffened_frequencies(
    model: ReducedModel, member: IntArray, frequency: FloatArray, amplitude: ComplexArray
) -> FloatArray:
    """Return the frequencies (cycles,) of motions Re(amplitude exp(i w t)) with stretching [rad/s].

    w^2 grows by <g . q> / <q . M q>, Rayleigh's quotient over one period; ten samples resolve the fourth harmonic.
    amplitude: (cycles, m).
    """
    if model.stretching is None:
        return frequency
    here = take(model, member)
    assert here.stretching is not None
    q = (amplitude[:, None] * np.exp(2j * np.pi * np.arange(10) / 10.0)[:, None]).real
    work = (restoring_force(here.stretching, q) * q).sum(axis=(-1, -2))
    inertia = ((q @ here.mass) * q).sum(axis=(-1, -2))
    return np.asarray(np.sqrt(frequency**2 + np.maximum(work / inertia, 0.0)))


def _complex(values: AnyArray) -> ComplexArray:
    return np.asarray(values, dtype=np.complex128)


def _work(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, frequency: FloatArray, shape: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """Return p_1 and p_3 from the work at two amplitudes, that of the residual of the harmonic balance at the velocity.

    Inertia and stiffness do no work over a period; ten samples resolve the fourth harmonic.
    """
    first = np.stack([np.zeros(shape.shape), shape.real, -shape.imag], axis=-1)
    velocity = frequency[:, None, None] * (first @ basis(1).derivative.T)
    sampled, work = with_samples(model, 10), []
    for size in (1.0, 2.0):
        lost, _ = linearized(sampled, member, Orbits(size * first, frequency, wind_speed))
        work.append(-0.5 * size * (lost.reshape(first.shape) * velocity).sum(axis=(1, 2)))
    cubic = (work[1] - 4.0 * work[0]) / 12.0
    return work[0] - cubic, cubic
