"""The reduced model, hybrid or finite element: M q'' + C q' + K q = U^2 f(q, q'/U) - g(q). Theory section 4, 12.1."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.models import aerodynamic_load, unexpanded_load
from engine.models.aerodynamic_load import PolynomialLoad, take_load
from engine.models.stretching import StretchingForce, restoring_force, restoring_gradient, take_stretching
from engine.models.unexpanded_load import UnexpandedLoad, take_unexpanded
from engine.spec import Line


@dataclass(frozen=True, slots=True)
class ReducedModel:
    """M q'' + C q' + K q = U^2 f(q, q'/U) - g(q) for a stack of models with m generalized coordinates.

    mass, damping, stiffness: (..., m, m); load: f, of the same leading axes; shapes: (..., m, 3, nodes), the fields V,
    W, Theta of each coordinate that the wind acts on and that are reported, zero for a relief coordinate; direction:
    (m,), the direction of each coordinate (0 vertical, 1 horizontal, 2 torsional); statically_unstable: (...), True
    where the stiffness is not positive definite; damping has no meaning there; stretching: g, of the same leading axes,
    None where it is neglected; unexpanded: f as it stands, which then acts in the place of the load expanded in the
    motion; parity: (..., m), where the span is its own mirror image 1 for coordinates with even shapes and -1 for those
    with odd ones, 0 elsewhere, None where that was not looked at (`engine.models.mirror_image`).
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    load: PolynomialLoad
    shapes: FloatArray
    direction: IntArray
    statically_unstable: BoolArray
    stretching: StretchingForce | None = None
    unexpanded: UnexpandedLoad | None = None
    parity: IntArray | None = None

    @property
    def modal_masses(self) -> FloatArray:
        """The diagonal M_ii of the mass: (..., m)."""
        return diagonals(self.mass)

    @property
    def uncoupled_squares(self) -> FloatArray:
        """Squared natural frequencies K_ii / M_ii of each co-ordinate by itself: (..., m) [rad^2/s^2]."""
        return np.asarray(diagonals(self.stiffness) / self.modal_masses)


def of_each_member(model: ReducedModel, wind_speeds: FloatArray) -> FloatArray:
    """Return wind speeds (members, winds), given those of all members, (winds,), or those of each."""
    return np.broadcast_to(wind_speeds, (model.mass.shape[0], wind_speeds.shape[-1]))


def lowest_frequency(model: ReducedModel) -> FloatArray:
    """Return the root of the smallest |K_ii / M_ii| of each model: (members,) [rad/s]."""
    return np.asarray(np.sqrt(np.abs(model.uncoupled_squares).min(axis=-1)))


def take(model: ReducedModel, index: Any) -> ReducedModel:
    """Select or repeat models along the leading axes; index is any numpy index of these axes."""
    return ReducedModel(
        mass=model.mass[index],
        damping=model.damping[index],
        stiffness=model.stiffness[index],
        load=take_load(model.load, index),
        shapes=model.shapes[index],
        direction=model.direction,
        statically_unstable=model.statically_unstable[index],
        stretching=take_stretching(model.stretching, index),
        unexpanded=take_unexpanded(model.unexpanded, index),
        parity=None if model.parity is None else model.parity[index],
    )


def with_samples(model: ReducedModel, samples: int) -> ReducedModel:
    """Return models whose unexpanded load, if there is one, has so many samples in a period of the harmonic balance."""
    if model.unexpanded is None:
        return model
    return replace(model, unexpanded=replace(model.unexpanded, samples=samples))


def samples_in_period(model: ReducedModel, harmonics: int) -> int:
    """Return how many samples of a period the harmonic balance takes: enough for a cubic load to be exact at least."""
    exact = 4 * harmonics + 2
    return exact if model.unexpanded is None else max(exact, model.unexpanded.samples)


def force(model: ReducedModel, state: FloatArray) -> FloatArray:
    """Return the load divided by U^2 at states (..., samples, 2 m) of q and q'/U: (..., samples, m)."""
    if model.unexpanded is not None:
        return unexpanded_load.force(model.unexpanded, state)
    return aerodynamic_load.force(model.load, state)


def force_gradient(model: ReducedModel, state: FloatArray) -> FloatArray:
    """Differentiate the load divided by U^2 by (q, q'/U): (..., samples, m, 2 m)."""
    if model.unexpanded is not None:
        return unexpanded_load.force_gradient(model.unexpanded, state)
    return aerodynamic_load.force_gradient(model.load, state)


def gradient_at_rest(model: ReducedModel) -> FloatArray:
    """Differentiate the load divided by U^2 by (q, q'/U) at the static state: (..., m, 2 m)."""
    if model.unexpanded is not None:
        return model.unexpanded.at_rest_gradient
    still = np.zeros((*model.mass.shape[:-2], 1, 2 * model.mass.shape[-1]))
    return aerodynamic_load.force_gradient(model.load, still)[..., 0, :, :]


def resultant(model: ReducedModel, state: FloatArray, wind_speed: FloatArray) -> FloatArray:
    """Return f - g / U^2, the forces of wind and stretching over U^2.

    Parameters
    ----------
    model : ReducedModel
        With leading axes (...,).
    state : (..., samples, 2 m)
        q and q'/U.
    wind_speed : (...,)
        U [m/s].

    Returns
    -------
    (..., samples, m)
    """
    load = force(model, state)
    if model.stretching is None:
        return load
    m = model.mass.shape[-1]
    return np.asarray(load - restoring_force(model.stretching, state[..., :m]) / wind_speed[..., None, None] ** 2)


def resultant_gradient(model: ReducedModel, state: FloatArray, wind_speed: FloatArray) -> FloatArray:
    """Differentiate `resultant` by (q, q'/U): (..., samples, m, 2 m)."""
    gradient = force_gradient(model, state)
    if model.stretching is None:
        return gradient
    m = model.mass.shape[-1]
    by_q = restoring_gradient(model.stretching, state[..., :m]) / wind_speed[..., None, None, None] ** 2
    return np.concatenate([gradient[..., :m] - by_q, gradient[..., m:]], axis=-1)


def damping_ratios(lines: Sequence[Line]) -> FloatArray:
    """Return zeta of the vertical, horizontal and torsional direction of each line, eq. (11): (lines, 3)."""
    return np.array([(d.vertical_ratio, d.horizontal_ratio, d.torsional_ratio) for d in (x.damping for x in lines)])


def diagonals(matrices: FloatArray) -> FloatArray:
    """Return the diagonals (..., n) of matrices (..., n, n)."""
    return np.diagonal(matrices, axis1=-2, axis2=-1)


def diagonal_matrices(values: FloatArray) -> FloatArray:
    """Return diagonal matrices (..., n, n) of diagonals (..., n)."""
    return values[..., None] * np.eye(values.shape[-1])
