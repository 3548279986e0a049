"""The questions put to a line, and the check that the line has the data to answer them."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from engine.outcome import Fault, require
from engine.spec.line import Line
from engine.spec.phases import own_ice_of_tied
from engine.spec.rules import positive

_REST_RULE = (
    "must be given, or a measured table in the place of ice.aerodynamics, for the relative wind of full physics; "
    '"physics": "source" does without'
)
USUAL_LOOPS = (1, 2, 3)  # of the modes that the finite element model combines
MOST_LOOPS_TOGETHER = 6  # the search for the finite element model's critical speeds takes time as their sixth power


class Model(StrEnum):
    """The three-degree-of-freedom hybrid model, or the finite element model with several modes per direction."""

    HYBRID = "hybrid"
    FINITE_ELEMENT = "finite_element"


class Physics(StrEnum):
    """The source's simplifications, or what theory sections 12 and 13 put in their place."""

    SOURCE = "source"
    FULL = "full"


class Closure(StrEnum):
    """How the angle of attack varies along the span: exactly, or by one scalar as published (A14)-(A17)."""

    EXACT = "exact"
    PUBLISHED = "published"


class AerodynamicModel(StrEnum):
    """Which velocities change the wind: the vertical one, as published, or all of each sub-conductor. Section 13."""

    PUBLISHED = "published"
    RELATIVE_WIND = "relative_wind"
    TABLE = "table"


class AerodynamicLoad(StrEnum):
    """Whether the load of the relative wind is expanded to third order in the motion, or evaluated as it stands."""

    EXPANDED = "expanded"
    UNEXPANDED = "unexpanded"


class LongitudinalInertia(StrEnum):
    """Whether the inertia of f_u is dropped, as in the source, or kept in m_11. Theory section 4."""

    NEGLECTED = "neglected"
    CONDENSED = "condensed"


class Stretching(StrEnum):
    """Whether the square of the slopes stretches the conductors, which stiffens large motions. Theory section 12.1."""

    NEGLECTED = "neglected"
    INCLUDED = "included"


class StaticTwist(StrEnum):
    """Whether the static twist by ice and pendulums is neglected, as in the source, or solved where large or always."""

    NEGLECTED = "neglected"
    WHERE_LARGE = "where_large"
    SOLVED = "solved"


class LoopCompetition(StrEnum):
    """Whether stable cycles of the hybrid model are tested against small motions in the other requested loops."""

    NEGLECTED = "neglected"
    CHECKED = "checked"


class DeviceEffect(StrEnum):
    """Whether a line with devices is also analysed without them, to report what they change."""

    NEGLECTED = "neglected"
    REPORTED = "reported"


class AmplitudeCurves(StrEnum):
    """Whether branches of limit cycles are reported point by point, besides the requested wind speeds."""

    NEGLECTED = "neglected"
    REPORTED = "reported"


class TorusSearch(StrEnum):
    """Which quasi-periodic motions are sought: those that may be stable, or unstable tori beside stable cycles too."""

    LASTING = "lasting"
    EVERY = "every"


class Check(StrEnum):
    """Whether stable cycles are checked by direct integration of the same equations. Theory section 7.5."""

    NONE = "none"
    DIRECT = "direct"


@dataclass(frozen=True, slots=True)
class Analysis:
    """The questions put to a line: loops per span, models, wind speeds [m/s], and modelling choices.

    physics: names the set that aerodynamic_model, longitudinal_inertia, stretching and static_twist belong to, which
    `with_physics` fills in; lacks: the field of the line that kept an analysis for which no physics was asked from
    being full, None if there is none; critical_wind_limit: highest wind speed searched for critical wind speeds [m/s];
    harmonics: of the harmonic balance; finite_element_loops: loops of the modes that the finite element model combines.
    If it is empty, that model gives its natural frequencies only; risk: whether a line with a climate gets its risk.

    Raises
    ------
    InvalidSpec
        If a field breaks its rule.
    """

    loops: tuple[int, ...] = (1, 2)
    models: tuple[Model, ...] = (Model.HYBRID, Model.FINITE_ELEMENT)
    wind_speeds: tuple[float, ...] = (4.0, 5.0, 6.0)
    closure: Closure = Closure.EXACT
    physics: Physics = Physics.SOURCE
    lacks: str | None = None
    aerodynamic_model: AerodynamicModel = AerodynamicModel.PUBLISHED
    aerodynamic_load: AerodynamicLoad = AerodynamicLoad.EXPANDED
    longitudinal_inertia: LongitudinalInertia = LongitudinalInertia.NEGLECTED
    stretching: Stretching = Stretching.NEGLECTED
    critical_wind_limit: float = 30.0
    harmonics: int = 5
    finite_element_loops: tuple[int, ...] = USUAL_LOOPS
    static_twist: StaticTwist = StaticTwist.NEGLECTED
    loop_competition: LoopCompetition = LoopCompetition.NEGLECTED
    device_effect: DeviceEffect = DeviceEffect.NEGLECTED
    amplitude_curves: AmplitudeCurves = AmplitudeCurves.NEGLECTED
    check: Check = Check.NONE
    quasi_periodic: TorusSearch = TorusSearch.LASTING
    settle: bool = True
    risk: bool = True

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            *_loops_faults("loops", self.loops),
            *_loops_faults("finite_element_loops", self.finite_element_loops or (1,)),
            None if self.models else Fault("models", self.models, "must name a model"),
            self._size_fault(),
            *(positive(f"wind_speeds.{i}", speed) for i, speed in enumerate(self.wind_speeds)),
            positive("critical_wind_limit", self.critical_wind_limit),
            None if 1 <= self.harmonics <= 20 else Fault("harmonics", self.harmonics, "must be from 1 to 20"),
            self._closure_fault(),
        )

    def _closure_fault(self) -> Fault | None:
        beyond = {
            "the relative wind": self.aerodynamic_model is not AerodynamicModel.PUBLISHED,
            "stretching": self.stretching is Stretching.INCLUDED,
        }
        needing = [name for name, included in beyond.items() if included]
        if not needing or self.closure is not Closure.PUBLISHED:
            return None
        return Fault("closure", self.closure.value, f"must be exact with {' and '.join(needing)}")

    @property
    def load_stands(self) -> bool:
        """Whether the load is evaluated as it stands; the published one is a cubic, which no expansion changes."""
        unexpanded = self.aerodynamic_load is AerodynamicLoad.UNEXPANDED
        relative = self.aerodynamic_model is AerodynamicModel.RELATIVE_WIND
        return self.aerodynamic_model is AerodynamicModel.TABLE or (relative and unexpanded)

    @property
    def follows_twist(self) -> bool:
        """Whether each wind speed has its own static state, about which its motions are counted."""
        return self.aerodynamic_model is AerodynamicModel.TABLE

    def _size_fault(self) -> Fault | None:
        together = set(self.loops) | set(self.finite_element_loops)
        if Model.FINITE_ELEMENT in self.models and self.finite_element_loops and len(together) > MOST_LOOPS_TOGETHER:
            rule = f"must not make more than {MOST_LOOPS_TOGETHER} different numbers together with loops {self.loops}"
            if self.finite_element_loops == USUAL_LOOPS:
                rule += "; it has these values unless others are given, such as those of loops"
            return Fault("finite_element_loops", self.finite_element_loops, rule)
        return None


