"""The registry of result tables: a field of `Tables` is a table, and everything else follows from its name and rows."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from engine.result.assumptions import AssumptionRow
from engine.result.at_rest import (
    CriticalWindSpeedRow,
    DenHartog,
    FrequencyRow,
    InternalResonanceRow,
    PhysicsRow,
    SectionModeRow,
    StaticEquilibriumRow,
    StaticState,
)
from engine.result.columns import Table, Title, tables_of
from engine.result.devices import DeviceEffectRow, PlacedDeviceRow
from engine.result.motions import (
    AmplitudeCurveRow,
    BifurcationRow,
    LimitCycleRow,
    LoopCompetitionRow,
    ModelComparisonRow,
    Orbit,
    TensionRow,
)
from engine.result.over_field import FollowedBifurcationRow, FollowedCycleRow
from engine.result.phases import PhaseClearanceRow, PhaseModeRow
from engine.result.remedies import RemedyRow
from engine.result.risk import RiskRow
from engine.result.uncertainty import SensitivityRow, UncertaintyRow
from engine.result.verdict import VerdictRow


@dataclass(frozen=True, slots=True, kw_only=True)
class Tables:
    """Every table of flat rows that a result holds, in the order of the result document."""

    verdict: Annotated[tuple[VerdictRow, ...], Title("The verdict: one row, whatever the models and loops")] = ()
    uncertainty: Annotated[
        tuple[UncertaintyRow, ...],
        Title("How samples of the assumed values behave; empty unless something is assumed and samples are asked for"),
    ] = ()
    sensitivities: Annotated[
        tuple[SensitivityRow, ...],
        Title("What each assumed value means for onset and amplitude; empty without samples"),
    ] = ()
    assumptions: Annotated[
        tuple[AssumptionRow, ...],
        Title("Where the values of the line came from; empty for a line that was given explicitly"),
    ] = ()
    physics: Annotated[tuple[PhysicsRow, ...], Title("Physics of the analysis")] = ()
    frequencies: Annotated[tuple[FrequencyRow, ...], Title("Natural frequencies")] = ()
    internal_resonances: Annotated[tuple[InternalResonanceRow, ...], Title("Ratios of the natural frequencies")] = ()
    section_modes: Annotated[
        tuple[SectionModeRow, ...], Title("Natural modes of a section of spans; empty for a single span")
    ] = ()
    phase_modes: Annotated[
        tuple[PhaseModeRow, ...], Title("Natural modes of phases that spacers tie; empty without interphase spacers")
    ] = ()
    critical_wind_speeds: Annotated[
        tuple[CriticalWindSpeedRow, ...],
        Title("Wind speeds at which the resting span loses or regains stability"),
    ] = ()
    static_equilibria: Annotated[
        tuple[StaticEquilibriumRow, ...],
        Title("Angles at rest in the wind; empty unless the twist is solved for a table of coefficients"),
    ] = ()
    limit_cycles: Annotated[tuple[LimitCycleRow, ...], Title("Motions at every wind speed")] = ()
    tensions: Annotated[
        tuple[TensionRow, ...], Title("Tensions during the motions; empty where stretching is neglected")
    ] = ()
    clearances: Annotated[
        tuple[PhaseClearanceRow, ...], Title("Clearances between phases; empty where none are given")
    ] = ()
    bifurcations: Annotated[tuple[BifurcationRow, ...], Title("Bifurcations of the motions over the wind speed")] = ()
    amplitude_curves: Annotated[
        tuple[AmplitudeCurveRow, ...],
        Title("Branches of limit cycles point by point; empty unless amplitude_curves is reported"),
    ] = ()
    model_comparisons: Annotated[
        tuple[ModelComparisonRow, ...], Title("Stable cycles of the hybrid model beside the finite element model's")
    ] = ()
    loop_competitions: Annotated[
        tuple[LoopCompetitionRow, ...],
        Title("Stable cycles tested with the other loops; empty unless loop_competition is checked"),
    ] = ()
    risk: Annotated[
        tuple[RiskRow, ...], Title("Hours and probability of galloping a year; empty without the line's climate")
    ] = ()
    device_effects: Annotated[
        tuple[DeviceEffectRow, ...],
        Title("Effects of devices; empty unless device_effect is reported or devices were placed"),
    ] = ()
    placements: Annotated[tuple[PlacedDeviceRow, ...], Title("Devices that a search has placed")] = ()
    remedies: Annotated[
        tuple[RemedyRow, ...],
        Title("The line without and with each remedy tried; empty unless remedies were asked for"),
    ] = ()
    followed_cycles: Annotated[
        tuple[FollowedCycleRow, ...],
        Title("Cycles on branches over the field of a study; empty without follow"),
    ] = ()
    followed_bifurcations: Annotated[
        tuple[FollowedBifurcationRow, ...],
        Title("Bifurcations on those branches, with the nearest value of the axis"),
    ] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Result(Tables):
    """Everything that was found for one line."""

    static: StaticState
    den_hartog: DenHartog
    orbits: tuple[Orbit, ...]
    warnings: tuple[str, ...]
    engine_version: str


TABLES: Mapping[str, Table] = tables_of(Tables)
