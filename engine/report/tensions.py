"""The table of dynamic tensions: extremes over the sub-conductors and over time. Theory sections 12.1 and 12.2."""

from typing import Any

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.cycles.harmonic_balance import fourier
from engine.mechanics.static_profile import end_steepness
from engine.models.discretization import Discretization
from engine.models.stretching import take_stretching, tension_range
from engine.outcome import Outcome
from engine.report.cells import lists_by_line
from engine.report.findings import ModelFindings, cycle_loops, torus_loops
from engine.result import TensionRow
from engine.spec import Line
from engine.tori.spectrum import sampled_states

SAMPLES = 192  # over one period; the error is 2e-4 of the range
_NONE = None, None, None, None, None


def tension_rows(discretization: Discretization, findings: ModelFindings) -> list[list[TensionRow]]:
    """Return a row for every cycle and quasi-periodic motion of models with stretching, one list per line."""
    table: list[list[TensionRow]] = lists_by_line(findings.line)
    if findings.model.stretching is None:
        return table
    cycles, tori = findings.cycles, findings.quasi_periodic
    of_cycles = (cycles.member, cycle_loops(findings), cycles.orbits.wind_speed, cycles.branch)
    of_tori = (tori.member, torus_loops(findings), tori.tori.wind_speed, tori.branch)
    steepness = end_steepness(discretization.profile)
    for kind, columns, stabilities, tensions in (
        ("periodic", of_cycles, cycles.floquet.stability, cycle_tensions(discretization, findings)),
        ("quasi_periodic", of_tori, tori.stability, torus_tensions(discretization, findings)),
    ):
        for member, loops, wind, branch, stability, own in zip(*columns, stabilities, tensions, strict=True):
            line = int(findings.line[member])
            slack = bool(own[0] <= 0.0)
            forces = _NONE if slack else _forces(discretization.lines[line], own, float(steepness[line]))
            outcome = Outcome.SLACK if slack else Outcome.CONVERGED
            keys = (findings.name, int(loops), float(wind), int(branch), kind, stability)
            cells: tuple[Any, ...] = (*keys, *forces, outcome)
            table[line].append(TensionRow(*cells))
    return table


def cycle_tensions(discretization: Discretization, findings: ModelFindings) -> FloatArray:
    """Return the smallest and the largest H + N_i of each cycle: (cycles, 2) [N], infinite without stretching."""
    cycles = findings.cycles
    coefficients = cycles.orbits.coefficients
    values = fourier(2.0 * np.pi * np.arange(SAMPLES) / SAMPLES, coefficients.shape[-1] // 2)
    return _ranges(discretization, findings, cycles.member, (coefficients @ values.T).swapaxes(-1, -2))


def torus_tensions(discretization: Discretization, findings: ModelFindings) -> FloatArray:
    """Return the smallest and the largest H + N_i of each quasi-periodic motion: (tori, 2) [N], as `cycle_tensions`."""
    known = findings.quasi_periodic
    return _ranges(
        discretization, findings, known.member, sampled_states(known.tori)[..., : findings.model.mass.shape[-1]]
    )


def _ranges(discretization: Discretization, findings: ModelFindings, member: IntArray, q: FloatArray) -> FloatArray:
    stretching = take_stretching(findings.model.stretching, member)
    if stretching is None:
        return np.full((member.size, 2), np.inf)
    ends = tension_range(stretching, q)
    return np.asarray(discretization.profile.horizontal_tension[findings.line[member], None] + ends)


def _forces(line: Line, horizontal: FloatArray, steepness: float) -> tuple[Any, ...]:
    """Return the range of H + N_i, that of the tension at the higher support, and its share of the rated strength."""
    strength = line.conductor.rated_strength
    at_support = steepness * horizontal
    return (*horizontal.tolist(), *at_support.tolist(), None if strength is None else float(at_support[1] / strength))
