"""Everything that was found with one kind of model, and what is missing: the tables of motions are written from it."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.checks.confidence import Confidence
from engine.cycles.bifurcations import Bifurcations
from engine.cycles.search import Cycles
from engine.models.critical_wind_speeds import Crossings
from engine.models.reduced_model import ReducedModel
from engine.outcome import Outcome, Stability
from engine.spec import Model
from engine.tori.quasi_periodic import QuasiPeriodicMotions
from engine.tori.spectrum import mean_square_velocity


@dataclass(frozen=True, slots=True)
class ModelFindings:
    """Critical wind speeds, motions and bifurcations of all members of a stack of models.

    model: leading axis (members,); line: (members,), index of each member's line; loops: (members, m), number of loops
    of each coordinate; winds: (members, winds), wind speeds requested of each in rising order [m/s].
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
class MissingMotions:
    """Places without a stable motion.

    member, wind: (places,), indices of model and wind speed; kind: the kind of motion that is missing, in the words of
    the table; outcome: NO_BOUNDED_MOTION where all motions that were integrated diverged, else NO_CONVERGENCE.
    """

    member: IntArray
    wind: IntArray
    kind: list[str]
    outcome: list[Outcome]


def missing_motions(findings: ModelFindings, growing: BoolArray) -> MissingMotions:
    """Return the places at which the static state grows, growing (members, winds), and no stable motion is known.

    A quasi-periodic motion is missing where complex multipliers grow on the known cycles, else a periodic one.
    """
    missing = growing.copy()
    cycles, tori = findings.cycles, findings.quasi_periodic
    for member, wind, stability in (
        (cycles.member, cycles.wind, cycles.floquet.stability),
        (tori.member, tori.wind, tori.stability),
    ):
        stable = np.asarray(stability == Stability.STABLE, dtype=np.bool_)
        missing[member[stable], wind[stable]] = False
    quasi_periodic, unbounded = (_marked(growing, places) for places in (tori.missing, cycles.unbounded))
    member, wind = np.nonzero(missing)
    return MissingMotions(
        member,
        wind,
        ["quasi_periodic" if modulated else "periodic" for modulated in quasi_periodic[member, wind].tolist()],
        [
            Outcome.NO_BOUNDED_MOTION if diverges else Outcome.NO_CONVERGENCE
            for diverges in unbounded[member, wind].tolist()
        ],
    )


def _marked(grid: BoolArray, places: IntArray) -> BoolArray:
    """Return a grid of the same shape that is True at places (k, 2)."""
    marks = np.zeros_like(grid)
    marks[places[:, 0], places[:, 1]] = True
    return marks


def cycle_coordinates(findings: ModelFindings) -> IntArray:
    """Return the coordinate of largest M_ii |q_i|^2 in each cycle: (cycles,)."""
    cycles = findings.cycles
    energy = findings.model.modal_masses[cycles.member] * (cycles.orbits.coefficients[..., 1:] ** 2).sum(axis=-1)
    return np.asarray(energy.argmax(axis=-1))


def torus_coordinates(findings: ModelFindings) -> IntArray:
    """Return the coordinate of largest kinetic energy in each quasi-periodic motion: (tori,)."""
    known = findings.quasi_periodic
    energy = findings.model.modal_masses[known.member] * mean_square_velocity(known.tori)
    return np.asarray(energy.argmax(axis=-1))


def cycle_loops(findings: ModelFindings) -> IntArray:
    """Return the number of loops of the coordinate that moves most in each cycle: (cycles,)."""
    return np.asarray(findings.loops[findings.cycles.member, cycle_coordinates(findings)])


def torus_loops(findings: ModelFindings) -> IntArray:
    """Return the number of loops of the coordinate that moves most in each quasi-periodic motion: (tori,)."""
    return np.asarray(findings.loops[findings.quasi_periodic.member, torus_coordinates(findings)])
