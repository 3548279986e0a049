"""Critical wind speeds of lines whose static state changes with the wind: a scan and a search for roots.

Theory sections 6 and 14. A(U) = A_0 + U A_1 + U^2 A_2 at each wind speed of a grid is that about the static state
there; between them the three matrices are interpolated linearly, so a state that does not move leaves no error.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.kernels.eigenvalues import eigenvalues
from engine.mechanics.modes import TORSIONAL, DirectionalShapes
from engine.mechanics.wind_twist import WindTwist
from engine.models.critical_wind_speeds import Crossings, StateMatrices, at_wind, state_matrices, unstable_pairs
from engine.models.discretization import (
    Discretization,
    blocks_of_winds,
    shapes_in_wind,
    states_in_wind,
    with_wind_twist,
)
from engine.models.reduced_model import ReducedModel

STEPS = 30  # of the grid up to the limit
CELLS = 8  # parts of a step of the grid that are searched for changes of stability
HALVINGS = 40
STATIC = 1e-9  # imaginary part over the largest eigenvalue, below which a growing motion does not oscillate


@dataclass(frozen=True, slots=True)
class Scan:
    """Static states of lines at the wind speeds of a grid.

    wind_speeds: (winds,), in rising order [m/s]; states: the discretizations about each, of several wind speeds in one
    stack, wind-major, with the shapes of their directions; twist: as they were followed.
    """

    wind_speeds: FloatArray
    states: tuple[tuple[Discretization, DirectionalShapes], ...]
    twist: WindTwist


ModelOf = Callable[[Discretization, DirectionalShapes, IntArray], ReducedModel]
"""Makes the models about static states; lines (members,) are the indices of the lines of its members there."""


def scan_of(discretization: Discretization, limit: float, still: DirectionalShapes) -> Scan:
    """Follow the static state from still air to a wind speed [m/s], in steps of a thirtieth of it.

    still: the shapes in still air, of all numbers of loops that the models need.
    """
    winds = np.linspace(0.0, limit, STEPS + 1)[1:]
    followed = with_wind_twist(discretization, winds, further=False)
    assert followed.wind_twist is not None, "it was followed above"
    blocks = (states_in_wind(followed, block) for block in blocks_of_winds(len(discretization.lines), winds.size))
    states = tuple((block, shapes_in_wind(block, still)) for block in blocks)
    return Scan(winds, states, followed.wind_twist)


def crossings_in_wind(scan: Scan, line: IntArray, model_of: ModelOf) -> Crossings:
    """Return the critical wind speeds of models whose static state follows the wind, folds of that state among them.

    Parameters
    ----------
    scan : Scan
    line : (members,)
        Index of the line of each model.
    model_of : callable
        Makes the models of members, one wind speed after another.

    Returns
    -------
    Crossings
        Sorted by member and wind speed.
    """
    matrices, unstable, torsional = _scanned_models(scan, line, model_of)
    found = scanned_crossings(scan.wind_speeds, matrices)
    known = np.asarray(~unstable.any(axis=0))
    member, fold = np.nonzero(line[:, None] == scan.twist.fold_line)
    folds = Crossings(
        member=member,
        wind_speed=scan.twist.fold_wind_speed[fold],
        angular_frequency=np.zeros(member.size),
        onset=np.ones(member.size, dtype=np.bool_),
        oscillation=np.zeros(member.size, dtype=np.bool_),
        coordinate=np.full(member.size, torsional),
        unstable_after=np.ones(member.size, dtype=np.intp),
    )
    parts = {field.name: np.concatenate([getattr(x, field.name) for x in (found, folds)]) for field in fields(found)}
    order = np.lexsort((parts["wind_speed"], parts["member"]))
    order = order[known[parts["member"][order]]]
    return Crossings(**{name: values[order] for name, values in parts.items()})


def _scanned_models(scan: Scan, line: IntArray, model_of: ModelOf) -> tuple[StateMatrices, BoolArray, int]:
    """Return state matrices (winds, members, 2 m, 2 m), which are statically unstable, and the torsional coordinate."""
    lines = int(scan.twist.angle.shape[0])
    matrices, unstable, torsional = [], [], 0
    for block, shapes in scan.states:
        winds = len(block.lines) // lines
        model = model_of(block, shapes, (lines * np.arange(winds)[:, None] + line).ravel())
        own, shape = state_matrices(model), (winds, line.size)
        matrices.append([part.reshape(*shape, *part.shape[1:]) for part in (own.constant, own.linear, own.quadratic)])
        unstable.append(model.statically_unstable.reshape(shape))
        torsional = int(np.flatnonzero(model.direction == TORSIONAL)[0])
    joined = (np.concatenate(parts) for parts in zip(*matrices, strict=True))
    return StateMatrices(*joined), np.concatenate(unstable), torsional


def scanned_crossings(wind_speeds: FloatArray, states: StateMatrices) -> Crossings:
    """Return the crossings of the imaginary axis between the wind speeds of a grid.

    Parameters
    ----------
    wind_speeds : (winds,)
        In rising order [m/s].
    states : StateMatrices
        About the static state at each wind speed, (winds, members, 2 m, 2 m).

    Returns
    -------
    Crossings
    """
    speeds = np.interp(
        np.linspace(0.0, wind_speeds.size - 1.0, (wind_speeds.size - 1) * CELLS + 1),
        np.arange(wind_speeds.size),
        wind_speeds,
    )
    members = states.constant.shape[1]
    every = np.repeat(np.arange(members), speeds.size)
    counts = unstable_pairs(eigenvalues(_at(wind_speeds, states, every, np.tile(speeds, members))))
    counts = counts.reshape(members, speeds.size)
    member, cell = np.nonzero(counts[:, 1:] != counts[:, :-1])
    low, high, before = speeds[cell], speeds[cell + 1], counts[member, cell]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = unstable_pairs(eigenvalues(_at(wind_speeds, states, member, middle))) == before
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    found = _described(_at(wind_speeds, states, member, high), member, high)
    after = counts[member, cell + 1]
    return replace(found, onset=after > before, unstable_after=after)


def _at(wind_speeds: FloatArray, states: StateMatrices, member: IntArray, speed: FloatArray) -> FloatArray:
    """Return A(U) of members (k,) at wind speeds (k,) within the grid: (k, 2 m, 2 m)."""
    left = np.clip(np.searchsorted(wind_speeds, speed, side="right") - 1, 0, wind_speeds.size - 2)
    share = ((speed - wind_speeds[left]) / (wind_speeds[left + 1] - wind_speeds[left]))[:, None, None]

    def between(stack: FloatArray) -> FloatArray:
        return np.asarray((1.0 - share) * stack[left, member] + share * stack[left + 1, member])

    parts = (states.constant, states.linear, states.quadratic)
    return at_wind(StateMatrices(*(between(stack) for stack in parts)), speed)


def _described(matrices: FloatArray, member: IntArray, wind_speed: FloatArray) -> Crossings:
    """Return crossings, described by the state matrices (k, 2 m, 2 m) there: how they move, not what they begin."""
    m = matrices.shape[-1] // 2
    values, vectors = np.linalg.eig(matrices.astype(np.complex128))
    size = np.abs(values).max(axis=-1, initial=0.0)
    nearest = np.where(values.imag >= 0.0, np.abs(values.real), np.inf).argmin(axis=-1)
    row = np.arange(member.size)
    frequency = values.imag[row, nearest]
    oscillation = frequency > STATIC * size
    return Crossings(
        member=member,
        wind_speed=wind_speed,
        angular_frequency=np.where(oscillation, frequency, 0.0),
        onset=np.zeros(member.size, dtype=np.bool_),
        oscillation=oscillation,
        coordinate=np.abs(vectors[row, :m, nearest]).argmax(axis=-1),
        unstable_after=np.zeros(member.size, dtype=np.intp),
    )
