"""Stability of the static state over the wind speed, and all critical wind speeds. Theory section 6."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from engine.kernels.eigenvalues import eigenvalues
from engine.models.complex_modes import complex_modes, followed_eigenvalues
from engine.models.reduced_model import ReducedModel, gradient_at_rest

NEARLY_IMAGINARY = (
    1e-6  # largest ratio of real to imaginary part of a pair that the eigenproblem in U finds on the axis
)


@dataclass(frozen=True, slots=True)
class StateMatrices:
    """A(U) = A_0 + U A_1 + U^2 A_2 of y' = A y, y = (q, q'), in coordinates of unit mass.

    constant, linear, quadratic: (members, 2 m, 2 m).
    """

    constant: FloatArray
    linear: FloatArray
    quadratic: FloatArray


@dataclass(frozen=True, slots=True)
class Crossings:
    """Crossings of the imaginary axis, sorted by member and wind speed; every array is (crossings,).

    member: index of the model; wind_speed [m/s]; angular_frequency [rad/s], 0 for a divergence; onset: whether the
    growth rate rises through zero; oscillation: True for a Hopf point, False for a divergence; coordinate: the one of
    largest M_ii |x_i|^2; unstable_after: number of unstable pairs just above (a real eigenvalue counts as one).
    """

    member: IntArray
    wind_speed: FloatArray
    angular_frequency: FloatArray
    onset: BoolArray
    oscillation: BoolArray
    coordinate: IntArray
    unstable_after: IntArray


def no_crossings() -> Crossings:
    """Return no crossings."""
    none, flags = np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.bool_)
    return Crossings(none, np.zeros(0), np.zeros(0), flags, flags, none, none)


def state_matrices(model: ReducedModel) -> StateMatrices:
    """Linearize the equations of motion about the static state.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).

    Returns
    -------
    StateMatrices
    """
    m = model.mass.shape[-1]
    members = model.mass.shape[0]
    gradient = gradient_at_rest(model)
    scale = np.sqrt(model.modal_masses)
    unit = scale[:, :, None] * np.linalg.inv(model.mass)

    def block(matrix: FloatArray) -> FloatArray:
        return np.asarray(unit @ matrix / scale[:, None, :])

    constant, linear, quadratic = np.zeros((3, members, 2 * m, 2 * m))
    constant[:, :m, m:] = np.eye(m)
    constant[:, m:, :m] = -block(model.stiffness)
    constant[:, m:, m:] = -block(model.damping)
    linear[:, m:, m:] = block(gradient[..., m:])
    quadratic[:, m:, :m] = block(gradient[..., :m])
    return StateMatrices(constant, linear, quadratic)


def at_wind(matrices: StateMatrices, wind_speed: FloatArray) -> FloatArray:
    """Evaluate A(U): (members, ..., 2 m, 2 m) at wind speeds (members, ...)."""
    extra = (1,) * (wind_speed.ndim - 1)
    speed = wind_speed[..., None, None]

    def spread(matrix: FloatArray) -> FloatArray:
        return matrix.reshape(matrix.shape[0], *extra, *matrix.shape[1:])

    return np.asarray(
        spread(matrices.constant) + speed * spread(matrices.linear) + speed**2 * spread(matrices.quadratic)
    )


def critical_wind_speeds(model: ReducedModel, limit: float) -> Crossings:
    """Return every crossing of the imaginary axis by an eigenvalue at wind speeds up to a limit.

    A pair is imaginary only where two eigenvalues sum to zero, that is, where the bialternate sum 2 A(U) * I is
    singular. It is quadratic in U, so all crossings are eigenvalues of one linear problem and none is missed.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,); statically unstable members have no crossings.
    limit : float
        Largest wind speed [m/s].

    Returns
    -------
    Crossings
    """
    matrices = state_matrices(model)
    usable = np.flatnonzero(~model.statically_unstable)
    oscillating = _oscillations(_select(matrices, usable), limit)
    diverging = _divergences(model, usable, limit)
    member = np.concatenate([usable[oscillating[0]], diverging[0]])
    speed = np.concatenate([oscillating[1], diverging[1]])
    frequency = np.concatenate([oscillating[2], np.zeros(diverging[0].size)])
    order = np.lexsort((speed, member))
    member, speed, frequency = member[order], speed[order], frequency[order]
    return _classified(_select(matrices, member), member, speed, frequency, limit)


def critical_modes(model: ReducedModel, crossings: Crossings, index: IntArray) -> ComplexArray:
    """Return the modes of some of the Hopf points (k,): (k, m), not normalized; the largest coordinate is real."""
    matrices, speed, value = _at_hopf_points(model, crossings, index)
    mode = complex_modes(at_wind(matrices, speed), value)
    largest = np.take_along_axis(mode, np.abs(mode).argmax(axis=-1)[:, None], axis=-1)
    return np.asarray(mode * largest.conj() / np.sqrt(model.modal_masses)[crossings.member[index]])


def crossing_error(model: ReducedModel, crossings: Crossings, index: IntArray) -> FloatArray:
    """Return the size of one more Newton step on the growth rate at some of the Hopf points (k,): (k,) [m/s]."""
    value, slope = _followed(*_at_hopf_points(model, crossings, index))
    return np.asarray(np.abs(value.real / slope.real))


def _at_hopf_points(
    model: ReducedModel, crossings: Crossings, index: IntArray
) -> tuple[StateMatrices, FloatArray, ComplexArray]:
    """Return state matrices, wind speeds and imaginary eigenvalues of some of the Hopf points: (k, ...) each."""
    matrices = _select(state_matrices(model), crossings.member[index])
    return matrices, crossings.wind_speed[index], _imaginary(crossings.angular_frequency[index])


def _imaginary(angular_frequency: FloatArray) -> ComplexArray:
    return np.asarray(1j * angular_frequency, dtype=np.complex128)


def unstable_pairs(values: ComplexArray) -> IntArray:
    """Return the number of unstable pairs of eigenvalues (..., n), a real one counting as a pair: (...)."""
    size = np.abs(values).max(axis=-1, keepdims=True)
    unstable = (values.real > 1e-12 * size) & (values.imag >= 0.0)
    return np.asarray(unstable.sum(axis=-1))


def bialternate_sum(matrix: FloatArray) -> FloatArray:
    """Return the bialternate sum 2 A * I of (..., n, n): (..., n(n-1)/2, n(n-1)/2), eigenvalues lambda_i + lambda_j."""
    n = matrix.shape[-1]
    _, column = np.tril_indices(n, -1)
    place, sign = _shared_indices(n)
    total = np.take(matrix.reshape(*matrix.shape[:-2], n * n), place, axis=-1) * sign
    total[..., np.arange(column.size), np.arange(column.size)] += matrix[..., column, column]
    return np.asarray(total)


@lru_cache
def _shared_indices(n: int) -> tuple[IntArray, FloatArray]:
    """Return which entry of A, and with which sign, couples two pairs i > j and k > m that share an index.

    Shape (pairs, pairs) each. Equal pairs share both of theirs; the entry is then that of the first.
    """
    k, m = np.tril_indices(n, -1)
    i, j = k[:, None], m[:, None]
    shared = [j == m, i == k, j == k, i == m]
    place = np.select(shared, [i * n + k, j * n + m, i * n + m, j * n + k])
    return place, np.select(shared, [1.0, 1.0, -1.0, -1.0])


def _select(matrices: StateMatrices, members: IntArray) -> StateMatrices:
    return StateMatrices(matrices.constant[members], matrices.linear[members], matrices.quadratic[members])


def _oscillations(matrices: StateMatrices, limit: float) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return members, wind speeds and frequencies of imaginary pairs, refined by Newton's method on the growth rate."""
    member, speed = _singular_speeds(matrices, limit)
    value = _nearest_pairs(at_wind(_select(matrices, member), speed))
    # Two real eigenvalues of opposite sign also sum to zero; such a speed has no imaginary pair, unless by chance.
    imaginary = np.abs(value.real) < NEARLY_IMAGINARY * np.abs(value.imag)
    member, speed, value = member[imaginary], speed[imaginary], value[imaginary]
    here = _select(matrices, member)
    for _ in range(2):
        value, slope = _followed(here, speed, value)
        step = -value.real / np.where(slope.real == 0.0, np.inf, slope.real)
        speed, value = speed + step, value + slope * step
    valid = (speed > 0.0) & (speed <= limit) & _distinct(member, speed)
    return member[valid], speed[valid], value.imag[valid]


