"""Stability of the static state over the wind speed, and all critical wind speeds. Theory section 6."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.arrays import BoolArray, ComplexArray, FloatArray, IntArray, eigenvalues
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
    oscillation = np.arange(member.size) < oscillating[0].size
    order = np.lexsort((speed, member))
    member, speed, oscillation = member[order], speed[order], oscillation[order]
    return _classified(_select(matrices, member), member, speed, oscillation, limit)


def critical_modes(model: ReducedModel, member: IntArray, wind_speed: FloatArray) -> ComplexArray:
    """Return the mode nearest to the imaginary axis at wind speeds (k,) of models (k,): (k, m), not normalized."""
    _, _, vector = _nearest_pair(_select(state_matrices(model), member), wind_speed)
    m = model.mass.shape[-1]
    return np.asarray(vector[:, :m] / np.sqrt(model.modal_masses)[member])


def crossing_error(model: ReducedModel, member: IntArray, wind_speed: FloatArray) -> FloatArray:
    """Return the size of one more Newton step on the growth rate at crossings (k,): (k,) [m/s]."""
    value, slope, _ = _nearest_pair(_select(state_matrices(model), member), wind_speed)
    return np.asarray(np.abs(value.real / slope.real))


def unstable_pairs(values: ComplexArray) -> IntArray:
    """Return the number of unstable pairs of eigenvalues (..., n), a real one counting as a pair: (...)."""
    size = np.abs(values).max(axis=-1, keepdims=True)
    unstable = (values.real > 1e-12 * size) & (values.imag >= 0.0)
    return np.asarray(unstable.sum(axis=-1))


def bialternate_sum(matrix: FloatArray) -> FloatArray:
    """Return the bialternate sum 2 A * I of (..., n, n): (..., n(n-1)/2, n(n-1)/2), eigenvalues lambda_i + lambda_j."""
    projection, injection = _antisymmetric(matrix.shape[-1])
    n = matrix.shape[-1]
    identity = np.eye(n)
    total = matrix[..., :, None, :, None] * identity[:, None, :]
    total = total + identity[:, None, :, None] * matrix[..., None, :, None, :]
    flat = total.reshape(*matrix.shape[:-2], n * n, n * n)
    return np.asarray(projection @ flat @ injection)


@lru_cache
def _antisymmetric(n: int) -> tuple[FloatArray, FloatArray]:
    """Return the maps between antisymmetric pairs (i > j) and the Kronecker square."""
    rows, columns = np.tril_indices(n, -1)
    injection = np.zeros((n * n, rows.size))
    injection[rows * n + columns, np.arange(rows.size)] = 1.0
    injection[columns * n + rows, np.arange(rows.size)] = -1.0
    return 0.5 * injection.T, injection


def _select(matrices: StateMatrices, members: IntArray) -> StateMatrices:
    return StateMatrices(matrices.constant[members], matrices.linear[members], matrices.quadratic[members])


def _oscillations(matrices: StateMatrices, limit: float) -> tuple[IntArray, FloatArray]:
    """Return members and wind speeds of all imaginary pairs, refined by Newton's method on the growth rate."""
    member, speed = _singular_speeds(matrices, limit)
    value, _, _ = _nearest_pair(_select(matrices, member), speed)
    # Two real eigenvalues of opposite sign also sum to zero; such a speed has no imaginary pair, unless by chance.
    imaginary = np.abs(value.real) < NEARLY_IMAGINARY * np.abs(value.imag)
    member, speed = member[imaginary], speed[imaginary]
    here = _select(matrices, member)
    for _ in range(2):
        value, slope, _ = _nearest_pair(here, speed)
        speed = speed - value.real / np.where(slope.real == 0.0, np.inf, slope.real)
    valid = (speed > 0.0) & (speed <= limit) & _distinct(member, speed)
    return member[valid], speed[valid]


