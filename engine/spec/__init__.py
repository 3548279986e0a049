"""One iced span and the questions put to it, as frozen dataclasses in SI units and radians.

Every class checks its own fields on construction and raises `engine.outcome.InvalidSpec` with all faults at once.
Axes (docs/conventions.md): X along the span, Y up, Z horizontal and downwind. Positions are horizontal distances from
the left support. Properties are given per sub-conductor, with its ice.
"""

from engine.spec.analysis import (
    AerodynamicLoad,
    AerodynamicModel,
    AmplitudeCurves,
    Analysis,
    Check,
    Closure,
    DeviceEffect,
    LongitudinalInertia,
    LoopCompetition,
    Model,
    Physics,
    StaticTwist,
    Stretching,
    TorusSearch,
    check_compatible,
)
from engine.spec.climate import YEAR_HOURS, Climate, Icing, Ranged, WindSector
from engine.spec.devices import (
    THIS,
    AirflowSpoiler,
    DetuningPendulum,
    Device,
    InterphaseSpacer,
    PointDevice,
    Spacer,
    StretchDevice,
    TorsionalDamper,
)
from engine.spec.environment import (
    CLOSED,
    GRAVITY,
    TURN,
    Aerodynamics,
    BlowOut,
    Coefficients,
    Damping,
    DampingModel,
    Ice,
    IceSegment,
    MeasuredCoefficients,
    Wind,
)
from engine.spec.line import Line, ice_properties
from engine.spec.phases import Phase, own_line
from engine.spec.physics import PhysicsRequest, with_physics, with_section
from engine.spec.placement import Objective, PendulumChoice, Placement, SpoilerChoice, check_placement
from engine.spec.section import Section, SectionSpan, SuspensionString
from engine.spec.span import Bundle, Conductor, CrossSection, Span, Support, Supports, Yoke
from engine.spec.uncertainty import Uncertainty

__all__ = [
    "CLOSED",
    "GRAVITY",
    "THIS",
    "TURN",
    "YEAR_HOURS",
    "AerodynamicLoad",
    "AerodynamicModel",
    "Aerodynamics",
    "AirflowSpoiler",
    "AmplitudeCurves",
    "Analysis",
    "BlowOut",
    "Bundle",
    "Check",
    "Climate",
    "Closure",
    "Coefficients",
    "Conductor",
    "CrossSection",
    "Damping",
    "DampingModel",
    "DetuningPendulum",
    "Device",
    "DeviceEffect",
    "Ice",
    "IceSegment",
    "Icing",
    "InterphaseSpacer",
    "Line",
    "LongitudinalInertia",
    "LoopCompetition",
    "MeasuredCoefficients",
    "Model",
    "Objective",
    "PendulumChoice",
    "Phase",
    "Physics",
    "PhysicsRequest",
    "Placement",
    "PointDevice",
    "Ranged",
    "Section",
    "SectionSpan",
    "Spacer",
    "Span",
    "SpoilerChoice",
    "StaticTwist",
    "StretchDevice",
    "Stretching",
    "Support",
    "Supports",
    "SuspensionString",
    "TorsionalDamper",
    "TorusSearch",
    "Uncertainty",
    "Wind",
    "WindSector",
    "Yoke",
    "check_compatible",
    "check_placement",
    "ice_properties",
    "own_line",
    "with_physics",
    "with_section",
]
