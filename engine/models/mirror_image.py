"""Models that are their own mirror image about mid-span, for which many cycles take half of the work.

With equal ends, uniform ice and wind, and devices in pairs or none, the equations stay the same when the span is
mirrored, which changes the sign of coordinates with odd shapes: F(P q) = P F(q), P = diag(parity). A cycle with
q(t + T/2) = P q(t) then has harmonics of even order only in its even coordinates and of odd order in the odd ones, and
half a period holds all of it. The cycles of two loops that start at a Hopf point do so: their critical mode is odd, and
a solution of such a start by Newton's method stays so. The compiled kernels make use of it. Decision 74.
"""

from dataclasses import replace

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.models.reduced_model import ReducedModel, force
from engine.models.stretching import restoring_force

SAMPLES = 4  # states at which the forces are compared
EQUAL = 1e-9  # largest relative difference of what counts as equal


def with_parity(model: ReducedModel, fields: FloatArray) -> ReducedModel:
    """Return models with the parity of their coordinates, zeros where a model is not its own mirror image.

    Parameters
    ----------
    model : ReducedModel
        Leading axes (...,).
    fields : (..., m, 3, nodes)
        V, W and Theta of each coordinate at nodes with equal distances, those of a relief coordinate included.
    """
    squares = (fields**2).sum(axis=(-2, -1))
    likeness = (fields * fields[..., ::-1]).sum(axis=(-2, -1)) / np.where(squares > 0.0, squares, np.inf)
    parity = np.sign(likeness)
    own = (np.abs(likeness) > 1.0 - EQUAL).all(axis=-1) & (parity < 0.0).any(axis=-1)
    own &= _keep_apart(model, parity) & _mirror_forces(model, parity)
    return replace(model, parity=np.where(own[..., None], parity, 0.0).astype(np.intp))


def _keep_apart(model: ReducedModel, parity: FloatArray) -> BoolArray:
    """Return which models couple no even coordinate with an odd one linearly: (...)."""
    apart = parity[..., :, None] != parity[..., None, :]
    held = np.ones(parity.shape[:-1], dtype=np.bool_)
    for matrix in (model.mass, model.damping, model.stiffness):
        size = np.abs(np.diagonal(matrix, axis1=-2, axis2=-1))
        scale = np.sqrt(size[..., :, None] * size[..., None, :])
        held &= (~apart | (np.abs(matrix) <= EQUAL * scale)).all(axis=(-2, -1))
    return held


def _mirror_forces(model: ReducedModel, parity: FloatArray) -> BoolArray:
    """Return which models have the mirrored forces at mirrored states: (...)."""
    state = np.broadcast_to(_states(model.mass.shape[-1]), (*parity.shape[:-1], SAMPLES, 2 * parity.shape[-1]))
    mirror = parity[..., None, :]
    held = _equal(force(model, state * np.tile(mirror, 2)), mirror * force(model, state))
    if model.stretching is not None:
        q = state[..., : parity.shape[-1]]
        held &= _equal(restoring_force(model.stretching, q * mirror), mirror * restoring_force(model.stretching, q))
    return held


def _equal(one: FloatArray, other: FloatArray) -> BoolArray:
    """Return whether forces (..., samples, m) are equal, each coordinate's compared with its largest: (...)."""
    largest = np.abs(other).max(axis=-2)
    return np.asarray((np.abs(one - other).max(axis=-2) <= EQUAL * largest).all(axis=-1))


def _states(m: int) -> FloatArray:
    """Return states (samples, 2 m) without any symmetry, all components between -1 and 1."""
    order = np.arange(1.0, SAMPLES * 2 * m + 1.0)
    return np.asarray(np.cos(order**2).reshape(SAMPLES, 2 * m))
