"""A section as the tables of motions see it: observed in the span that moves most. Theory section 16."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray, IntArray, take_rows
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.numbered_modes import largest_member, loops_of
from engine.mechanics.finite_elements import V
from engine.mechanics.static_profile import end_steepness, horizontal_position
from engine.models.discretization import nodal_motion
from engine.models.relative_wind import NodalMotion
from engine.report.findings import ModelFindings
from engine.report.observers.observer import Observed
from engine.report.observers.widest_places import widest_places
from engine.spec import AerodynamicModel, Line


@dataclass(frozen=True, slots=True)
class SectionObserver:
    """Observes one section in the span of the largest share of kinetic energy, where that span moves most.

    The antinodes are those of the loops that the coordinate that moves most has in that span.
    """

    whole: AssembledLine

    @property
    def lines(self) -> Sequence[Line]:
        """The line, once."""
        return (self.whole.line,)

    @property
    def tension(self) -> FloatArray:
        """Horizontal tension of each span: (1, spans) [N]."""
        return self.whole.members.profile.horizontal_tension[None]

    @property
    def steepness(self) -> FloatArray:
        """Tension at the higher end of each span over its horizontal component: (1, spans)."""
        return end_steepness(self.whole.members.profile)[None]

    @property
    def fitted_range(self) -> FloatArray:
        """Smallest range of the fits on any span: (1,) [rad]."""
        return np.asarray(self.whole.members.sections.fitted_range.min(keepdims=True))

    @property
    def span_length(self) -> FloatArray:
        """Length of the span of interest: (1,) [m]."""
        return self.whole.members.profile.span_length[[self.whole.interest]]

    def resting(self, findings: ModelFindings, member: IntArray, loops: IntArray) -> Observed:
        """Return where the vertical modes of these numbers are observed."""
        coordinate = np.array(
            [
                int(np.flatnonzero((findings.loops[i] == k) & (findings.model.direction == 0))[0])
                for i, k in zip(member.tolist(), loops.tolist(), strict=True)
            ],
            dtype=np.intp,
        )
        m = findings.model.mass.shape[-1]
        alone = np.concatenate([np.zeros((member.size, m)), np.eye(m)[coordinate]], axis=-1)[:, None]
        return replace(
            self.moving(findings, member, coordinate, alone), span=[None] * member.size, shares=[None] * member.size
        )

    def moving(self, findings: ModelFindings, member: IntArray, coordinate: IntArray, state: FloatArray) -> Observed:
        """Return the widest place of the span that moves most."""
        shares = self.shares(findings, member, coordinate, state)
        span, every = largest_member(shares), np.arange(member.size)
        model, profile = findings.model, take_rows(self.whole.members.profile, span)
        fields = np.moveaxis(self._fields(model.shapes[member]), -2, 1)[every, span]
        direction = model.direction[coordinate]
        loops = loops_of(fields[every, coordinate, direction])
        seen = widest_places(fields, direction, loops, coordinate, state[..., : model.mass.shape[-1]])
        position = horizontal_position(profile, profile.arc_length * seen.share)
        texts = [" ".join(f"{share:.4f}" for share in row) for row in shares.tolist()]
        return Observed(position, profile.sag, seen.shapes, (span + 1).tolist(), texts)

    def shares(self, findings: ModelFindings, member: IntArray, coordinate: IntArray, state: FloatArray) -> FloatArray:
        """Return the shares of the spans in the mean kinetic energy of motions: (motions, spans).

        Parameters are those of `moving`. Motion along the line is left out. Where nothing moves, the shares are those
        of the coordinate by itself.
        """
        masses = {int(i): self._span_masses(findings.model.shapes[i]) for i in np.unique(member)}
        energy = np.empty((member.size, self.whole.assembly.members))
        m = findings.model.mass.shape[-1]
        for i, of_model in enumerate(member.tolist()):
            rate = state[i, :, m:]
            rate = rate if rate.any() else np.eye(m)[coordinate[[i]]]
            energy[i] = ((rate @ masses[of_model]) * rate).sum(axis=(-1, -2))
        return np.asarray(energy / energy.sum(axis=-1, keepdims=True))

    def local_motion(self, findings: ModelFindings, model: AerodynamicModel) -> NodalMotion:
        """Return the local motion at the nodes of all spans."""
        spans = np.arange(self.whole.assembly.members)
        parts = []
        for shapes in findings.model.shapes:
            by_span = np.moveaxis(self._fields(shapes), -2, 0)
            own = nodal_motion(self.whole.members, spans, by_span, model)
            parts.append((np.concatenate(list(own.forms)), np.concatenate(list(np.broadcast_to(*_same_nodes(own))))))
        forms, arms = (np.stack(values) for values in zip(*parts, strict=True))
        diameter = np.full(len(forms), self.whole.line.conductor.diameter)
        return NodalMotion(forms, arms, diameter, model)

    def _fields(self, shapes: FloatArray) -> FloatArray:
        """Return fields (..., 3, all nodes) span by span: (..., 3, spans, nodes)."""
        members = self.whole.assembly.members
        return shapes.reshape(*shapes.shape[:-1], members, shapes.shape[-1] // members)

    def _span_masses(self, shapes: FloatArray) -> FloatArray:
        """Return the mass of each span between the coordinates of a model (m, 3, all nodes): (spans, m, m)."""
        by_span = np.moveaxis(self._fields(shapes), -2, 0)
        moved = np.zeros((*by_span.shape[:2], by_span.shape[-1], V + by_span.shape[2]))
        moved[..., V:] = by_span.swapaxes(-1, -2)
        flat = moved.reshape(*moved.shape[:2], -1)
        return np.asarray(flat @ self.whole.members.matrices.mass @ flat.swapaxes(-1, -2))


def _same_nodes(motion: NodalMotion) -> tuple[FloatArray, tuple[int, ...]]:
    """Return the arms and their shape at every node, where they are the same at all."""
    return motion.arms, (*motion.forms.shape[:2], *motion.arms.shape[2:])
