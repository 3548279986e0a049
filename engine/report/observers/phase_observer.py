"""Tied phases as the tables of motions see them: observed in the phase that moves most, as in the span of a section."""

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import IntArray
from engine.report.findings import ModelFindings
from engine.report.observers.observer import Observed
from engine.report.observers.section_observer import SectionObserver


@dataclass(frozen=True, slots=True)
class PhaseObserver(SectionObserver):
    """Observes tied phases in the one of the largest share of kinetic energy, where that phase moves most.

    Spacers hold phases at places where loops would be widest, so this may be far from all antinodes.
    """

    def resting(self, findings: ModelFindings, member: IntArray, loops: IntArray) -> Observed:
        """Return where the first coordinates of these numbers of loops are observed, vertical ones before others."""
        coordinate = np.zeros(member.size, dtype=np.intp)
        for i, (model, k) in enumerate(zip(member.tolist(), loops.tolist(), strict=True)):
            alike = np.flatnonzero(findings.loops[model] == k)
            coordinate[i] = alike[findings.model.direction[alike].argmin()]
        m = findings.model.mass.shape[-1]
        alone = np.concatenate([np.zeros((member.size, m)), np.eye(m)[coordinate]], axis=-1)[:, None]
        observed = self.moving(findings, member, coordinate, alone)
        return replace(observed, span=[None] * member.size, shares=[None] * member.size)
