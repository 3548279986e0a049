"""Natural modes: the full finite element modes labelled by direction and loops, and the directional shapes.

Theory section 4. All problems are symmetric generalized eigenproblems, solved on stacks of lines.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.mechanics.finite_elements import FIELDS, THETA, Matrices, U, V, W
from engine.numerics.eigenproblems import standard_form

DIRECTIONS = (V, W, THETA)
TORSIONAL = 2  # of the three directions
FIELDS_OF = ((U, V), (W,), (THETA,))  # of the eigenproblem of each direction


@dataclass(frozen=True, slots=True)
class DirectionModes:
    """All modes of the eigenproblem of a direction on its `moving_freedoms`, ascending.

    vectors: (lines, modes, freedoms), orthonormal in M; squares: (lines, modes), eigenvalues [rad^2/s^2].
    """

    vectors: FloatArray
    squares: FloatArray


@dataclass(frozen=True, slots=True)
class DirectionalShapes:
    """Shapes of each direction and number of loops, from separate eigenproblems in (U, V), in W and in Theta.

    loops: the numbers of loops, in the order of the second axis. nodal: (lines, loops, 4, nodes), rows f_u, f_v, f_w,
    f_theta; f_v, f_w and f_theta have (2/L) int f^2 ds = 1 and the sign of sin(k pi s/L).
    angular_frequency: (lines, loops, 3) of the three eigenproblems [rad/s], NaN where the stiffness is negative.
    modes: of each eigenproblem, whatever their loops.
    """

    loops: tuple[int, ...]
    nodal: FloatArray
    angular_frequency: FloatArray
    modes: tuple[DirectionModes, ...]


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
    nodal = np.zeros((lines, len(loops), FIELDS, freedoms // FIELDS))
    frequency = np.empty((lines, len(loops), len(DIRECTIONS)))
    modes = [_solve_direction(i, loops, nodal, frequency, system, arc_length) for i in range(len(DIRECTIONS))]
    return DirectionalShapes(loops, nodal, frequency, tuple(modes))


def turned_shapes(still: DirectionalShapes, system: Matrices, arc_length: FloatArray) -> DirectionalShapes:
    """Return the shapes about a state of another static twist, which changes stiffness and mass of Theta alone.

    Parameters
    ----------
    still : DirectionalShapes
        Of the same lines at any twist.
    system, arc_length : Matrices, (lines,)
        As for `directional_shapes`, at the new twist.
    """
    nodal, frequency = still.nodal.copy(), still.angular_frequency.copy()
    torsional = _solve_direction(TORSIONAL, still.loops, nodal, frequency, system, arc_length)
    return DirectionalShapes(still.loops, nodal, frequency, (*still.modes[:TORSIONAL], torsional))


def _solve_direction(
    direction: int,
    loops: tuple[int, ...],
    nodal: FloatArray,
    frequency: FloatArray,
    system: Matrices,
    arc_length: FloatArray,
) -> DirectionModes:
    """Solve the eigenproblem of a direction and enter its shapes and frequencies, in place."""
    fields, nodes = FIELDS_OF[direction], nodal.shape[-1]
    freedoms = moving_freedoms(fields, nodes)
    vectors, values, modes, inverse = _labelled(system, freedoms, (fields[-1],), loops)
    whole = np.zeros((*vectors.shape[:2], FIELDS * nodes))
    whole[..., freedoms] = vectors
    shape = whole.reshape(-1, len(loops), nodes, FIELDS).swapaxes(-1, -2)[:, :, list(fields)]
    nodal[:, :, list(fields)] = _normalized(shape, system, arc_length)
    frequency[:, :, direction] = np.sqrt(np.where(values > 0.0, values, np.nan))
    return DirectionModes(modes.vectors @ inverse, modes.squares)


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
    vectors, values, *_ = _labelled(system, freedoms, DIRECTIONS, loops)
    whole = np.zeros((*vectors.shape[:2], system.stiffness.shape[-1]))
    whole[..., freedoms] = vectors
    shape = (values.shape[0], len(DIRECTIONS), len(loops))
    return FullModes(loops, whole.reshape(*shape, -1), values.reshape(shape))


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


def moving_freedoms(fields: tuple[int, ...], nodes: int) -> IntArray:
    """Return the freedoms of some fields of which none is held in every line, ascending."""
    every = np.arange(FIELDS * nodes)
    return every[np.isin(every % FIELDS, fields) & ~_always_fixed(FIELDS * nodes)]


def _labelled(
    system: Matrices, freedoms: IntArray, directions: tuple[int, ...], loops: tuple[int, ...]
) -> tuple[FloatArray, FloatArray, DirectionModes, FloatArray]:
    """Solve the eigenproblem on some freedoms and pick one mode for each direction and number of loops.

    Returns vectors (lines, labels, freedoms), direction-major, and eigenvalues (lines, labels); then all modes, with
    vectors of unit mass, and the matrix that turns these to freedoms.
    """
    stiffness, mass = _on_freedoms(system, freedoms)
    inverse, standard = standard_form(stiffness, mass)
    values, vectors = np.linalg.eigh(standard)
    overlap = _momenta_of_sines(mass, freedoms, directions, loops) @ inverse.swapaxes(-1, -2) @ vectors
    chosen = assign(overlap**2)
    sign = np.sign(np.take_along_axis(overlap, chosen[..., None], axis=-1))
    modes = vectors.swapaxes(-1, -2)
    selected = sign * np.take_along_axis(modes, chosen[..., None], axis=1)
    picked = np.take_along_axis(values, chosen, axis=-1)
    return selected @ inverse, picked, DirectionModes(modes, values), inverse


def _on_freedoms(system: Matrices, freedoms: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and mass on some freedoms (lines, freedoms, freedoms), those that are held decoupled."""
    stiffness, mass = (matrix[:, freedoms[:, None], freedoms] for matrix in (system.stiffness, system.mass))
    _decouple(stiffness, mass, system.fixed[:, freedoms])
    return stiffness, mass


def _momenta_of_sines(
    mass: FloatArray, freedoms: IntArray, directions: tuple[int, ...], loops: tuple[int, ...]
) -> FloatArray:
    """Return M x of the sines of each label, x^T M x = 1: (lines, labels, freedoms)."""
    sines = waves(freedoms, int(freedoms.max()) // FIELDS + 1, directions, loops)
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


def waves(freedoms: IntArray, nodes: int, directions: tuple[int, ...], loops: tuple[int, ...]) -> FloatArray:
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
