"""Natural modes: the full finite element modes labelled by direction and loops, and the directional shapes.

Theory section 4. All problems are symmetric generalized eigenproblems, solved on stacks of lines.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, merge_axes, take_rows
from engine.mechanics.finite_elements import FIELDS, THETA, Matrices, U, V, W
from engine.numerics.eigenproblems import eigenvalues_alone, largest_sines, solve_symmetric, standard_form

DIRECTIONS = (V, W, THETA)
TORSIONAL = 2  # of the three directions
FURTHER = (
    2  # modes of each direction beyond the largest number of loops, in which modes of all freedoms are approximated
)
LARGEST_SINE = 0.1  # between a mode and its approximation, beyond which this one tells nothing


@dataclass(frozen=True, slots=True)
class DirectionalShapes:
    """Shapes of each direction and number of loops, from separate eigenproblems in (U, V), in W and in Theta.

    loops: the numbers of loops, in the order of the second axis. nodal: (lines, loops, 4, nodes), rows f_u, f_v, f_w,
    f_theta; f_v, f_w and f_theta have (2/L) int f^2 ds = 1 and the sign of sin(k pi s/L).
    angular_frequency: (lines, loops, 3) of the three eigenproblems [rad/s], NaN where the stiffness is negative.
    lowest: (lines, 3, modes, freedoms), the lowest modes of each eigenproblem, whatever their loops.
    """

    loops: tuple[int, ...]
    nodal: FloatArray
    angular_frequency: FloatArray
    lowest: FloatArray


@dataclass(frozen=True, slots=True)
class FullModes:
    """Modes of the whole finite element model, one for each direction and number of loops.

    vectors: (lines, 3, loops, freedoms), orthonormal in M; eigenvalues: (lines, 3, loops) [rad^2/s^2].
    """

    loops: tuple[int, ...]
    vectors: FloatArray
    eigenvalues: FloatArray


def directional_shapes(system: Matrices, arc_length: FloatArray, loops: tuple[int, ...]) -> DirectionalShapes:
    """Compute the shapes of each direction for the given numbers of loops.

    Parameters
    ----------
    system : Matrices
    arc_length : (lines,)
        L [m].
    loops : tuple of int
        Distinct, from 1.

    Returns
    -------
    DirectionalShapes
    """
    lines, freedoms, _ = system.stiffness.shape
    nodes = freedoms // FIELDS
    shapes = DirectionalShapes(
        loops,
        nodal=np.zeros((lines, len(loops), FIELDS, nodes)),
        angular_frequency=np.empty((lines, len(loops), 3)),
        lowest=np.zeros((lines, 3, min(max(loops) + FURTHER, nodes - 2), freedoms)),
    )
    for direction in range(3):
        _solve_direction(shapes, direction, system, arc_length)
    return shapes


def turned_shapes(still: DirectionalShapes, system: Matrices, arc_length: FloatArray) -> DirectionalShapes:
    """Return the shapes about a state of another static twist, which changes stiffness and mass of Theta alone.

    Parameters
    ----------
    still : DirectionalShapes
        Of the same lines at any twist.
    system, arc_length : Matrices, (lines,)
        As for `directional_shapes`, at the new twist.
    """
    own = (still.nodal.copy(), still.angular_frequency.copy(), still.lowest.copy())
    shapes = DirectionalShapes(still.loops, *own)
    _solve_direction(shapes, TORSIONAL, system, arc_length)
    return shapes


def _solve_direction(shapes: DirectionalShapes, direction: int, system: Matrices, arc_length: FloatArray) -> None:
    """Solve the eigenproblem of a direction, in place."""
    fields, nodes = ((U, V), (W,), (THETA,))[direction], shapes.nodal.shape[-1]
    freedoms = _freedoms(fields, nodes)
    vectors, values = _labelled(system, freedoms, (fields[-1],), shapes.loops, shapes.lowest.shape[2])
    labels = len(shapes.loops)
    whole = np.zeros((*vectors.shape[:2], FIELDS * nodes))
    whole[..., freedoms] = vectors
    shapes.lowest[:, direction] = whole[:, labels:]
    shape = whole[:, :labels].reshape(-1, labels, nodes, FIELDS).swapaxes(-1, -2)[:, :, list(fields)]
    shapes.nodal[:, :, list(fields)] = _normalized(shape, system, arc_length)
    shapes.angular_frequency[:, :, direction] = np.sqrt(np.where(values > 0.0, values, np.nan))


def longitudinal_share(system: Matrices, shapes: DirectionalShapes) -> FloatArray:
    """Return the share of U in the kinetic energy of the vertical shapes: (lines, loops).

    Where a longitudinal and a vertical frequency come close, both modes hold both motions.
    """
    nodes = shapes.nodal.shape[-1]
    energy = []
    for field in (U, V):
        freedoms = field + FIELDS * np.arange(nodes)
        mass = system.mass[:, freedoms[:, None], freedoms]
        energy.append(((shapes.nodal[:, :, field] @ mass) * shapes.nodal[:, :, field]).sum(axis=-1))
    return np.asarray(energy[0] / (energy[0] + energy[1]))


def full_modes(system: Matrices, loops: tuple[int, ...]) -> FullModes:
    """Compute the modes of all freedoms together, labelled by direction and number of loops.

    Parameters
    ----------
    system : Matrices
    loops : tuple of int
        Distinct, from 1.

    Returns
    -------
    FullModes
    """
    freedoms = np.flatnonzero(~_always_fixed(system.stiffness.shape[-1]))
    vectors, values = _labelled(system, freedoms, DIRECTIONS, loops)
    whole = np.zeros((*vectors.shape[:2], system.stiffness.shape[-1]))
    whole[..., freedoms] = vectors
    shape = (values.shape[0], len(DIRECTIONS), len(loops))
    return FullModes(loops, whole.reshape(*shape, -1), values.reshape(shape))


def full_eigenvalues(system: Matrices, shapes: DirectionalShapes, loops: tuple[int, ...]) -> FloatArray:
    """Compute the eigenvalues of the modes that `full_modes` labels, without their vectors, which take twice as long.

    All eigenvalues are solved for. Which label each of the lowest has, its approximation by the directional modes tells
    (Rayleigh and Ritz). Where the error of these could change a label, `full_modes` decides.

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
    freedoms = np.flatnonzero(~_always_fixed(system.stiffness.shape[-1]))
    stiffness, mass = _on_freedoms(system, freedoms)
    values = eigenvalues_alone(stiffness, mass)
    basis = merge_axes(shapes.lowest, -3, -2)[..., freedoms]
    across = basis.swapaxes(-1, -2)
    approximate, vectors = solve_symmetric(basis @ stiffness @ across, basis @ mass @ across)
    overlap = _momenta_of_sines(mass, freedoms, DIRECTIONS, loops) @ across @ vectors
    chosen, clear = _clearly_assigned(overlap**2, largest_sines(approximate, values))
    found = np.take_along_axis(values, chosen, axis=-1).reshape(-1, len(DIRECTIONS), len(loops))
    doubtful = np.flatnonzero(~clear)
    if doubtful.size:
        found[doubtful] = full_modes(take_rows(system, doubtful), loops).eigenvalues
    return found


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


