"""Which physics an analysis has, the source's or the full one; a request may also set each option separately.

How the sub-conductors move along the span belongs to the physics as well, but to each line.
"""

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any

from engine.spec.analysis import (
    AerodynamicModel,
    Analysis,
    Closure,
    LongitudinalInertia,
    Physics,
    StaticTwist,
    Stretching,
)
from engine.spec.line import Line
from engine.spec.phases import Phase, own_ice_of_tied
from engine.spec.span import CrossSection

AT_REST = "ice.aerodynamics_at_rest"

_DEFAULTS: dict[Physics, dict[str, Any]] = {
    Physics.SOURCE: {
        "aerodynamic_model": AerodynamicModel.PUBLISHED,
        "longitudinal_inertia": LongitudinalInertia.NEGLECTED,
        "stretching": Stretching.NEGLECTED,
        "static_twist": StaticTwist.NEGLECTED,
    },
    Physics.FULL: {
        "aerodynamic_model": AerodynamicModel.RELATIVE_WIND,
        "longitudinal_inertia": LongitudinalInertia.CONDENSED,
        "stretching": Stretching.INCLUDED,
        "static_twist": StaticTwist.WHERE_LARGE,
    },
}

_SECTIONS = {Physics.SOURCE: CrossSection.RIGID, Physics.FULL: CrossSection.FREE}


@dataclass(frozen=True, slots=True)
class PhysicsRequest:
    """The physics of a request: None lets the data of the line decide; an option that is None is set by the physics."""

    physics: Physics | None = None
    aerodynamic_model: AerodynamicModel | None = None
    longitudinal_inertia: LongitudinalInertia | None = None
    stretching: Stretching | None = None
    static_twist: StaticTwist | None = None


def with_physics(line: Line, analysis: Analysis, asked: PhysicsRequest) -> Analysis:
    """Return an analysis with the physics that a request chooses.

    If it chooses none, it is full where the line's coefficients at rest are known, as full physics needs them, and
    that of the source elsewhere. The published closure belongs to the source.

    Raises
    ------
    InvalidSpec
        If options exclude each other.
    """
    return _with_physics(analysis, asked, _lacking(line))


def with_section(line: Line, physics: Physics) -> Line:
    """Return a line whose bundle has the section of a physics, where it says none; a single conductor has none."""
    if any(phase.line is not None for phase in line.phases):
        line = replace(line, phases=tuple(_phase_with_section(phase, physics) for phase in line.phases))
    if line.bundle.section is not None or len(line.bundle.positions) == 1:
        return line
    return replace(line, bundle=replace(line.bundle, section=_SECTIONS[physics]))


def _phase_with_section(phase: Phase, physics: Physics) -> Phase:
    return phase if phase.line is None else replace(phase, line=with_section(phase.line, physics))


def _lacking(line: Line) -> str | None:
    """Return the first field that full physics needs and that the line, or a phase that is tied to it, has not."""
    if line.ice.aerodynamics.at_rest is None:
        return AT_REST
    without = (path for path, ice in own_ice_of_tied(line) if ice.aerodynamics.at_rest is None)
    return next((f"{path}.aerodynamics_at_rest" for path in without), None)


@lru_cache  # all lines of a batch have the same analysis
def _with_physics(analysis: Analysis, asked: PhysicsRequest, lacks: str | None) -> Analysis:
    physics, unasked = asked.physics, None
    if physics is None:
        published = analysis.closure is Closure.PUBLISHED
        physics = Physics.SOURCE if published or lacks else Physics.FULL
        unasked = None if published else lacks
    options = {field.name: getattr(asked, field.name) for field in fields(asked) if field.name != "physics"}
    said = {name: choice for name, choice in options.items() if choice is not None}
    return replace(analysis, **{**_DEFAULTS[physics], **said}, physics=physics, lacks=unasked)
