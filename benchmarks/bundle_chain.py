"""A bundle as chains of bars, one for each sub-conductor, with common V, W and Theta at every joint.

It shares no elements, shapes or bundle sums with the engine. Every sub-conductor moves along the span by itself, and
with its inertia.
"""

import math

import numpy as np
from scipy.linalg import eigh, null_space

from engine.arrays import FloatArray
from engine.spec import GRAVITY, Line


def torsional_frequency(
    line: Line, end_stiffness: tuple[float, float], loops: int, tied: str, bars: int = 100
) -> float:
    """Return the frequency [Hz] of the mode whose Theta is nearest to sin(loops pi s/L).

    Parameters
    ----------
    line : Line
        Without devices, blow-out and partial ice; its tension is given.
    end_stiffness : pair of floats
        Of each sub-conductor along the span [N/m], infinite at a dead end, about which a yoke may turn.
    loops : int
    tied : str
        Where sub-conductors move along the span together: `everywhere`, as in a rigid section, `at ends`, as between
        held yokes, or `nowhere`.
    bars : int
        Of each sub-conductor.
    """
    assert line.span.horizontal_tension is not None
    joints, n = _joints(line, line.span.horizontal_tension, bars), len(line.bundle.positions)
    stiffness, mass = _matrices(line, line.span.horizontal_tension, joints)
    for end, spring in zip((0, bars), end_stiffness, strict=True):
        if math.isfinite(spring):
            stiffness[end, range(n), end, range(n)] += spring
    free = _free_motions(bars, n, end_stiffness, tied)
    size = (bars + 1) * (n + 3)
    stiffness, mass = (free.T @ matrix.reshape(size, size) @ free for matrix in (stiffness, mass))
    twist = np.zeros((bars + 1, n + 3))
    twist[:, -1] = np.sin(loops * math.pi * np.linspace(0.0, 1.0, bars + 1))
    values, vectors = eigh(stiffness, mass, subset_by_index=[0, 12 * loops])
    overlap = np.abs(twist.ravel() @ free @ mass @ vectors)
    return math.sqrt(values[int(overlap.argmax())]) / (2.0 * math.pi)


def _joints(line: Line, tension: float, bars: int) -> FloatArray:
    """Return the joints on the catenary at equal arc lengths: (joints, 2), x and y [m]."""
    c = tension / (line.conductor.mass * GRAVITY)
    half = math.sinh(0.5 * line.span.length / c)
    x = c * np.arcsinh(np.linspace(-half, half, bars + 1))
    return np.stack([x, c * np.cosh(x / c)], axis=1)


def _matrices(line: Line, horizontal: float, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return K and M, (joints, n + 3, joints, n + 3): U_1 to U_n, V, W and Theta of each joint."""
    conductor, count, n = line.conductor, len(joints), len(line.bundle.positions)
    stiffness, mass = np.zeros((2, count, n + 3, count, n + 3))
    moves = [_moves(i, n, y, z) for i, (y, z) in enumerate(line.bundle.positions)]
    e_y, e_z = line.ice.eccentricity_y or 0.0, line.ice.eccentricity_z or 0.0
    iced = [_moves(i, n, y + e_y, z + e_z) for i, (y, z) in enumerate(line.bundle.positions)]
    own = np.zeros(n + 3)
    own[-1] = 1.0
    for left, right in ((j, j + 1) for j in range(count - 1)):
        along = np.append(joints[right] - joints[left], 0.0)
        length = float(np.linalg.norm(along))
        tension = horizontal * length / along[0]
        pull = np.outer(along, along) / length**2
        bar = (conductor.axial_rigidity * pull + tension * (np.eye(3) - pull)) / length
        block = sum(move.T @ bar @ move for move in moves)
        block = block + n * conductor.torsional_rigidity / length * np.outer(own, own)
        share = 0.5 * length * conductor.mass * sum(move.T @ move for move in iced)
        inertia = n * (conductor.polar_inertia - conductor.mass * (e_y**2 + e_z**2))
        share = share + 0.5 * length * inertia * np.outer(own, own)
        for j, other in ((left, right), (right, left)):
            stiffness[j, :, j] += block - 0.5 * length * n * conductor.mass * GRAVITY * e_y * np.outer(own, own)
            stiffness[j, :, other] -= block
            mass[j, :, j] += share
    return stiffness, mass


def _moves(i: int, n: int, y: float, z: float) -> FloatArray:
    """Return the motion of a point at (y, z) of sub-conductor i by U_1 to U_n, V, W and Theta, eq. (3): (3, n + 3)."""
    moves = np.zeros((3, n + 3))
    moves[0, i] = moves[1, n] = moves[2, n + 1] = 1.0
    moves[1, n + 2], moves[2, n + 2] = -z, y
    return moves


def _free_motions(bars: int, n: int, end_stiffness: tuple[float, float], tied: str) -> FloatArray:
    """Return the motions that supports and ties leave: ((bars + 1) (n + 3), motions)."""
    motions = []
    for joint in range(bars + 1):
        at_end = joint in {0, bars}
        fixed = at_end and math.isinf(end_stiffness[joint > 0])
        common = np.zeros((0, n)) if fixed else np.ones((1, n))
        together = tied == "everywhere" or (tied == "at ends" and at_end)
        own = np.zeros((0, n)) if together else null_space(np.ones((1, n))).T
        motions += [(joint, np.append(along, np.zeros(3))) for along in (*common, *own)]
        if not at_end:
            motions += [(joint, row) for row in np.eye(n + 3)[n:]]
    free = np.zeros((bars + 1, n + 3, len(motions)))
    for column, (joint, row) in enumerate(motions):
        free[joint, :, column] = row
    return free.reshape(-1, len(motions))