def _distinct(member: IntArray, speed: FloatArray) -> BoolArray:
    """Return which crossings do not repeat an earlier one of the same member: (crossings,)."""
    order = np.lexsort((speed, member))
    new = np.ones(member.size, dtype=np.bool_)
    same = (np.diff(member[order]) == 0) & (np.abs(np.diff(speed[order])) <= 1e-9 * speed[order][1:])
    new[order[1:][same]] = False
    return new


def _singular_speeds(matrices: StateMatrices, limit: float) -> tuple[IntArray, FloatArray]:
    """Solve (B_0 + U B_1 + U^2 B_2) v = 0 for real U in (0, limit] as an eigenproblem in limit/U.

    Its unknowns are v limit/U where the wind has a column at all, and v where B_2 has one, which few coordinates have.
    """
    b_0, b_1, b_2 = (bialternate_sum(a) for a in (matrices.constant, matrices.linear, matrices.quadratic))
    by_square = b_2.any(axis=(0, 1))
    twice, windy = np.flatnonzero(by_square), np.flatnonzero(by_square | b_1.any(axis=(0, 1)))
    count, size = twice.size, twice.size + windy.size
    problem = np.zeros((b_0.shape[0], size, size))
    problem[:, np.arange(count), count + np.searchsorted(windy, twice)] = 1.0
    wind = np.concatenate([b_2[..., twice] * limit**2, b_1[..., windy] * limit], axis=-1)
    problem[:, count:] = -np.linalg.solve(b_0, wind)[:, windy]
    inverse = eigenvalues(problem) if problem.size else np.zeros((0, size), dtype=np.complex128)
    real = (np.abs(inverse.imag) < 1e-6 * np.abs(inverse)) & (inverse.real > 1.0 - 1e-9)
    member, column = np.nonzero(real)
    return member, limit / inverse.real[member, column]


