"""Tied phases as the tables of motions see them: observed where the phase that moves most moves most."""

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.assemblies.numbered_modes import largest_member
from engine.mechanics.static_profile import horizontal_position
from engine.report.findings import ModelFindings
from engine.report.observers.observer import Observed
from engine.report.observers.section_observer import SectionObserver

NEARLY = 1.0 - 1e-6  # of the largest displacement, from which on the first node is taken


@dataclass(frozen=True, slots=True)
class PhaseObserver(SectionObserver):
    """Observes tied phases in the one of the largest share of kinetic energy.

    There it is at the node where the coordinate that moves most is largest, since spacers hold phases at places where
    loops would be widest.
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

    def moving(self, findings: ModelFindings, member: IntArray, coordinate: IntArray, state: FloatArray) -> Observed:
        """Return the node of the largest displacement in the phase that moves most."""
        shares = self.shares(findings, member, coordinate, state)
        phase = largest_member(shares)
        profile = self.whole.members.profile
        shapes, position = np.empty((member.size, findings.model.mass.shape[-1], 3)), np.empty(member.size)
        for i in range(member.size):
            own = self._fields(findings.model.shapes[member[i]])[..., phase[i], :]
            size = np.abs(own[coordinate[i], findings.model.direction[coordinate[i]]])
            node = int(np.flatnonzero(size >= NEARLY * size.max())[0])
            shapes[i] = own[..., node]
            position[i] = horizontal_position(profile, profile.arc_length * node / (size.size - 1))[phase[i]]
        texts = [" ".join(f"{share:.4f}" for share in row) for row in shares.tolist()]
        return Observed(position, profile.sag[phase], shapes, (phase + 1).tolist(), texts)
