"""A bundle as chains of bars, one for each sub-conductor, with common V, W and Theta at every joint.

It shares no elements, shapes or bundle sums with the engine. Every sub-conductor moves along the span by itself, and
with its inertia. Besides small vibrations it gives the energy and the tensions of large motion, with the exact lengths
of all bars.
"""

import math
from dataclasses import dataclass

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


@dataclass(frozen=True, slots=True)
class Stretched:
    """A chain that large motion has stretched.

    energy: of all bars and end springs beyond the work of the dead load that balances them at rest [J]; tension: (n,),
    mean over the bars of each sub-conductor of what its horizontal component has gained [N].
    """

    energy: float
    tension: FloatArray


def stretched(
    line: Line,
    end_stiffness: tuple[float, float],
    motion: FloatArray,
    tied: str,
    twist: FloatArray | None = None,
) -> Stretched:
    """Move a bundle across the line, while its joints find their places along the line by least energy.

    Parameters
    ----------
    line, end_stiffness, tied
        As in `torsional_frequency`.
    motion : (joints, 3)
        V, W [m] and Theta [rad] of joints at equal arc lengths.
    twist : (joints,), optional
        Angle by which the cross-sections are turned at rest [rad].

    Raises
    ------
    RuntimeError
        If Newton's method does not settle.
    """
    assert line.span.horizontal_tension is not None
    bars, n = len(motion) - 1, len(line.bundle.positions)
    rest = np.diff(_joints(line, line.span.horizontal_tension, bars), axis=0)
    rest = np.append(rest, np.zeros((bars, 1)), axis=1)[:, None]  # (bars, 1, 3)
    across = np.diff(_displacements(line, motion, np.zeros(bars + 1) if twist is None else twist), axis=0)
    free = _free_motions(bars, n, end_stiffness, tied).reshape(bars + 1, n + 3, -1)[:, :n]
    free = free[..., np.abs(free).max(axis=(0, 1)) > 0.0]
    pull = np.diff(free, axis=0)
    springs = np.where(np.isinf(end_stiffness), 0.0, end_stiffness)
    held = np.einsum("e,enx,eny->xy", springs, free[[0, -1]], free[[0, -1]])
    places = np.zeros(free.shape[-1])
    for _ in range(30):
        bar = _bars(line, rest, across + np.stack([pull @ places, *np.zeros((2, bars, n))], axis=-1))
        gradient = np.einsum("bn,bnx->x", bar.gained, pull) + held @ places
        hessian = np.einsum("bn,bnx,bny->xy", bar.stiffness, pull, pull, optimize=True) + held
        step = np.linalg.lstsq(hessian, gradient, rcond=1e-13)[0]
        places = places - step
        if np.abs(step).max() < 1e-13 * line.span.length:
            return Stretched(bar.energy + 0.5 * float(places @ held @ places), bar.gained.mean(axis=0))
    raise RuntimeError("the joints found no places along the line")


def _displacements(line: Line, motion: FloatArray, twist: FloatArray) -> FloatArray:
    """Return the displacements across the line of sub-conductors by V, W and Theta, eq. (3): (joints, n, 3)."""
    n, moved = len(line.bundle.positions), []
    for row, angle in zip(motion, twist.tolist(), strict=True):
        c, s = math.cos(angle), math.sin(angle)
        moves = [_moves(i, n, c * y - s * z, s * y + c * z) for i, (y, z) in enumerate(line.bundle.positions)]
        moved.append([move[:, n:] @ row for move in moves])
    return np.array(moved)


@dataclass(frozen=True, slots=True)
class _Bars:
    """Energy [J], gain in horizontal tension and its derivative by the bar's horizontal extent, both (bars, n)."""

    energy: float
    gained: FloatArray
    stiffness: FloatArray


def _bars(line: Line, rest: FloatArray, change: FloatArray) -> _Bars:
    """Stretch bars with vectors at rest (bars, 1, 3) by changes of these (bars, n, 3)."""
    length = np.linalg.norm(rest, axis=-1)
    tension = (line.span.horizontal_tension or math.nan) * length / rest[..., 0]
    work = (rest * change).sum(axis=-1)
    now = rest + change
    longer = np.linalg.norm(now, axis=-1)
    stretch = (2.0 * work + (change**2).sum(axis=-1)) / (longer + length)
    rigidity = line.conductor.axial_rigidity / length
    force = tension + rigidity * stretch
    energy = tension * (stretch - work / length) + 0.5 * rigidity * stretch**2
    cosine = now[..., 0] / longer
    return _Bars(
        float(energy.sum()),
        force * cosine - tension * rest[..., 0] / length,
        rigidity * cosine**2 + force / longer * (1.0 - cosine**2),
    )


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