def _nearest_pairs(matrices: FloatArray) -> ComplexArray:
    """Return of each matrix (k, n, n) the eigenvalue above the real axis that is nearest to the imaginary one: (k,)."""
    values = eigenvalues(matrices)
    size = np.abs(values).max(axis=-1, keepdims=True, initial=0.0)
    nearest = np.where(values.imag > 1e-9 * size, np.abs(values.real), np.inf).argmin(axis=-1)
    return np.asarray(values[np.arange(nearest.size), nearest])


def _followed(matrices: StateMatrices, speed: FloatArray, guess: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return the eigenvalues next to guesses at wind speeds (k,), and their derivatives by the wind speed, (k,)."""
    slopes = matrices.linear + 2.0 * speed[:, None, None] * matrices.quadratic
    return followed_eigenvalues(at_wind(matrices, speed), slopes, guess)


def _divergences(model: ReducedModel, usable: IntArray, limit: float) -> tuple[IntArray, FloatArray]:
    """Return members and wind speeds where K - U^2 K_1 is singular."""
    m = model.mass.shape[-1]
    gradient = gradient_at_rest(model)[usable, :, :m]
    if usable.size == 0:
        return usable, np.zeros(0)
    inverse = eigenvalues(np.asarray(np.linalg.solve(model.stiffness[usable], gradient), dtype=np.float64))
    real = (np.abs(inverse.imag) < 1e-9 * np.abs(inverse)) & (inverse.real > limit**-2)
    member, column = np.nonzero(real)
    return usable[member], 1.0 / np.sqrt(inverse.real[member, column])


def _classified(
    matrices: StateMatrices,
    member: IntArray,
    speed: FloatArray,
    frequency: FloatArray,
    limit: float,
) -> Crossings:
    """Return crossings with direction, dominant coordinate and number of unstable pairs above each.

    frequency: (crossings,), 0 for a divergence [rad/s].
    """
    same = member[1:] == member[:-1]
    following = np.where(np.append(same, False), np.append(speed[1:], limit), np.maximum(limit, speed * (1.0 + 1e-6)))
    preceding = np.where(np.append(False, same), np.append(0.0, speed[:-1]), 0.0)[: speed.size]
    after = unstable_pairs(eigenvalues(at_wind(matrices, 0.5 * (speed + following[: speed.size]))))
    swinging, still = np.flatnonzero(frequency > 0.0), np.flatnonzero(frequency == 0.0)
    here, turning = _select(matrices, swinging), _select(matrices, still)
    onset, shape = np.zeros(speed.size, dtype=np.bool_), np.zeros((speed.size, matrices.constant.shape[-1] // 2))
    value = _imaginary(frequency[swinging])
    onset[swinging] = _followed(here, speed[swinging], value)[1].real > 0.0
    shape[swinging] = np.abs(complex_modes(at_wind(here, speed[swinging]), value))
    before = unstable_pairs(eigenvalues(at_wind(turning, 0.5 * (preceding + speed)[still])))
    onset[still] = after[still] > before
    shape[still] = _null_vectors(turning, speed[still])
    return Crossings(
        member=member,
        wind_speed=speed,
        angular_frequency=frequency,
        onset=onset,
        oscillation=frequency > 0.0,
        coordinate=(shape**2).argmax(axis=-1),
        unstable_after=after,
    )


def _null_vectors(matrices: StateMatrices, speed: FloatArray) -> FloatArray:
    """Return the sizes of the displacements to which A has no answer at wind speeds (k,): (k, m)."""
    m = matrices.constant.shape[-1] // 2
    _, _, right = np.linalg.svd(at_wind(matrices, speed)[:, m:, :m])
    return np.asarray(np.abs(right[:, -1, :]))
