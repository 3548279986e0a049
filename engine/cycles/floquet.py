"""Floquet multipliers and stability of periodic motions. Theory section 7.3."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.arrays import ComplexArray, FloatArray, IntArray, ObjectArray
from engine.cycles.harmonic_balance import Orbits, basis, fourier, select, states
from engine.kernels import compiled
from engine.kernels.eigenvalues import eigenvalues
from engine.models.reduced_model import ReducedModel, resultant_gradient, take
from engine.outcome import Stability

PHASE_PER_STEP = 0.9  # rad of sqrt(trace(M^-1 K)) t, which bounds the fastest mode: the series is exact to 1e-6
FEWEST_STEPS = 16
BLOCK_NUMBERS = 1_000_000  # largest number of entries in the matrices of one block of cycles
MOST_STEPS = 2048  # beyond this number a mode is too fast for the cycle to be integrated; its stability is unknown


@dataclass(frozen=True, slots=True)
class Floquet:
    """Floquet multipliers and stability of a stack of orbits.

    multipliers: (cycles, 2 m) complex, the trivial one first, NaN where they were not computed; trivial_error:
    (cycles,), its distance from 1, which bounds what the others may be trusted to; stability: (cycles,) of Stability.
    """

    multipliers: ComplexArray
    trivial_error: FloatArray
    stability: ObjectArray


def floquet(model: ReducedModel, member: IntArray, orbits: Orbits, fineness: int = 1) -> Floquet:
    """Return the Floquet multipliers and the stability of orbits, from the linearized equations over one period.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member : (cycles,)
        The model of each orbit.
    orbits : Orbits
    fineness : int
        Factor on the number of steps, a power of two.

    Returns
    -------
    Floquet
    """
    matrices = monodromy(model, member, orbits, fineness)
    cycles, size, _ = matrices.shape
    values = np.full((cycles, size), np.nan, dtype=np.complex128)
    known = np.isfinite(matrices).all(axis=(-1, -2))
    values[known] = eigenvalues(matrices[known])
    trivial = np.abs(values - 1.0).argmin(axis=-1)
    order = np.argsort(np.arange(size) != trivial[:, None], axis=-1, kind="stable")
    values = np.take_along_axis(values, order, axis=-1)
    error = np.abs(values[:, 0] - 1.0)
    largest = np.abs(values[:, 1:]).max(axis=-1, initial=0.0)
    return Floquet(values, error, stability_verdicts(largest, error))


def stability_verdicts(largest: FloatArray, error: FloatArray) -> ObjectArray:
    """Return the stability that follows from the largest modulus of the nontrivial multipliers (cycles,).

    error (cycles,) is the distance of the trivial multiplier from 1; UNKNOWN where it leaves the stability undecided.
    """
    margin = np.maximum(3.0 * error, 1e-7)
    verdicts = np.array([Stability.UNKNOWN, Stability.STABLE, Stability.UNSTABLE], dtype=np.object_)
    return verdicts[1 * (largest < 1.0 - margin) + 2 * (largest > 1.0 + margin)]


def monodromy(model: ReducedModel, member: IntArray, orbits: Orbits, fineness: int = 1) -> FloatArray:
    """Return the monodromy matrix of (q, q'/w): (cycles, 2 m, 2 m), NaN where a period needs too many steps.

    The parameters are those of `floquet`.
    """
    size = 2 * model.mass.shape[-1]
    inverse, own = np.zeros_like(model.mass), np.unique(member)  # points of few branches have few of the models
    inverse[own] = np.linalg.inv(model.mass[own])
    steps = fineness * steps_needed(inverse[member] @ model.stiffness[member], orbits.angular_frequency)
    if compiled.AVAILABLE:
        return _compiled_products(model, member, orbits, inverse, np.where(steps <= MOST_STEPS, steps, 0))
    matrices: FloatArray = np.full((orbits.wind_speed.size, size, size), np.nan)
    for count in np.unique(steps[steps <= MOST_STEPS]).tolist():
        here = np.flatnonzero(steps == count)
        block = max(1, BLOCK_NUMBERS // (count * size**2))
        for first in range(0, here.size, block):
            some = here[first : first + block]
            matrices[some] = _product_over_period(take(model, member[some]), select(orbits, some), count)
    return matrices


def _compiled_products(
    model: ReducedModel, member: IntArray, orbits: Orbits, inverse: FloatArray, steps: IntArray
) -> FloatArray:
    """Return the monodromy matrices by the compiled kernel, NaN where the number of steps is 0."""
    harmonics = orbits.coefficients.shape[-1] // 2
    counts = np.unique(np.append(steps, 0))
    bases = [_gauss_basis(count, harmonics) for count in counts.tolist()]
    values, slopes = (np.concatenate(parts) for parts in zip(*bases, strict=True))
    first = (np.cumsum(2 * counts) - 2 * counts)[np.searchsorted(counts, steps)]
    motion = (orbits.coefficients, orbits.angular_frequency, orbits.wind_speed)
    return compiled.products_over_period(model, (member, inverse, *motion), (values, slopes), (steps, first))


def _product_over_period(model: ReducedModel, orbits: Orbits, steps: int) -> FloatArray:
    """Return the monodromy matrices by Magnus' fourth-order method with two Gauss points per step.

    The constant part of the equations is integrated exactly. The number of steps is a power of two.
    """
    width = 2.0 * np.pi / steps
    with np.errstate(over="ignore", invalid="ignore"):
        first, second = (
            state_matrix(model, states(orbits, tau), orbits.angular_frequency, orbits.wind_speed)
            for tau in gauss_phases(steps)
        )
        return ordered_product(step_maps(first, second, width))


def step_maps(first: FloatArray, second: FloatArray, width: float) -> FloatArray:
    """Return the maps over steps of a given width [rad] from the state matrices at both Gauss points: (..., n, n)."""
    commutator = second @ first - first @ second
    return _exponential(0.5 * width * (first + second) + (np.sqrt(3.0) / 12.0 * width**2) * commutator)


def gauss_phases(steps: int) -> FloatArray:
    """Return the phases of the two Gauss points of every step: (2, steps) [rad]."""
    offset = np.array([[-1.0], [1.0]]) * np.sqrt(3.0) / 6.0
    return np.asarray((np.arange(steps) + 0.5 + offset) * (2.0 * np.pi / max(steps, 1)))


@lru_cache
def _gauss_basis(steps: int, harmonics: int) -> tuple[FloatArray, FloatArray]:
    """Return the Fourier basis and its derivative at all first, then all second Gauss points: (2 steps, 2 H + 1)."""
    values = fourier(gauss_phases(steps).ravel(), harmonics)
    return values, values @ basis(harmonics).derivative


def steps_needed(square: FloatArray, angular_frequency: FloatArray) -> IntArray:
    """Return the number of steps per period, a power of two, that resolves the fastest mode of M^-1 K: (cycles,)."""
    trace = np.trace(square, axis1=-2, axis2=-1)
    needed = 2.0 * np.pi / PHASE_PER_STEP * np.sqrt(np.abs(trace)) / angular_frequency
    return np.asarray(2 ** np.ceil(np.log2(np.clip(needed, FEWEST_STEPS, 2 * MOST_STEPS))), dtype=np.intp)


def state_matrix(
    model: ReducedModel, state: FloatArray, angular_frequency: FloatArray, wind_speed: FloatArray
) -> FloatArray:
    """Return A of the linearized equations y' = A y, y = (q, dq/dtau): (cycles, samples, 2 m, 2 m).

    They are linearized about states (q, q'/U) of shape (cycles, samples, 2 m).
    """
    m = model.mass.shape[-1]
    gradient = resultant_gradient(model, state, wind_speed)
    omega, speed = angular_frequency[:, None, None, None], wind_speed[:, None, None, None]
    stiffness = (model.stiffness[:, None] - speed**2 * gradient[..., :m]) / omega**2
    damping = (model.damping[:, None] - speed * gradient[..., m:]) / omega
    inverse = np.linalg.inv(model.mass)[:, None]
    result = np.zeros((*gradient.shape[:2], 2 * m, 2 * m))
    result[..., :m, m:] = np.eye(m)
    result[..., m:, :m] = -inverse @ stiffness
    result[..., m:, m:] = -inverse @ damping
    return result


def _exponential(matrix: FloatArray) -> FloatArray:
    """Return the matrix exponential by its series to degree 8 in four products; the argument is small."""
    identity = np.eye(matrix.shape[-1])
    square = matrix @ matrix
    cube, fourth = square @ matrix, square @ square
    high = identity / 24.0 + matrix / 120.0 + square / 720.0 + cube / 5040.0 + fourth / 40320.0
    return np.asarray(identity + matrix + square / 2.0 + cube / 6.0 + fourth @ high)


def ordered_product(factors: FloatArray) -> FloatArray:
    """Return the product of factors (cycles, steps, n, n), later ones on the left; steps is a power of two."""
    while factors.shape[1] > 1:
        factors = factors[:, 1::2] @ factors[:, ::2]
    return factors[:, 0]
