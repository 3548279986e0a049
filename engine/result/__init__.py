"""The result of an analysis: tables of flat rows, declared once in `Tables` for engine and service.

A column declares its description, unit and a typical value, and its name carries the unit. From these `app` builds
JSON, CSV, Parquet and the OpenAPI document. A new table is a dataclass of rows and a field of `Tables`.
"""

from engine.result.assumptions import AssumptionRow
from engine.result.at_rest import (
    CriticalWindSpeedRow,
    DenHartog,
    Direction,
    FrequencyRow,
    InternalResonanceRow,
    Neighbours,
    PhysicsRow,
    SectionModeRow,
    StaticEquilibriumRow,
    StaticState,
)
from engine.result.columns import Column, Table, Title, columns_of, tables_of
from engine.result.devices import DeviceEffectRow, PlacedDeviceRow
from engine.result.motions import (
    BifurcationRow,
    FoundBy,
    LimitCycleRow,
    LoopCompetitionRow,
    ModelComparisonRow,
    Orbit,
    TensionRow,
)
from engine.result.over_field import FollowedBifurcationRow, FollowedCycleRow
from engine.result.phases import ClearanceMethod, PhaseClearanceRow, PhaseModeRow
from engine.result.remedies import Change, RemedyRow
from engine.result.risk import RiskRow
from engine.result.tables import TABLES, Result, Tables
from engine.result.uncertainty import SensitivityRow, UncertaintyRow
from engine.result.verdict import VerdictRow

__all__ = [
    "TABLES",
    "AssumptionRow",
    "BifurcationRow",
    "Change",
    "ClearanceMethod",
    "Column",
    "CriticalWindSpeedRow",
    "DenHartog",
    "DeviceEffectRow",
    "Direction",
    "FollowedBifurcationRow",
    "FollowedCycleRow",
    "FoundBy",
    "FrequencyRow",
    "InternalResonanceRow",
    "LimitCycleRow",
    "LoopCompetitionRow",
    "ModelComparisonRow",
    "Neighbours",
    "Orbit",
    "PhaseClearanceRow",
    "PhaseModeRow",
    "PhysicsRow",
    "PlacedDeviceRow",
    "RemedyRow",
    "Result",
    "RiskRow",
    "SectionModeRow",
    "SensitivityRow",
    "StaticEquilibriumRow",
    "StaticState",
    "Table",
    "Tables",
    "TensionRow",
    "Title",
    "UncertaintyRow",
    "VerdictRow",
    "columns_of",
    "tables_of",
]
