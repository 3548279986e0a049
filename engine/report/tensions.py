"""The table of dynamic tensions: extremes over the sub-conductors and over time. Theory sections 12.1 and 12.2."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

from engine.arrays import FloatArray, IntArray, times_matrix
from engine.cycles.harmonic_balance import fourier
from engine.models.stretching import dynamic_tension, take_members, tension_range
from engine.numerics.extremes import extremes
from engine.outcome import Outcome
from engine.report.cells import filled_rows, lists_by_line, numbers
from engine.report.findings import ModelFindings, cycle_loops, torus_loops
from engine.report.observers.observer import Observer
from engine.result import TensionRow
from engine.tori.spectrum import sampled_states

SAMPLES = 64  # over one period; a parabola through the extremes leaves an error of 1e-4 of the range
BLOCK = 256  # motions sampled together, which bounds the memory of their samples
_FORCES = (
    "smallest_horizontal_n",
    "largest_horizontal_n",
    "smallest_at_support_n",
    "largest_at_support_n",
    "largest_share_of_rated_strength",
)
_OUTCOMES = np.array([Outcome.CONVERGED, Outcome.SLACK], dtype=np.object_)


@dataclass(frozen=True, slots=True)
class MotionTensions:
    """Smallest and largest H + N_i of each span in each motion, infinite without stretching [N].

    cycles: (cycles, spans, 2); tori: (tori, spans, 2), of quasi-periodic motions.
    """

    cycles: FloatArray
    tori: FloatArray


def motion_tensions(observer: Observer, findings: ModelFindings) -> MotionTensions:
    """Return the ranges of tension of all motions."""
    return MotionTensions(_cycle_tensions(observer, findings), _torus_tensions(observer, findings))


def tension_rows(observer: Observer, findings: ModelFindings, tensions: MotionTensions) -> list[list[TensionRow]]:
    """Return a row for every motion and span of models with stretching, one list per line."""
    table: list[list[TensionRow]] = lists_by_line(findings.line)
    if findings.model.stretching is None:
        return table
    cycles, tori = findings.cycles, findings.quasi_periodic
    of_cycles = (cycle_loops(findings), cycles.orbits.wind_speed, cycles.branch)
    of_tori = (torus_loops(findings), tori.tori.wind_speed, tori.branch)
    rows = chain(
        _rows(observer, findings, cycles.member, (*of_cycles, "periodic", cycles.floquet.stability), tensions.cycles),
        _rows(observer, findings, tori.member, (*of_tori, "quasi_periodic", tori.stability), tensions.tori),
    )
    for line, row in rows:
        table[line].append(row)
    return table


def _rows(
    observer: Observer, findings: ModelFindings, member: IntArray, keys: tuple[Any, ...], own: FloatArray
) -> Iterator[tuple[int, TensionRow]]:
    """Return a row for each motion and span, with the line of each.

    keys: loops, wind speed and branch of each motion, their kind, and the stability of each; own: (motions, spans, 2),
    the ranges of H + N_i.
    """
    motions, spans, _ = own.shape
    line = np.repeat(findings.line[member], spans)
    loops, wind, branch, kind, stability = keys
    horizontal = own.reshape(-1, 2)
    at_support = horizontal * observer.steepness[findings.line[member]].reshape(-1, 1)
    strengths = [one.conductor.rated_strength or np.nan for one in observer.lines]
    share = at_support[:, 1] / np.array(strengths)[line]
    slack = horizontal[:, 0] <= 0.0
    forces = np.where(slack, np.nan, [*horizontal.T, *at_support.T, share])
    labels = {"loops": loops, "wind_speed_m_per_s": wind, "branch": branch, "stability": stability}
    columns: dict[str, list[Any]] = {name: np.repeat(column, spans).tolist() for name, column in labels.items()}
    columns |= zip(_FORCES, map(numbers, forces), strict=True)
    columns |= {"outcome": _OUTCOMES[slack.astype(np.intp)].tolist()}
    columns |= {"span": list(range(1, spans + 1)) * motions if spans > 1 else [None] * motions}
    rows = filled_rows(TensionRow, columns, {"model": findings.name, "kind": kind})
    return zip(line.tolist(), rows, strict=True)


def _cycle_tensions(observer: Observer, findings: ModelFindings) -> FloatArray:
    """Return the smallest and the largest H + N_i of each span in each cycle: (cycles, spans, 2) [N]."""
    cycles, stretching = findings.cycles, findings.model.stretching
    static = observer.tension[findings.line[cycles.member]]
    ranges = np.full((*static.shape, 2), np.inf)
    if stretching is None:
        return ranges
    values = fourier(2.0 * np.pi * np.arange(SAMPLES) / SAMPLES, cycles.orbits.coefficients.shape[-1] // 2)
    for first in range(0, cycles.member.size, BLOCK):
        here = slice(first, first + BLOCK)
        q = times_matrix(cycles.orbits.coefficients[here], values.T).swapaxes(-1, -2)
        tension = dynamic_tension(take_members(stretching, cycles.member[here]), q).swapaxes(-1, -2)
        by_span = tension.reshape(tension.shape[0], static.shape[1], -1, SAMPLES)
        smallest, largest = extremes(by_span)
        ranges[here] = np.stack([smallest.min(axis=-1), largest.max(axis=-1)], axis=-1)
    return np.asarray(static[..., None] + ranges)


def _torus_tensions(observer: Observer, findings: ModelFindings) -> FloatArray:
    """Return the ranges of H + N_i in each quasi-periodic motion, as `_cycle_tensions`: (tori, spans, 2) [N]."""
    known, model = findings.quasi_periodic, findings.model
    static = observer.tension[findings.line[known.member], :, None]
    if model.stretching is None:
        return np.full((known.member.size, static.shape[1], 2), np.inf)
    q = sampled_states(known.tori)[..., : model.mass.shape[-1]]
    own = take_members(model.stretching, known.member)
    return np.asarray(static + tension_range(own, q, static.shape[1]))
