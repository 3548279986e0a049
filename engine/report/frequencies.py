"""The table of natural frequencies. Theory section 4."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.mechanics.modes import assign
from engine.numerics.eigenproblems import solve_symmetric
from engine.outcome import Outcome
from engine.report.cells import lists_by_line, numbers
from engine.report.findings import ModelFindings
from engine.result import FrequencyRow
from engine.spec import Model


@dataclass(frozen=True, slots=True)
class NaturalFrequencies:
    """Squared natural frequencies of the coordinates of a stack of models.

    line: (members,), index of the line; loops: (members, m), loops of each coordinate; squared_frequency: (members, m)
    [rad^2/s^2], in the order vertical, horizontal, torsional for each number of loops.
    """

    name: Model
    line: IntArray
    loops: IntArray
    squared_frequency: FloatArray


def coupled_frequencies(hybrid: ModelFindings) -> NaturalFrequencies:
    """Return the frequencies of (M, K) of hybrid models.

    Each mode is assigned to the coordinate of largest M_ii |x_i|^2, one mode per coordinate.
    """
    values, vectors = solve_symmetric(hybrid.model.stiffness, hybrid.model.mass)
    share = hybrid.model.modal_masses[..., None] * vectors**2
    squared = np.take_along_axis(values, assign(share), axis=-1)
    return NaturalFrequencies(Model.HYBRID, hybrid.line, hybrid.loops, squared)


def full_frequencies(loops: tuple[int, ...], eigenvalues: FloatArray) -> NaturalFrequencies:
    """Return the frequencies of the full modes of every line, given their eigenvalues (lines, 3, loops)."""
    count = eigenvalues.shape[0]
    each = np.broadcast_to(np.tile(loops, 3), (count, 3 * len(loops)))
    return NaturalFrequencies(Model.FINITE_ELEMENT, np.arange(count), each, eigenvalues.reshape(count, -1))


def frequency_rows(table: NaturalFrequencies, loops: tuple[int, ...]) -> list[list[FrequencyRow]]:
    """Return the rows of the requested numbers of loops, one list per line."""
    frequency = np.sqrt(np.where(table.squared_frequency > 0.0, table.squared_frequency, np.nan)) / (2.0 * np.pi)
    rows: list[list[FrequencyRow]] = lists_by_line(table.line)
    for line, own, known in zip(table.line.tolist(), map(numbers, frequency), table.loops.tolist(), strict=True):
        for k in loops:
            values = [value for value, number in zip(own, known, strict=True) if number == k]
            if values:
                outcome = Outcome.STATICALLY_UNSTABLE if None in values else Outcome.CONVERGED
                rows[line].append(FrequencyRow(table.name, k, values[0], values[1], values[2], outcome))
    return rows
