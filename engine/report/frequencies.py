"""The table of natural frequencies. Theory section 4."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.mechanics.modes import assign, solve_symmetric
from engine.models.reduced_model import ReducedModel
from engine.outcome import Outcome
from engine.report.cells import finite_or_none, lists_by_line
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


def coupled_frequencies(model: ReducedModel) -> FloatArray:
    """Return the squared natural frequencies of (M, K): (members, m) [rad^2/s^2].

    Each mode is assigned to the coordinate of largest M_ii |x_i|^2, one mode per coordinate.
    """
    values, vectors = solve_symmetric(model.stiffness, model.mass)
    share = model.modal_masses[..., None] * vectors**2
    return np.take_along_axis(values, assign(share), axis=-1)


def frequency_rows(table: NaturalFrequencies, loops: tuple[int, ...]) -> list[list[FrequencyRow]]:
    """Return the rows of the numbers of loops asked for, one list per line."""
    frequency = np.sqrt(np.where(table.squared_frequency > 0.0, table.squared_frequency, np.nan)) / (2.0 * np.pi)
    rows: list[list[FrequencyRow]] = lists_by_line(table.line)
    for member, line in enumerate(table.line.tolist()):
        for k in loops:
            values = [finite_or_none(f) for f in frequency[member, table.loops[member] == k].tolist()]
            if values:
                outcome = Outcome.STATICALLY_UNSTABLE if None in values else Outcome.CONVERGED
                rows[line].append(FrequencyRow(table.name, k, values[0], values[1], values[2], outcome))
    return rows
