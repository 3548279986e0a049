"""Devices: those mounted on a span, and remedies that are to be tried."""

from app.schemas.devices.mounted import (
    AirflowSpoiler,
    DetuningPendulum,
    Device,
    InterphaseSpacer,
    Spacer,
    TorsionalDamper,
)
from app.schemas.devices.tried_remedies import Remedies

__all__ = [
    "AirflowSpoiler",
    "DetuningPendulum",
    "Device",
    "InterphaseSpacer",
    "Remedies",
    "Spacer",
    "TorsionalDamper",
]
