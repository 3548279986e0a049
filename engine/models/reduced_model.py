"""The reduced model, hybrid or finite element: M q'' + C q' + K q = U^2 f(q, q'/U). Theory section 4."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.models.aerodynamic_load import PolynomialLoad, take_load
from engine.spec import Line


@dataclass(frozen=True, slots=True)
class ReducedModel:
    """M q'' + C q' + K q = U^2 f(q, q'/U) for a stack of models with m generalized coordinates.

    mass, damping, stiffness: (..., m, m); load: f, of the same leading axes; shapes: (..., m, 3, nodes), the fields V,
    W, Theta of each coordinate; direction: (m,), the direction of each coordinate (0 vertical, 1 horizontal, 2
    torsional); statically_unstable: (...), True where the stiffness is not positive definite; damping has no meaning
    there.
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    load: PolynomialLoad
    shapes: FloatArray
    direction: IntArray
    statically_unstable: BoolArray

    @property
    def modal_masses(self) -> FloatArray:
        """The diagonal M_ii of the mass: (..., m)."""
        return diagonals(self.mass)

    @property
    def uncoupled_squares(self) -> FloatArray:
        """Squared natural frequencies K_ii / M_ii of each co-ordinate by itself: (..., m) [rad^2/s^2]."""
        return np.asarray(diagonals(self.stiffness) / self.modal_masses)


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
    )


def damping_ratios(lines: Sequence[Line]) -> FloatArray:
    """Return zeta of the vertical, horizontal and torsional direction of each line, eq. (11): (lines, 3)."""
    return np.array([(d.vertical_ratio, d.horizontal_ratio, d.torsional_ratio) for d in (x.damping for x in lines)])


def diagonals(matrices: FloatArray) -> FloatArray:
    """Return the diagonals (..., n) of matrices (..., n, n)."""
    return np.diagonal(matrices, axis1=-2, axis2=-1)


def diagonal_matrices(values: FloatArray) -> FloatArray:
    """Return diagonal matrices (..., n, n) of diagonals (..., n)."""
    return values[..., None] * np.eye(values.shape[-1])
