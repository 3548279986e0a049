"""Static twist under the mean moment of the wind, wind speed by wind speed. Theory section 14.

It is not unique: single conductors have several stable angles. The one that a rising wind finds is followed from still
air, past folds; further ones are searched from many starts.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, filled
from engine.mechanics.torsional_elements import TorsionalElements, energy_derivatives, is_convex
from engine.numerics.newton import NewtonOptions, downhill, newton
from engine.outcome import Outcome

OPTIONS = NewtonOptions(tolerance=1e-10, largest_step=0.25, iterations=100)
STEP = 1.0  # m/s between two wind speeds on the way up from still air
LARGEST_CHANGE = 0.1  # rad in one step; a larger change is followed in smaller steps
SMALLEST_STEP = 1e-3  # m/s; a larger change within it is a jump past a fold
SEARCHED = 0.25 * np.pi * np.array([-8, -7, -6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, 7, 8])  # rad at mid-span
SAME = 1e-3  # rad: a smaller difference is none


@dataclass(frozen=True, slots=True)
class WindTwist:
    """Static twist at rising wind speeds, followed from still air, and further stable equilibria.

    angle: (lines, winds, nodes) [rad], NaN where none was found; outcome: (lines, winds) of Outcome; fold_line,
    fold_wind_speed: (folds,), line and wind speed at which the state ends and the line turns over to another one [m/s];
    further_line, further_wind: (k,), line and wind speed index of each further equilibrium; further_angle: (k, nodes).
    """

    angle: FloatArray
    outcome: ObjectArray
    fold_line: IntArray
    fold_wind_speed: FloatArray
    further_line: IntArray
    further_wind: IntArray
    further_angle: FloatArray


def wind_twist(
    elements: TorsionalElements, wind_speeds: FloatArray, asked: BoolArray, *, further: bool = True
) -> WindTwist:
    """Follow the twist from still air through rising wind speeds, and search for further equilibria.

    Where the state ends in a fold, the line turns over to the equilibrium downhill from there, which is followed on.

    Parameters
    ----------
    elements : TorsionalElements
    wind_speeds : (winds,)
        In rising order [m/s].
    asked : (lines,)
        Which lines are followed.
    further : bool
        Whether further equilibria are searched.

    Returns
    -------
    WindTwist
    """
    lines, nodes, _ = elements.stiffness.shape
    angle = np.full((lines, wind_speeds.size, nodes), np.nan)
    outcome = filled(lines * wind_speeds.size, Outcome.NO_CONVERGENCE).reshape(lines, wind_speeds.size)
    state, speed = np.zeros((lines, nodes)), 0.0
    folds: list[tuple[int, float]] = []
    hangs = np.linalg.eigvalsh(elements.stiffness[:, 1:-1, 1:-1])[:, 0] > 0.0
    outcome[~hangs] = Outcome.STATICALLY_UNSTABLE
    known = np.flatnonzero(hangs & asked)
    for i, wind in enumerate(wind_speeds.tolist()):
        steps = max(1, int(np.ceil((wind - speed) / STEP)))
        for before, after in pairwise(np.linspace(speed, wind, steps + 1).tolist()):
            state[known], found, jumps = _stepped(elements, known, state[known], (before, after))
            known, folds = known[found], folds + jumps
        speed = wind
        angle[known, i], outcome[known, i] = state[known], Outcome.CONVERGED
    line, fold_speed = np.array(folds, dtype=np.float64).reshape(-1, 2).T
    winds = enumerate(wind_speeds.tolist()) if further else ()
    others = [_further_equilibria(elements, wind, angle[:, i]) for i, wind in winds]
    return WindTwist(
        angle=angle,
        outcome=outcome,
        fold_line=line.astype(np.intp),
        fold_wind_speed=fold_speed,
        further_line=np.concatenate([np.zeros(0, dtype=np.intp), *(owner for owner, _ in others)]),
        further_wind=np.repeat(np.arange(len(others)), [owner.size for owner, _ in others]),
        further_angle=np.concatenate([np.zeros((0, nodes)), *(state for _, state in others)]),
    )


def _further_equilibria(
    elements: TorsionalElements, wind_speed: float, known: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Search for stable equilibria besides the known ones (lines, nodes), from starts up to a full turn either way.

    Lines whose energy is convex have no other one, and lines without a known one are not searched.

    Returns
    -------
    (k,), (k, nodes)
        Line and twist of each equilibrium [rad].
    """
    lines = np.flatnonzero(np.isfinite(known).all(axis=-1) & ~is_convex(elements, wind_speed))
    nodes = elements.stiffness.shape[-1]
    line = np.repeat(lines, SEARCHED.size)
    start = np.tile(SEARCHED, lines.size)[:, None] * np.sin(np.pi * np.linspace(0.0, 1.0, nodes))
    state, found = equilibria(elements, line, np.full(line.size, wind_speed), start)
    kept: list[int] = []
    for i in np.flatnonzero(found).tolist():
        seen = [known[line[i]], *(state[j] for j in kept if line[j] == line[i])]
        if all(np.abs(state[i] - other).max() > SAME for other in seen):
            kept.append(i)
    return line[kept], state[kept]


