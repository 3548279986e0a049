"""Phases that interphase spacers tie, in OpenSees: chains of bars with truss bars between them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import openseespy.opensees as ops

from benchmarks.opensees import (
    Conductor,
    Node,
    Section,
    Springs,
    chain,
    empty_model,
    find_equilibrium,
    support_and_load,
)

NEARLY_RIGID = 1e9  # [N/m]


@dataclass(frozen=True, slots=True)
class HungPhase:
    """A phase: its conductor, and where its left end hangs, (y, z) [m]."""

    conductor: Conductor
    place: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Truss:
    """A bar between two phases, by their indices, at the node nearest to a horizontal position [m].

    stiffness [N/m]; mass [kg], half at each end.
    """

    position: float
    between: tuple[int, int]
    stiffness: float = NEARLY_RIGID
    mass: float = 0.0


def tied_frequencies(
    phases: Sequence[HungPhase], section: Section, trusses: Sequence[Truss], count: int, bars: int = 160
) -> list[float]:
    """Return the lowest natural frequencies of phases that bars tie, in rising order [Hz].

    Raises
    ------
    RuntimeError
        If OpenSees finds no equilibrium.
    """
    with empty_model():
        chains: list[list[Node]] = []
        for phase in phases:
            first = 1 + sum(map(len, chains))
            chains.append(chain(phase.conductor, section, bars, first, phase.place))
        ops.timeSeries("Constant", 1)
        ops.pattern("Plain", 1, 1)
        springs = Springs(sum(map(len, chains)))
        for phase, nodes in zip(phases, chains, strict=True):
            support_and_load(phase.conductor, section, nodes, springs)
        _tie(trusses, chains)
        find_equilibrium()
        return [math.sqrt(value) / (2.0 * math.pi) for value in ops.eigen(count)]


def _tie(trusses: Sequence[Truss], chains: Sequence[Sequence[Node]]) -> None:
    first = 1_000_000  # beyond the tags of nodes, bars and springs
    for tag, truss in enumerate(trusses, start=first):
        ends = [min(chains[i], key=lambda node: abs(node.x - truss.position)) for i in truss.between]
        length = math.dist((ends[0].y, ends[0].z), (ends[1].y, ends[1].z))
        ops.uniaxialMaterial("Elastic", tag, truss.stiffness * length)
        ops.element("Truss", tag, *(node.tag for node in ends), 1.0, tag)
        for node in ends:
            own = np.array(ops.nodeMass(node.tag)) + 0.5 * truss.mass
            ops.mass(node.tag, *own.tolist())
