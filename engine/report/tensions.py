"""The table of dynamic tensions: extremes over the sub-conductors and over time. Theory sections 12.1 and 12.2."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.cycles.harmonic_balance import fourier
from engine.models.stretching import take_stretching, tension_range
from engine.outcome import Outcome
from engine.report.cells import lists_by_line
from engine.report.findings import ModelFindings, cycle_loops, torus_loops
from engine.report.observers.observer import Observer
from engine.result import TensionRow
from engine.spec import Line
from engine.tori.spectrum import sampled_states

SAMPLES = 192  # over one period; the error is 2e-4 of the range
_NONE = None, None, None, None, None


def tension_rows(observer: Observer, findings: ModelFindings) -> list[list[TensionRow]]:
    """Return a row for every motion and span of models with stretching, one list per line."""
    table: list[list[TensionRow]] = lists_by_line(findings.line)
    if findings.model.stretching is None:
        return table
    cycles, tori = findings.cycles, findings.quasi_periodic
    of_cycles = (cycles.member, cycle_loops(findings), cycles.orbits.wind_speed, cycles.branch)
    of_tori = (tori.member, torus_loops(findings), tori.tori.wind_speed, tori.branch)
    for kind, columns, stabilities, tensions in (
        ("periodic", of_cycles, cycles.floquet.stability, cycle_tensions(observer, findings)),
        ("quasi_periodic", of_tori, tori.stability, torus_tensions(observer, findings)),
    ):
        for member, loops, wind, branch, stability, own in zip(*columns, stabilities, tensions, strict=True):
            line = int(findings.line[member])
            keys = (findings.name, int(loops), float(wind), int(branch), kind, stability)
            table[line] += _rows_of_motion(observer, line, keys, own)
    return table


def _rows_of_motion(observer: Observer, line: int, keys: tuple[Any, ...], own: FloatArray) -> Iterator[TensionRow]:
    """Yield a row for each span, whose range of H + N_i are the rows of own (spans, 2)."""
    for span, (tension, steepness) in enumerate(zip(own, observer.steepness[line].tolist(), strict=True), start=1):
        slack = bool(tension[0] <= 0.0)
        forces = _NONE if slack else _forces(observer.lines[line], tension, steepness)
        outcome = Outcome.SLACK if slack else Outcome.CONVERGED
        cells: tuple[Any, ...] = (*keys, *forces, outcome, span if len(own) > 1 else None)
        yield TensionRow(*cells)


def cycle_tensions(observer: Observer, findings: ModelFindings) -> FloatArray:
    """Return the smallest and the largest H + N_i of each span in each cycle: (cycles, spans, 2) [N].

    Without stretching they are infinite.
    """
    cycles = findings.cycles
    coefficients = cycles.orbits.coefficients
    values = fourier(2.0 * np.pi * np.arange(SAMPLES) / SAMPLES, coefficients.shape[-1] // 2)
    return _ranges(observer, findings, cycles.member, (coefficients @ values.T).swapaxes(-1, -2))


def torus_tensions(observer: Observer, findings: ModelFindings) -> FloatArray:
    """Return the ranges of H + N_i in each quasi-periodic motion, as `cycle_tensions`: (tori, spans, 2) [N]."""
    known = findings.quasi_periodic
    q = sampled_states(known.tori)[..., : findings.model.mass.shape[-1]]
    return _ranges(observer, findings, known.member, q)


def _ranges(observer: Observer, findings: ModelFindings, member: IntArray, q: FloatArray) -> FloatArray:
    stretching = take_stretching(findings.model.stretching, member)
    static = observer.tension[findings.line[member], :, None]
    if stretching is None:
        return np.full((member.size, static.shape[1], 2), np.inf)
    return np.asarray(static + tension_range(stretching, q, static.shape[1]))


def _forces(line: Line, horizontal: FloatArray, steepness: float) -> tuple[Any, ...]:
    """Return the range of H + N_i, that of the tension at the higher support, and its share of the rated strength."""
    strength = line.conductor.rated_strength
    at_support = steepness * horizontal
    return (*horizontal.tolist(), *at_support.tolist(), None if strength is None else float(at_support[1] / strength))
