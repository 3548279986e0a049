"""The table of amplitude curves: every computed point of the branches of limit cycles. Theory section 7.2."""

from collections import Counter
from collections.abc import Iterator

import numpy as np

from engine.arrays import IntArray
from engine.cycles.branch_set import BranchSet
from engine.cycles.floquet import floquet
from engine.cycles.harmonic_balance import Orbits, half_peak_to_peak, states
from engine.report.cells import lists_by_line
from engine.report.findings import ModelFindings
from engine.report.observers.observer import Observer
from engine.result.motions import AmplitudeCurveRow

PHASES = 2.0 * np.pi * np.arange(24) / 24  # at which shares of spans are taken


def amplitude_curve_rows(observer: Observer, findings: ModelFindings) -> list[list[AmplitudeCurveRow]]:
    """Return a row for every computed point of every branch, one list per line, along each curve in turn."""
    table: list[list[AmplitudeCurveRow]] = lists_by_line(findings.line)
    curves: Counter[tuple[int, int]] = Counter()
    first = 0
    for branch_set in findings.cycles.branch_sets:
        members = branch_set.problem.member
        families = findings.cycles.followed[first : first + members.size]
        numbers = []
        for place in zip(members.tolist(), families.tolist(), strict=True):
            numbers.append(curves[place])
            curves[place] += 1
        for line, row in _rows(observer, findings, branch_set, families, np.array(numbers, dtype=np.intp)):
            table[line].append(row)
        first += members.size
    for rows in table:
        rows.sort(key=lambda row: (row.loops, row.branch, row.curve, row.point))
    return table


def _rows(
    observer: Observer,
    findings: ModelFindings,
    branch_set: BranchSet,
    families: IntArray,
    curves: IntArray,
) -> Iterator[tuple[int, AmplitudeCurveRow]]:
    """Yield the rows of a set of branches, each with the index of its line; families and curves: (branches,)."""
    orbits, member, branch = branch_set.orbits, branch_set.member, branch_set.points.branch
    line, shown = findings.line[member], _moving_points(branch_set)
    coordinate = _dominant_coordinates(findings, member, orbits)[shown]
    observed = observer.moving(findings, member, coordinate, states(orbits, PHASES)[shown])
    amplitude = half_peak_to_peak(observed.shapes.swapaxes(-1, -2) @ orbits.coefficients)
    columns = (
        findings.loops[member, coordinate],
        families[branch],
        curves[branch],
        np.arange(branch.size) - np.searchsorted(branch, branch),
        orbits.wind_speed,
        orbits.angular_frequency / (2.0 * np.pi),
        observed.position,
        *amplitude.T,
        floquet(findings.model, member, orbits).stability,
        np.array(observed.span, dtype=np.object_),
    )
    for number, *cells in zip(line.tolist(), *(column.tolist() for column in columns), strict=True):
        yield number, AmplitudeCurveRow(findings.name, *cells)


def _moving_points(branch_set: BranchSet) -> IntArray:
    """Return for each point where its motion is seen: its own index, at a Hopf point that of the next of its branch."""
    branch = branch_set.points.branch
    own = np.arange(branch.size)
    following = np.minimum(own + 1, branch.size - 1)
    still = ~branch_set.orbits.coefficients[..., 1:].any(axis=(-2, -1)) & (branch[following] == branch)
    return np.where(still, following, own)


def _dominant_coordinates(findings: ModelFindings, member: IntArray, orbits: Orbits) -> IntArray:
    """Return the coordinate of largest M_ii |q_i|^2 at each point."""
    energy = findings.model.modal_masses[member] * (orbits.coefficients[..., 1:] ** 2).sum(axis=-1)
    return np.asarray(energy.argmax(axis=-1))