def _loops_faults(name: str, loops: tuple[int, ...]) -> Iterator[Fault]:
    if not loops or len(set(loops)) != len(loops) or min(loops) < 1:
        yield Fault(name, loops, "must be one or more distinct whole numbers from 1")


def _too_many_loops(analysis: Analysis, elements: int) -> Iterator[Fault]:
    """Name the loops that the elements cannot show, of those that the models asked for use."""
    used = {"loops": analysis.loops}
    if Model.FINITE_ELEMENT in analysis.models:
        used["finite_element_loops"] = analysis.finite_element_loops
    for name, loops in used.items():
        if max(loops, default=0) > elements:
            yield Fault(name, max(loops), f"must not exceed the number of elements ({elements})")


def check_compatible(line: Line, analysis: Analysis) -> None:
    """Check that a line has the data that an analysis needs.

    Raises
    ------
    InvalidSpec
        If the line has fewer elements than loops are asked for, the published closure is asked for with a wind profile,
        the relative wind is asked for without coefficients at rest, or the table model with no table or one with gaps.
    """
    elements = line.span.elements * (1 if line.section is None else len(line.section.spans))
    published = analysis.closure is Closure.PUBLISHED
    relative = analysis.aerodynamic_model is AerodynamicModel.RELATIVE_WIND
    table = analysis.aerodynamic_model is AerodynamicModel.TABLE
    require(
        *_section_faults(line, analysis),
        *_spacer_faults(line, analysis),
        Fault("ice.aerodynamics", None, "must be a measured table for the table model")
        if table and line.ice.aerodynamics.measured is None
        else None,
        *(line.curve_faults() if table else ()),
        *_too_many_loops(analysis, elements),
        Fault("closure", analysis.closure.value, "must be exact for a wind profile")
        if published and line.wind.profile
        else None,
        Fault("ice.aerodynamics_at_rest", None, _REST_RULE)
        if relative and line.ice.aerodynamics.at_rest is None
        else None,
    )


def _spacer_faults(line: Line, analysis: Analysis) -> Iterator[Fault]:
    """Check that an analysis asks nothing that tied phases do not have."""
    if not line.interphase_spacers:
        return
    if Model.FINITE_ELEMENT not in analysis.models:
        rule = "must hold finite_element for phases that interphase spacers tie"
        yield Fault("models", [model.value for model in analysis.models], rule)
    relative = analysis.aerodynamic_model is AerodynamicModel.RELATIVE_WIND
    for path, ice in own_ice_of_tied(line):
        if relative and ice.aerodynamics.at_rest is None:
            yield Fault(f"{path}.aerodynamics_at_rest", None, _REST_RULE)
    for name, choice in (
        ("closure", Closure.PUBLISHED),
        ("aerodynamic_model", AerodynamicModel.TABLE),
        ("loop_competition", LoopCompetition.CHECKED),
        ("device_effect", DeviceEffect.REPORTED),
    ):
        if getattr(analysis, name) is choice:
            yield Fault(name, choice.value, f"must not be {choice.value} with interphase spacers")


def _section_faults(line: Line, analysis: Analysis) -> Iterator[Fault]:
    """Check that an analysis asks nothing that sections do not have."""
    if line.section is None:
        return
    if analysis.closure is Closure.PUBLISHED:
        yield Fault("closure", analysis.closure.value, "must be exact for a section")
    if analysis.aerodynamic_model is AerodynamicModel.TABLE:
        rule = "must not be table for a section, whose spans have no common static state in the wind"
        yield Fault("aerodynamic_model", analysis.aerodynamic_model.value, rule)
    if analysis.loop_competition is LoopCompetition.CHECKED:
        rule = "must be neglected for a section; the finite element model moves its modes together"
        yield Fault("loop_competition", analysis.loop_competition.value, rule)
