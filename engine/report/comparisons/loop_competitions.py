"""The table of loop competitions: which cycles survive motions of other numbers of loops. Theory section 7.3.

A cycle of one number of loops that is stable by itself is solved again in the model in which the other loops may move
as well. Its Floquet multipliers there show whether small disturbances of the other loops grow.
"""

from collections.abc import Sequence

import numpy as np

from engine.arrays import ComplexArray, FloatArray, IntArray
from engine.cycles.floquet import monodromy, stability_verdicts
from engine.cycles.harmonic_balance import Orbits, balance, half_peak_to_peak, oscillation_size, states
from engine.models.discretization import Discretization
from engine.models.reduced_model import ReducedModel
from engine.outcome import Outcome, Stability
from engine.report.findings import ModelFindings, cycle_coordinates
from engine.report.observers.widest_places import widest_places
from engine.result import LoopCompetitionRow

STEP_FACTOR = 2  # on the number of steps of the Floquet integration, since multipliers near 1 decide
PHASES = 2.0 * np.pi * np.arange(24) / 24  # at which the widest place is sought
SAME_SIZE = 2.0  # ratio of sizes beyond which the solution is another motion than the cycle


def loop_competitions(
    discretization: Discretization, joint: ReducedModel, hybrid: ModelFindings, loops: Sequence[int]
) -> list[list[LoopCompetitionRow]]:
    """Return a row for every stable cycle of the hybrid model among the other loops, one list per line.

    Parameters
    ----------
    discretization : Discretization
    joint : ReducedModel
        The model in which these loops move together, leading axis (lines,).
    hybrid : ModelFindings
        Of the hybrid model, each number of loops by itself.
    loops : sequence of int

    Returns
    -------
    list of lists of LoopCompetitionRow
    """
    rows: list[list[LoopCompetitionRow]] = [[] for _ in discretization.lines]
    cycles = hybrid.cycles
    usable = ~joint.statically_unstable[hybrid.line[cycles.member]]
    stable_alone = np.flatnonzero((cycles.floquet.stability == Stability.STABLE) & usable)
    if len(loops) < 2 or stable_alone.size == 0:
        return rows
    member = cycles.member[stable_alone]
    line, column = hybrid.line[member], np.searchsorted(np.sort(loops), hybrid.loops[member, 0])
    column = np.argsort(loops)[column]
    start = _embedded(cycles.orbits, stable_alone, column, joint.mass.shape[-1])
    orbits, solution = balance(joint, line, start)
    ratio = oscillation_size(joint, line, orbits) / oscillation_size(joint, line, start)
    same_cycle = solution.converged & (ratio < SAME_SIZE) & (ratio > 1.0 / SAME_SIZE)
    multiplier, vector, error = _leading(monodromy(joint, line, orbits, STEP_FACTOR))
    verdict = stability_verdicts(np.abs(multiplier), error)
    energy = _energy_by_loops(joint, line, vector, len(loops))
    moving = cycle_coordinates(hybrid)[stable_alone] * len(loops) + column
    amplitudes = _amplitudes(joint, line, orbits, moving, np.array(loops)[column]).tolist()
    for i, cycle in enumerate(stable_alone.tolist()):
        own = int(loops[column[i]])
        vertical, horizontal, torsional = amplitudes[i]
        decided = bool(same_cycle[i]) and verdict[i] is not Stability.UNKNOWN
        rows[line[i]].append(
            LoopCompetitionRow(
                loops=own,
                wind_speed_m_per_s=float(cycles.orbits.wind_speed[cycle]),
                branch=int(cycles.branch[cycle]),
                stability=verdict[i] if same_cycle[i] else Stability.UNKNOWN,
                growing_loops=int(loops[int(energy[i].argmax())]) if decided else None,
                growth_per_cycle=float(np.abs(multiplier[i])) if decided else None,
                vertical_m=vertical if same_cycle[i] else None,
                horizontal_m=horizontal if same_cycle[i] else None,
                torsional_rad=torsional if same_cycle[i] else None,
                outcome=Outcome.CONVERGED if same_cycle[i] else Outcome.NO_CONVERGENCE,
            )
        )
    return rows


def _amplitudes(joint: ReducedModel, line: IntArray, orbits: Orbits, moving: IntArray, loops: IntArray) -> FloatArray:
    """Return the amplitudes of motions where each is widest: (k, 3) [m, m, rad].

    line, moving, loops: (k,), the line of each, its coordinate that moves most and the loops of that one.
    """
    seen = widest_places(
        joint.shapes[line],
        joint.direction[moving],
        loops,
        moving,
        states(orbits, PHASES)[..., : joint.mass.shape[-1]],
    )
    return half_peak_to_peak(seen.shapes.swapaxes(-1, -2) @ orbits.coefficients)


def _embedded(orbits: Orbits, selected: IntArray, column: IntArray, coordinates: int) -> Orbits:
    """Express cycles of one number of loops in the coordinates of all, the others at rest.

    A relief coordinate, the last one, goes to that of the joint model if there is one.
    """
    own = orbits.coefficients[selected]
    count = coordinates // 3
    coefficients = np.zeros((selected.size, 3, count, own.shape[-1]))
    coefficients[np.arange(selected.size), :, column] = own[:, :3]
    flat = coefficients.reshape(selected.size, 3 * count, -1)
    relief = own[:, 3 : 3 + coordinates - 3 * count]
    flat = np.concatenate([flat, relief], axis=1)
    return Orbits(flat, orbits.angular_frequency[selected], orbits.wind_speed[selected])


def _leading(matrices: FloatArray) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """Return the largest nontrivial multiplier, its eigenvector, and the error of the trivial multiplier."""
    cycles, size, _ = matrices.shape
    multiplier = np.full(cycles, np.nan, dtype=np.complex128)
    vector = np.zeros((cycles, size), dtype=np.complex128)
    error = np.full(cycles, np.nan)
    known = np.flatnonzero(np.isfinite(matrices).all(axis=(-1, -2)))
    values, vectors = np.linalg.eig(matrices[known])
    row = np.arange(known.size)
    trivial = np.abs(values - 1.0).argmin(axis=-1)
    error[known] = np.abs(values[row, trivial] - 1.0)
    modulus = np.abs(values)
    modulus[row, trivial] = -1.0
    largest = modulus.argmax(axis=-1)
    multiplier[known], vector[known] = values[row, largest], vectors[row, :, largest]
    return multiplier, vector, error


def _energy_by_loops(joint: ReducedModel, line: IntArray, vector: ComplexArray, count: int) -> FloatArray:
    """Return sum M_ii |x_i|^2 of a disturbance (q, q'/w) by its number of loops, without relief: (cycles, loops)."""
    mass = joint.modal_masses[line]
    m = mass.shape[-1]
    energy = (mass * (np.abs(vector[:, :m]) ** 2 + np.abs(vector[:, m:]) ** 2))[:, : 3 * count]
    return np.asarray(energy.reshape(line.size, 3, count).sum(axis=1))
