"""Natural modes: the full finite element modes labelled by direction and loops, and the directional shapes.

Theory section 4. All problems are symmetric generalized eigenproblems, solved on stacks of lines.
"""

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.mechanics.finite_elements import FIELDS, THETA, Matrices, U, V, W

DIRECTIONS = (V, W, THETA)
TORSIONAL = 2  # of the three directions


@dataclass(frozen=True, slots=True)
class DirectionalShapes:
    """Shapes of each direction and number of loops, from separate eigenproblems in (U, V), in W and in Theta.

    loops: the numbers of loops, in the order of the second axis. nodal: (lines, loops, 4, nodes), rows f_u, f_v, f_w,
    f_theta; f_v, f_w and f_theta have (2/L) int f^2 ds = 1 and the sign of sin(k pi s/L).
    angular_frequency: (lines, loops, 3) of the three eigenproblems [rad/s], NaN where the stiffness is negative.
    """

    loops: tuple[int, ...]
    nodal: FloatArray
    angular_frequency: FloatArray


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
    nodes = system.stiffness.shape[-1] // FIELDS
    shapes = DirectionalShapes(
        loops,
        nodal=np.zeros((system.stiffness.shape[0], len(loops), FIELDS, nodes)),
        angular_frequency=np.empty((system.stiffness.shape[0], len(loops), 3)),
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
    shapes = replace(still, nodal=still.nodal.copy(), angular_frequency=still.angular_frequency.copy())
    _solve_direction(shapes, TORSIONAL, system, arc_length)
    return shapes


def _solve_direction(shapes: DirectionalShapes, direction: int, system: Matrices, arc_length: FloatArray) -> None:
    """Solve the eigenproblem of a direction, in place."""
    fields, nodes = ((U, V), (W,), (THETA,))[direction], shapes.nodal.shape[-1]
    freedoms = _freedoms(fields, nodes)
    vectors, values = _labelled(system, freedoms, (fields[-1],), shapes.loops)
    whole = np.zeros((*vectors.shape[:2], FIELDS * nodes))
    whole[..., freedoms] = vectors
    shape = whole.reshape(*vectors.shape[:2], nodes, FIELDS).swapaxes(-1, -2)[:, :, list(fields)]
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


def at_points(system: Matrices, nodal: FloatArray) -> FloatArray:
    """Interpolate nodal values (lines, ..., nodes) to the quadrature points: (lines, ..., elements, points)."""
    elements = system.weight.shape[1]
    first = 2 * np.arange(elements)[:, None] + np.arange(3)
    by_element = nodal[..., first]
    lines = nodal.shape[0]
    flat = by_element.reshape(lines, -1, elements, 3)
    values = np.einsum("lrea,lepa->lrep", flat, system.interpolation, optimize=True)
    return np.asarray(values.reshape(*nodal.shape[:-1], elements, system.weight.shape[2]))


def solve_symmetric(stiffness: FloatArray, mass: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Solve K x = lambda M x on stacks: eigenvalues (..., n) ascending and vectors (..., n, n) with X^T M X = 1."""
    inverse, standard = _standard(stiffness, mass)
    values, vectors = np.linalg.eigh(standard)
    return values, inverse.swapaxes(-1, -2) @ vectors


def _standard(stiffness: FloatArray, mass: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return L^-1 with M = L L^T, and L^-1 K L^-T, of which numpy reads the lower triangle: (..., n, n) each."""
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    return inverse, inverse @ stiffness @ inverse.swapaxes(-1, -2)


def _always_fixed(freedoms: int) -> BoolArray:
    held = np.zeros(freedoms, dtype=np.bool_)
    held[[V, W, THETA, V - FIELDS, W - FIELDS, THETA - FIELDS]] = True
    return held


def _freedoms(fields: tuple[int, ...], nodes: int) -> IntArray:
    every = np.arange(FIELDS * nodes)
    return every[np.isin(every % FIELDS, fields) & ~_always_fixed(FIELDS * nodes)]


def _labelled(
    system: Matrices, freedoms: IntArray, directions: tuple[int, ...], loops: tuple[int, ...]
) -> tuple[FloatArray, FloatArray]:
    """Solve the eigenproblem on some freedoms and pick one mode for each direction and number of loops.

    Returns vectors (lines, labels, freedoms) and eigenvalues (lines, labels), labels direction-major.
    """
    stiffness = system.stiffness[:, freedoms[:, None], freedoms]
    mass = system.mass[:, freedoms[:, None], freedoms]
    _decouple(stiffness, mass, system.fixed[:, freedoms])
    inverse, standard = _standard(stiffness, mass)
    values, vectors = np.linalg.eigh(standard)
    targets = _sines(freedoms, system.stiffness.shape[-1] // FIELDS, directions, loops)
    reach = targets @ mass
    norm = np.sqrt(np.einsum("lij,ij->li", reach, targets))
    overlap = (reach / norm[..., None]) @ inverse.swapaxes(-1, -2) @ vectors
    chosen = assign(overlap**2)
    sign = np.sign(np.take_along_axis(overlap, chosen[..., None], axis=-1))
    selected = np.take_along_axis(vectors.swapaxes(-1, -2), chosen[..., None], axis=1)
    return (selected * sign) @ inverse, np.take_along_axis(values, chosen, axis=-1)


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
