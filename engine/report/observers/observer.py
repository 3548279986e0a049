"""What the tables of motions ask of a line, and the answer of single spans. Theory section 8."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from engine.arrays import FloatArray, IntArray, take_rows
from engine.mechanics.static_profile import end_steepness, horizontal_position
from engine.models.discretization import Discretization, nodal_motion
from engine.models.relative_wind import NodalMotion
from engine.report.findings import ModelFindings
from engine.report.observers.widest_places import widest_places
from engine.spec import AerodynamicModel, Line


@dataclass(frozen=True, slots=True)
class Observed:
    """Where motions are observed.

    position: (motions,), horizontal distance from the left support of the span [m]; sag: (motions,), static sag there
    [m]; shapes: (motions, m, 3), V, W and Theta of each coordinate there; span: the number of the span that moves most,
    and shares: those of all spans in the mean kinetic energy, as text; None where a line is a single span, and at rest.
    """

    position: FloatArray
    sag: FloatArray
    shapes: FloatArray
    span: Sequence[int | None]
    shares: Sequence[str | None]


class Observer(Protocol):
    """Lines of a stack as the tables of motions see them; arrays have the leading axis (lines,) unless said otherwise.

    tension, steepness: (lines, spans), horizontal tension of one sub-conductor [N] and ds/dx at the higher support of
    each span; fitted_range: angle up to which coefficients are fitted [rad]; span_length: of the span of interest [m].
    """

    @property
    def lines(self) -> Sequence[Line]: ...  # noqa: D102
    @property
    def tension(self) -> FloatArray: ...  # noqa: D102
    @property
    def steepness(self) -> FloatArray: ...  # noqa: D102
    @property
    def fitted_range(self) -> FloatArray: ...  # noqa: D102
    @property
    def span_length(self) -> FloatArray: ...  # noqa: D102

    def resting(self, findings: ModelFindings, member: IntArray, loops: IntArray) -> Observed:
        """Return where models (k,) at rest are observed for numbers of loops (k,)."""
        ...

    def moving(self, findings: ModelFindings, member: IntArray, coordinate: IntArray, state: FloatArray) -> Observed:
        """Return where motions are observed.

        Parameters
        ----------
        findings : ModelFindings
        member, coordinate : (motions,)
            Index of the model, and of its coordinate that moves most.
        state : (motions, samples, 2 m)
            q and q'/U over time.
        """
        ...

    def local_motion(self, findings: ModelFindings, model: AerodynamicModel) -> NodalMotion:
        """Return the local motion at the nodes of all models of the findings."""
        ...


@dataclass(frozen=True, slots=True)
class SpanObserver:
    """Observes single spans where they move most, at rest at the first antinode, s = L/(2 loops)."""

    discretization: Discretization

    @property
    def lines(self) -> Sequence[Line]:
        """The lines."""
        return self.discretization.lines

    @property
    def tension(self) -> FloatArray:
        """Horizontal tension: (lines, 1) [N]."""
        return self.discretization.profile.horizontal_tension[:, None]

    @property
    def steepness(self) -> FloatArray:
        """Tension at the higher support over its horizontal component: (lines, 1)."""
        return end_steepness(self.discretization.profile)[:, None]

    @property
    def fitted_range(self) -> FloatArray:
        """Smallest range of the fits on the line: (lines,) [rad]."""
        return self.discretization.sections.fitted_range

    @property
    def span_length(self) -> FloatArray:
        """Span length: (lines,) [m]."""
        return self.discretization.profile.span_length

    def resting(self, findings: ModelFindings, member: IntArray, loops: IntArray) -> Observed:
        """Return s = L/(2 loops)."""
        return self._observed(
            findings.line[member], np.asarray(0.5 / loops, dtype=np.float64), np.zeros((member.size, 0, 3))
        )

    def moving(self, findings: ModelFindings, member: IntArray, coordinate: IntArray, state: FloatArray) -> Observed:
        """Return where the motion of the coordinate that moves most is largest."""
        model = findings.model
        seen = widest_places(
            model.shapes[member],
            model.direction[coordinate],
            findings.loops[member, coordinate],
            coordinate,
            state[..., : model.mass.shape[-1]],
        )
        return self._observed(findings.line[member], seen.share, seen.shapes)

    def local_motion(self, findings: ModelFindings, model: AerodynamicModel) -> NodalMotion:
        """Return the local motion at the nodes."""
        return nodal_motion(self.discretization, findings.line, findings.model.shapes, model)

    def _observed(self, line: IntArray, share: FloatArray, shapes: FloatArray) -> Observed:
        profile = take_rows(self.discretization.profile, line)
        position = horizontal_position(profile, profile.arc_length * share)
        nothing = [None] * line.size
        return Observed(position, profile.sag, shapes, nothing, nothing)