def _distinct(member: IntArray, speed: FloatArray) -> BoolArray:
    """Return which crossings do not repeat an earlier one of the same member: (crossings,)."""
    order = np.lexsort((speed, member))
    new = np.ones(member.size, dtype=np.bool_)
    same = (np.diff(member[order]) == 0) & (np.abs(np.diff(speed[order])) <= 1e-9 * speed[order][1:])
    new[order[1:][same]] = False
    return new


def _singular_speeds(matrices: StateMatrices, limit: float) -> tuple[IntArray, FloatArray]:
    """Solve (B_0 + U B_1 + U^2 B_2) v = 0 for real U in (0, limit] as an eigenproblem in limit/U."""
    b_0, b_1, b_2 = (bialternate_sum(a) for a in (matrices.constant, matrices.linear, matrices.quadratic))
    size = b_0.shape[-1]
    problem = np.zeros((b_0.shape[0], 2 * size, 2 * size))
    problem[:, :size, size:] = np.eye(size)
    problem[:, size:, :size] = -np.linalg.solve(b_0, b_2) * limit**2
    problem[:, size:, size:] = -np.linalg.solve(b_0, b_1) * limit
    inverse = eigenvalues(problem) if problem.size else np.zeros((0, 2 * size), dtype=np.complex128)
    real = (np.abs(inverse.imag) < 1e-6 * np.abs(inverse)) & (inverse.real > 1.0 - 1e-9)
    member, column = np.nonzero(real)
    return member, limit / inverse.real[member, column]


def _nearest_pair(matrices: StateMatrices, speed: FloatArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return the eigenvalue nearest to the imaginary axis, its derivative by the wind speed, and its eigenvector."""
    if speed.size == 0:
        none = np.zeros(0, dtype=np.complex128)
        return none, none, np.zeros((0, matrices.constant.shape[-1]), dtype=np.complex128)
    values, vectors = np.linalg.eig(at_wind(matrices, speed))
    values, vectors = np.asarray(values, dtype=np.complex128), np.asarray(vectors, dtype=np.complex128)
    size = np.abs(values).max(axis=-1, keepdims=True)
    distance = np.where(values.imag > 1e-9 * size, np.abs(values.real), np.inf)
    nearest = distance.argmin(axis=-1)
    slope = matrices.linear + 2.0 * speed[:, None, None] * matrices.quadratic
    slopes = np.diagonal(np.linalg.solve(vectors, slope @ vectors), axis1=-2, axis2=-1)
    row = np.arange(speed.size)
    return values[row, nearest], slopes[row, nearest], vectors[row, :, nearest]


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
    oscillation: BoolArray,
    limit: float,
) -> Crossings:
    """Return crossings with direction, frequency, dominant coordinate and number of unstable pairs above each."""
    value, slope, vector = _nearest_pair(matrices, speed)
    m = matrices.constant.shape[-1] // 2
    same = member[1:] == member[:-1]
    following = np.where(np.append(same, False), np.append(speed[1:], limit), np.maximum(limit, speed * (1.0 + 1e-6)))
    preceding = np.where(np.append(False, same), np.append(0.0, speed[:-1]), 0.0)[: speed.size]
    between = np.stack([0.5 * (preceding + speed), 0.5 * (speed + following[: speed.size])], axis=-1)
    counts = unstable_pairs(eigenvalues(at_wind(matrices, between)))
    onset = np.where(oscillation, slope.real > 0.0, counts[:, 1] > counts[:, 0])
    null_vector = _null_vectors(matrices, speed)
    shape = np.where(oscillation[:, None], np.abs(vector[:, :m]), null_vector)
    return Crossings(
        member=member,
        wind_speed=speed,
        angular_frequency=np.where(oscillation, value.imag, 0.0),
        onset=onset,
        oscillation=oscillation,
        coordinate=(shape**2).argmax(axis=-1),
        unstable_after=counts[:, 1],
    )


def _null_vectors(matrices: StateMatrices, speed: FloatArray) -> FloatArray:
    m = matrices.constant.shape[-1] // 2
    _, _, right = np.linalg.svd(at_wind(matrices, speed)[:, m:, :m])
    return np.asarray(np.abs(right[:, -1, :]))