def equilibria(
    elements: TorsionalElements, line: IntArray, wind_speed: FloatArray, start: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Go downhill in energy from starts (k, nodes) of lines (k,) at wind speeds (k,) to stable equilibria.

    Returns
    -------
    (k, nodes), (k,)
        Twist [rad], and whether a stable equilibrium was found.
    """
    inner = np.s_[..., 1:-1]

    def system(x: FloatArray, active: IntArray) -> tuple[FloatArray, FloatArray]:
        gradient, tangent = energy_derivatives(elements, line[active], wind_speed[active], np.pad(x, ((0, 0), (1, 1))))
        return gradient[inner], downhill(tangent[..., 1:-1, 1:-1])

    solution = newton(system, start[inner], np.ones_like(start[inner]), OPTIONS)
    state = np.pad(solution.x, ((0, 0), (1, 1)))
    _, tangent = energy_derivatives(elements, line, wind_speed, state)
    return state, solution.converged & (np.linalg.eigvalsh(tangent[..., 1:-1, 1:-1])[..., 0] > 0.0)


def _stepped(
    elements: TorsionalElements, lines: IntArray, state: FloatArray, winds: tuple[float, float]
) -> tuple[FloatArray, BoolArray, list[tuple[int, float]]]:
    """Follow lines (k,) from one wind speed to the next; return states, whether they were found, and folds passed."""
    moved, found = equilibria(elements, lines, np.full(lines.size, winds[1]), state)
    folds: list[tuple[int, float]] = []
    for i in np.flatnonzero(~(np.abs(moved - state).max(axis=-1) <= LARGEST_CHANGE)).tolist():
        moved[i], found[i], own = _followed_alone(elements, int(lines[i]), state[i], winds)
        folds += [(int(lines[i]), speed) for speed in own]
    return moved, found, folds


def _followed_alone(
    elements: TorsionalElements, line: int, state: FloatArray, winds: tuple[float, float]
) -> tuple[FloatArray, bool, list[float]]:
    """Follow one line in steps as small as its changes need; a change within the smallest step is a jump."""
    speed, last = winds
    step, found, jumps = 0.5 * (last - speed), True, []
    while speed < last:
        step = min(step, last - speed)
        moved, stable = equilibria(elements, np.array([line]), np.array([speed + step]), state[None])
        change = np.abs(moved[0] - state).max()
        if change > LARGEST_CHANGE and step > SMALLEST_STEP:
            step *= 0.5
            continue
        if change > LARGEST_CHANGE:
            jumps.append(speed + step)
        state, found, speed = moved[0], bool(stable[0]), speed + step
        if not found:
            break
        step *= 2.0
    return state, found, jumps
