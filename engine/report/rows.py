"""Flat rows of frequencies, critical wind speeds and bifurcations found with one kind of model. Theory section 8."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.checks.confidence import Confidence
from engine.cycles.bifurcations import Bifurcations
from engine.cycles.search import Cycles
from engine.mechanics.modes import assign, solve_symmetric
from engine.models.critical_wind_speeds import Crossings
from engine.models.reduced_model import ReducedModel
from engine.outcome import Outcome
from engine.result import BifurcationRow, CriticalWindSpeedRow, Direction, FrequencyRow
from engine.spec import Model
from engine.tori.quasi_periodic import QuasiPeriodicMotions

DIRECTION_NAMES: tuple[Direction, ...] = ("vertical", "horizontal", "torsional")


@dataclass(frozen=True, slots=True)
class ModelFindings:
    """Everything found with one kind of model.

    model: leading axis (members,); line: (members,), index of the line; loops: (members, m), loops of each
    coordinate; winds: (winds,) in rising order [m/s].
    """

    name: Model
    model: ReducedModel
    line: IntArray
    loops: IntArray
    crossings: Crossings
    cycles: Cycles
    confidence: Confidence
    bifurcations: Bifurcations
    quasi_periodic: QuasiPeriodicMotions
    winds: FloatArray


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
    """Return the squared frequencies of (M, K), each given to the coordinate of largest M_ii |x_i|^2: (members, m)."""
    values, vectors = solve_symmetric(model.stiffness, model.mass)
    share = model.modal_masses[..., None] * vectors**2
    return np.take_along_axis(values, assign(share), axis=-1)


def frequency_rows(table: NaturalFrequencies, loops: tuple[int, ...]) -> list[list[FrequencyRow]]:
    """Write the frequencies of the loops asked for; a list a line."""
    frequency = np.sqrt(np.where(table.squared_frequency > 0.0, table.squared_frequency, np.nan)) / (2.0 * np.pi)
    rows: list[list[FrequencyRow]] = lists_by_line(table.line)
    for member, line in enumerate(table.line.tolist()):
        for k in loops:
            values = [finite_or_none(f) for f in frequency[member, table.loops[member] == k].tolist()]
            if values:
                outcome = Outcome.STATICALLY_UNSTABLE if None in values else Outcome.CONVERGED
                rows[line].append(FrequencyRow(table.name, k, values[0], values[1], values[2], outcome))
    return rows


def critical_wind_speed_rows(findings: ModelFindings) -> list[list[CriticalWindSpeedRow]]:
    """Write every crossing of the static state; a list a line."""
    table: list[list[CriticalWindSpeedRow]] = lists_by_line(findings.line)
    crossings = findings.crossings
    for i, member in enumerate(crossings.member):
        row = CriticalWindSpeedRow(
            model=findings.name,
            loops=int(findings.loops[member, crossings.coordinate[i]]),
            wind_speed_m_per_s=float(crossings.wind_speed[i]),
            crossing="onset" if crossings.onset[i] else "restabilization",
            type="oscillation" if crossings.oscillation[i] else "divergence",
            direction=DIRECTION_NAMES[findings.model.direction[crossings.coordinate[i]]],
            frequency_hz=float(crossings.angular_frequency[i] / (2.0 * np.pi)),
            unstable_pairs_after=int(crossings.unstable_after[i]),
        )
        table[findings.line[member]].append(row)
    return table


def bifurcation_rows(findings: ModelFindings) -> list[list[BifurcationRow]]:
    """Write every bifurcation; a list a line."""
    table: list[list[BifurcationRow]] = lists_by_line(findings.line)
    bifurcations = findings.bifurcations
    for i, member in enumerate(bifurcations.member.tolist()):
        row = BifurcationRow(
            model=findings.name,
            loops=int(findings.loops[member, bifurcations.coordinate[i]]),
            branch=int(bifurcations.branch[i]),
            type=bifurcations.kind[i].value,
            wind_speed_m_per_s=float(bifurcations.parameter[i]),
            frequency_hz=float(bifurcations.angular_frequency[i] / (2.0 * np.pi)),
            second_frequency_hz=finite_or_none(float(bifurcations.second_frequency[i] / (2.0 * np.pi))),
            uncertainty_m_per_s=float(bifurcations.uncertainty[i]),
        )
        table[findings.line[member]].append(row)
    return table


def dropped_warnings(findings: ModelFindings, lines: int) -> list[list[str]]:
    """Say how many solutions were left out; a list a line."""
    count = np.bincount(findings.line, weights=findings.cycles.dropped, minlength=lines).astype(int)
    text = "{} solutions of the {} model at large angles of attack are left out: more harmonics do not resolve them."
    return [[text.format(n, findings.name.value.replace("_", " "))] if n else [] for n in count]


def lists_by_line(line: IntArray) -> list[list[Any]]:
    """Make an empty list for each line."""
    return [[] for _ in range(int(line.max(initial=-1)) + 1)]


def finite_or_none(value: float) -> float | None:
    """Return a number, None where it is not finite."""
    return value if math.isfinite(value) else None