def at_points(system: Matrices, nodal: FloatArray) -> FloatArray:
    """Interpolate nodal values (lines, ..., nodes) to the quadrature points: (lines, ..., elements, points)."""
    elements = system.weight.shape[1]
    first = 2 * np.arange(elements)[:, None] + np.arange(3)
    by_element = nodal[..., first]
    lines = nodal.shape[0]
    flat = by_element.reshape(lines, -1, elements, 3)
    values = np.einsum("lrea,lepa->lrep", flat, system.interpolation, optimize=True)
    return np.asarray(values.reshape(*nodal.shape[:-1], elements, system.weight.shape[2]))


def _always_fixed(freedoms: int) -> BoolArray:
    held = np.zeros(freedoms, dtype=np.bool_)
    held[[V, W, THETA, V - FIELDS, W - FIELDS, THETA - FIELDS]] = True
    return held


def _freedoms(fields: tuple[int, ...], nodes: int) -> IntArray:
    every = np.arange(FIELDS * nodes)
    return every[np.isin(every % FIELDS, fields) & ~_always_fixed(FIELDS * nodes)]


def _labelled(
    system: Matrices, freedoms: IntArray, directions: tuple[int, ...], loops: tuple[int, ...], lowest: int = 0
) -> tuple[FloatArray, FloatArray]:
    """Solve the eigenproblem on some freedoms and pick one mode for each direction and number of loops.

    Returns vectors (lines, labels + lowest, freedoms), of labels direction-major and then of the lowest modes, and
    eigenvalues (lines, labels).
    """
    stiffness, mass = _on_freedoms(system, freedoms)
    inverse, standard = standard_form(stiffness, mass)
    values, vectors = np.linalg.eigh(standard)
    overlap = _momenta_of_sines(mass, freedoms, directions, loops) @ inverse.swapaxes(-1, -2) @ vectors
    chosen = assign(overlap**2)
    sign = np.sign(np.take_along_axis(overlap, chosen[..., None], axis=-1))
    modes = vectors.swapaxes(-1, -2)
    selected = sign * np.take_along_axis(modes, chosen[..., None], axis=1)
    return np.append(selected, modes[:, :lowest], axis=1) @ inverse, np.take_along_axis(values, chosen, axis=-1)


