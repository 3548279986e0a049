"""The JSON that comes in, as pydantic models: names, units, bounds, defaults and examples of the fields."""

from app.schemas.analysis import Analysis, Uncertainty, WindSpeedRange
from app.schemas.climate import Climate, Icing, WindSector
from app.schemas.devices import (
    AirflowSpoiler,
    DetuningPendulum,
    Device,
    InterphaseSpacer,
    Remedies,
    Spacer,
    TorsionalDamper,
)
from app.schemas.environment import (
    Aerodynamics,
    AerodynamicsAtRest,
    BlowOut,
    Damping,
    Ice,
    IceSegment,
    ProfilePoint,
    Wind,
)
from app.schemas.fields import Document
from app.schemas.labels import BatchLabels, JobLabels
from app.schemas.line import Bundle, Conductor, Line, Phase, PhaseLine, Span, Support, Supports
from app.schemas.measured import CoefficientRow, MeasuredCoefficients
from app.schemas.placement import PendulumChoice, Placement, SpoilerChoice
from app.schemas.request import Axis, JobRequest, RemediesRequest, Study
from app.schemas.section import Section, SectionSpan, SuspensionString

__all__ = [
    "Aerodynamics",
    "AerodynamicsAtRest",
    "AirflowSpoiler",
    "Analysis",
    "Axis",
    "BatchLabels",
    "BlowOut",
    "Bundle",
    "Climate",
    "CoefficientRow",
    "Conductor",
    "Damping",
    "DetuningPendulum",
    "Device",
    "Document",
    "Ice",
    "IceSegment",
    "Icing",
    "InterphaseSpacer",
    "JobLabels",
    "JobRequest",
    "Line",
    "MeasuredCoefficients",
    "PendulumChoice",
    "Phase",
    "PhaseLine",
    "Placement",
    "ProfilePoint",
    "Remedies",
    "RemediesRequest",
    "Section",
    "SectionSpan",
    "Spacer",
    "Span",
    "SpoilerChoice",
    "Study",
    "Support",
    "Supports",
    "SuspensionString",
    "TorsionalDamper",
    "Uncertainty",
    "Wind",
    "WindSector",
    "WindSpeedRange",
]
