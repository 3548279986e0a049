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
from engine.tori.quasi_periodic import QuasiPeriodic

DIRECTION_NAMES: tuple[Direction, ...] = ("vertical", "horizontal", "torsional")


@dataclass(frozen=True, slots=True)
class Found:
    """Everything found with one kind of model.

    model: leading axis (members,); line: (members,), index of the line; loops: (members, m), loops of each
    co-ordinate; winds: (winds,) in rising order [m/s].
    """

    name: Model
    model: ReducedModel
    line: IntArray
    loops: IntArray
    crossings: Crossings
    cycles: Cycles
    confidence: Confidence
    bifurcations: Bifurcations
    quasi_periodic: QuasiPeriodic
    winds: FloatArray


@dataclass(frozen=True, slots=True)
class FrequencyTable:
    """Squared frequencies of each co-ordinate of a stack of models.

    line: (members,), index of the line; loops: (members, m); square: (members, m) [rad^2/s^2], the co-ordinates in the
    order vertical, horizontal, torsional for each number of loops.
    """

    name: Model
    line: IntArray
    loops: IntArray
    square: FloatArray


def coupled_squares(model: ReducedModel) -> FloatArray:
    """Return the squared frequencies of (M, K), each given to the co-ordinate of largest M_ii |x_i|^2: (members, m)."""
    values, vectors = solve_symmetric(model.stiffness, model.mass)
    share = np.diagonal(model.mass, axis1=-2, axis2=-1)[..., None] * vectors**2
    return np.take_along_axis(values, assign(share), axis=-1)


def frequency_rows(table: FrequencyTable, loops: tuple[int, ...]) -> list[list[FrequencyRow]]:
    """Write the frequencies of the loops asked for; a list a line."""
    frequency = np.sqrt(np.where(table.square > 0.0, table.square, np.nan)) / (2.0 * np.pi)
    rows: list[list[FrequencyRow]] = by_line(table.line)
    for member, line in enumerate(table.line.tolist()):
        for k in loops:
            picked = [number(f) for f in frequency[member, table.loops[member] == k].tolist()]
            if picked:
                outcome = Outcome.STATICALLY_UNSTABLE if None in picked else Outcome.CONVERGED
                rows[line].append(FrequencyRow(table.name, k, picked[0], picked[1], picked[2], outcome))
    return rows


def critical_rows(found: Found) -> list[list[CriticalWindSpeedRow]]:
    """Write every crossing of the static state; a list a line."""
    table: list[list[CriticalWindSpeedRow]] = by_line(found.line)
    c = found.crossings
    for i, member in enumerate(c.member):
        row = CriticalWindSpeedRow(
            model=found.name,
            loops=int(found.loops[member, c.co_ordinate[i]]),
            wind_speed_m_per_s=float(c.wind_speed[i]),
            crossing="onset" if c.onset[i] else "restabilization",
            type="oscillation" if c.oscillation[i] else "divergence",
            direction=DIRECTION_NAMES[found.model.direction[c.co_ordinate[i]]],
            frequency_hz=float(c.angular_frequency[i] / (2.0 * np.pi)),
            unstable_pairs_after=int(c.unstable_after[i]),
        )
        table[found.line[member]].append(row)
    return table


def bifurcation_rows(found: Found) -> list[list[BifurcationRow]]:
    """Write every bifurcation; a list a line."""
    table: list[list[BifurcationRow]] = by_line(found.line)
    b = found.bifurcations
    for i, member in enumerate(b.member.tolist()):
        row = BifurcationRow(
            model=found.name,
            loops=int(found.loops[member, b.co_ordinate[i]]),
            branch=int(b.branch[i]),
            type=b.kind[i].value,
            wind_speed_m_per_s=float(b.wind_speed[i]),
            frequency_hz=float(b.angular_frequency[i] / (2.0 * np.pi)),
            second_frequency_hz=number(float(b.second[i] / (2.0 * np.pi))),
            uncertainty_m_per_s=float(b.uncertainty[i]),
        )
        table[found.line[member]].append(row)
    return table


def dropped_warnings(found: Found, lines: int) -> list[list[str]]:
    """Say how many solutions were left out; a list a line."""
    count = np.bincount(found.line, weights=found.cycles.dropped, minlength=lines).astype(int)
    text = "{} solutions of the {} model at large angles of attack are left out: more harmonics do not resolve them."
    return [[text.format(n, found.name.value.replace("_", " "))] if n else [] for n in count]


def by_line(line: IntArray) -> list[list[Any]]:
    """Make an empty list for each line."""
    return [[] for _ in range(int(line.max(initial=-1)) + 1)]


def number(value: float) -> float | None:
    """Return a number, None where it is not finite."""
    return value if math.isfinite(value) else None