def _on_freedoms(system: Matrices, freedoms: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and mass on some freedoms (lines, freedoms, freedoms), those that are held decoupled."""
    stiffness, mass = (matrix[:, freedoms[:, None], freedoms] for matrix in (system.stiffness, system.mass))
    _decouple(stiffness, mass, system.fixed[:, freedoms])
    return stiffness, mass


def _momenta_of_sines(
    mass: FloatArray, freedoms: IntArray, directions: tuple[int, ...], loops: tuple[int, ...]
) -> FloatArray:
    """Return M x of the sines of each label, x^T M x = 1: (lines, labels, freedoms)."""
    sines = _sines(freedoms, int(freedoms.max()) // FIELDS + 1, directions, loops)
    momenta = sines @ mass
    return np.asarray(momenta / np.sqrt(np.einsum("lij,ij->li", momenta, sines))[..., None])


def _decouple(stiffness: FloatArray, mass: FloatArray, fixed: BoolArray) -> None:
    """Decouple held freedoms, in place: each becomes a separate mode that overlaps with no loop."""
    lines, held = np.nonzero(fixed)
    for matrix in (stiffness, mass):
        diagonal = matrix[lines, held, held]
        matrix[lines, held, :] = 0.0
        matrix[lines, :, held] = 0.0
        matrix[lines, held, held] = diagonal


def _sines(freedoms: IntArray, nodes: int, directions: tuple[int, ...], loops: tuple[int, ...]) -> FloatArray:
    """Return sin(k pi s/L) in each direction on the freedoms: (labels, freedoms)."""
    node, field = np.divmod(freedoms, FIELDS)
    wave = np.sin(np.pi * np.outer(loops, node) / (nodes - 1))
    return np.concatenate([wave * (field == direction) for direction in directions])


def assign(score: FloatArray) -> IntArray:
    """Assign a different mode to each label by score, the highest remaining score first.

    score: (lines, labels, modes), not negative; returns (lines, labels).
    """
    lines, labels, modes = score.shape
    score = score.copy()
    chosen = np.empty((lines, labels), dtype=np.intp)
    row = np.arange(lines)
    for _ in range(labels):
        label, mode = np.divmod(score.reshape(lines, -1).argmax(axis=-1), modes)
        chosen[row, label] = mode
        score[row, label, :] = -1.0
        score[row, :, mode] = -1.0
    return chosen


def _normalized(shape: FloatArray, system: Matrices, arc_length: FloatArray) -> FloatArray:
    """Scale shapes (lines, loops, fields, nodes) so that (2/L) int f^2 ds = 1 for the last field."""
    values = at_points(system, shape[:, :, -1])
    square = np.einsum("lkep,lep->lk", values**2, system.weight)
    return np.asarray(shape / np.sqrt(2.0 / arc_length[:, None] * square)[..., None, None])
