"""Eigenvalues of all freedoms together, from the modes of each direction that are known anyway. Theory section 4."""

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, take_rows
from engine.mechanics.finite_elements import FIELDS, Matrices
from engine.mechanics.modes import (
    DIRECTIONS,
    FIELDS_OF,
    DirectionalShapes,
    assign,
    full_modes,
    moving_freedoms,
    waves,
)
from engine.numerics.eigenproblems import eigenvalues_alone, largest_sines, solve_symmetric

FURTHER = 2  # modes of each direction beyond the largest number of loops, in which all freedoms are approximated first
LARGEST_SINE = 0.1  # between a mode and its first approximation, beyond which this one tells nothing
LARGEST_CHANGE = 1e-5  # of an eigenvalue by the corrections; the error that is left is of the order of its square


def full_eigenvalues(system: Matrices, shapes: DirectionalShapes, loops: tuple[int, ...]) -> FloatArray:
    """Compute the eigenvalues of the modes that `full_modes` labels, without solving for all of them.

    The lowest modes of each direction approximate them (Rayleigh and Ritz) and tell which label each has. One step of
    Davidson's method corrects those that have one: their residuals, each component in the modes left out over the
    difference of the eigenvalues, join the basis. Where the error of the first approximation could change a label, or
    the corrections change much, `full_modes` decides.

    Parameters
    ----------
    system : Matrices
    shapes : DirectionalShapes
        Of the same lines.
    loops : tuple of int
        Distinct, from 1.

    Returns
    -------
    (lines, 3, loops)
        [rad^2/s^2].
    """
    nodes = shapes.nodal.shape[-1]
    count = min(max(loops) + FURTHER, nodes - 2)
    sines = waves(np.arange(FIELDS * nodes), nodes, DIRECTIONS, loops)
    near = _in_all_freedoms([modes.vectors[:, :count] for modes in shapes.modes], nodes)
    stiffness = _product(system.stiffness, near, system.fixed)
    both = np.append(near, np.broadcast_to(sines, (len(near), *sines.shape)), axis=1)
    inertia, momenta = np.split(_product(system.mass, both, system.fixed), [near.shape[1]], axis=1)
    across = near.swapaxes(-1, -2)
    first, vectors = solve_symmetric(stiffness @ across, inertia @ across)
    turn = vectors.swapaxes(-1, -2)
    near, stiffness, inertia = turn @ near, turn @ stiffness, turn @ inertia
    score = (momenta @ near.swapaxes(-1, -2)) ** 2 / (momenta * sines).sum(axis=-1, keepdims=True)
    corrected = assign(score)
    own = np.take_along_axis(first, corrected, axis=-1)[..., None]
    residual, moving = (np.take_along_axis(x, corrected[..., None], axis=1) for x in (stiffness, inertia))
    beyond = _corrections(shapes, count, residual - own * moving, own)
    basis = np.append(near, beyond, axis=1).swapaxes(-1, -2)
    values = eigenvalues_alone(
        np.append(stiffness, _product(system.stiffness, beyond, system.fixed), axis=1) @ basis,
        np.append(inertia, _product(system.mass, beyond, system.fixed), axis=1) @ basis,
    )
    chosen, clear = _clearly_assigned(score, largest_sines(first, values))
    found = np.take_along_axis(values, chosen, axis=-1)
    clear &= (np.abs(found - own[..., 0]) <= LARGEST_CHANGE * np.abs(found)).all(axis=-1)
    doubtful = np.flatnonzero(~clear)
    found = found.reshape(-1, len(DIRECTIONS), len(loops))
    if doubtful.size:
        found[doubtful] = full_modes(take_rows(system, doubtful), loops).eigenvalues
    return found


def _in_all_freedoms(rows: list[FloatArray], nodes: int) -> FloatArray:
    """Join vectors on the freedoms of each direction, (lines, its own number, its freedoms), to ones on all."""
    places = np.cumsum([0, *(part.shape[1] for part in rows)])
    whole = np.zeros((len(rows[0]), places[-1], FIELDS * nodes))
    for part, fields, place in zip(rows, FIELDS_OF, places[:-1], strict=True):
        whole[:, place : place + part.shape[1], moving_freedoms(fields, nodes)] = part
    return whole


def _product(matrix: FloatArray, rows: FloatArray, held: BoolArray) -> FloatArray:
    """Multiply vectors (lines, k, freedoms) by K or M in which held freedoms are decoupled."""
    own = rows * held[:, None]
    return ((rows - own) @ matrix) * ~held[:, None] + own * np.diagonal(matrix, axis1=-2, axis2=-1)[:, None]


def _corrections(shapes: DirectionalShapes, count: int, residual: FloatArray, values: FloatArray) -> FloatArray:
    """Return an orthonormal basis of the corrections of modes: (lines, modes, freedoms).

    count: of the lowest modes of each direction, to which the residuals (lines, modes, freedoms) are orthogonal;
    values: (lines, modes, 1).
    """
    places = [moving_freedoms(fields, shapes.nodal.shape[-1]) for fields in FIELDS_OF]
    left_out = [modes.vectors[:, count:] for modes in shapes.modes]
    parts = []
    for modes, vectors, here in zip(shapes.modes, left_out, places, strict=True):
        squares = modes.squares[:, None, count:]
        gap = np.where(values == squares, np.spacing(squares), values - squares)
        parts.append(residual[..., here] @ vectors.swapaxes(-1, -2) / gap)
    basis, _ = np.linalg.qr(np.concatenate(parts, axis=-1).swapaxes(-1, -2))  # also where some are zero or alike
    ends = np.cumsum([part.shape[-1] for part in parts])[:-1]
    whole = np.zeros((len(basis), basis.shape[-1], residual.shape[-1]))
    for part, vectors, here in zip(np.split(basis, ends, axis=1), left_out, places, strict=True):
        whole[..., here] = part.swapaxes(-1, -2) @ vectors
    return whole


def _clearly_assigned(score: FloatArray, error: FloatArray) -> tuple[IntArray, BoolArray]:
    """Assign modes as `assign` does, and tell of which lines no score within its error leads to another assignment.

    score: (lines, labels, modes), squared overlaps with the lowest modes; those of a label with all modes sum up to 1;
    error: (lines, modes).
    """
    known = error < LARGEST_SINE
    score, error = np.where(known[:, None], score, 0.0), np.where(known, error, 0.0)
    elsewhere = 1.0 - score.sum(axis=-1, keepdims=True)
    score, error = np.append(score, elsewhere, axis=-1), np.append(error, error.sum(axis=-1, keepdims=True), axis=-1)
    chosen = assign(score)
    row = np.arange(len(score))
    own = np.take_along_axis(score, chosen[..., None], axis=-1)[..., 0]
    clear, rival = (chosen < known.shape[1]).all(axis=-1), score + error[:, None]
    for label in np.argsort(-own, axis=-1).T:  # the order of assignment
        mode = chosen[row, label]
        least = own[row, label] - error[row, mode]
        rival[row, label, mode] = -np.inf
        clear &= least > np.maximum(rival[row, label].max(axis=-1), rival[row, :, mode].max(axis=-1))
        rival[row, label, :] = rival[row, :, mode] = -np.inf
    return chosen, clear
