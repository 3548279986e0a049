"""Devices that are mounted on a span."""

from dataclasses import dataclass

from engine.outcome import require
from engine.spec.environment import Aerodynamics
from engine.spec.rules import finite, not_negative, positive, stretch_faults


@dataclass(frozen=True, slots=True)
class Spacer:
    """Rigid spacer at a position [m]: mass m_s [kg], polar inertia I_s about the reference curve [kg m2], eq. (5)."""

    position: float
    mass: float
    polar_inertia: float

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            not_negative("position", self.position),
            not_negative("mass", self.mass),
            not_negative("polar_inertia", self.polar_inertia),
        )


@dataclass(frozen=True, slots=True)
class DetuningPendulum:
    """Mass [kg] on a rigid arm [m] at an angle [rad] from straight down, positive downwind. Theory section 3."""

    position: float
    mass: float
    arm: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            not_negative("position", self.position),
            not_negative("mass", self.mass),
            positive("arm", self.arm),
            finite("angle", self.angle),
        )


@dataclass(frozen=True, slots=True)
class AirflowSpoiler:
    """Stretch [start, stop] [m] on which other aerodynamics hold; mass is added per sub-conductor [kg/m]."""

    start: float
    stop: float
    aerodynamics: Aerodynamics
    mass: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(*stretch_faults(self.start, self.stop), not_negative("mass", self.mass))


Device = Spacer | DetuningPendulum | AirflowSpoiler
