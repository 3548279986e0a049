"""Devices mounted on a span. Each class states its own inertia, stiffness, damping and static load.

A device acts at points or on stretches; each of its parts is a `PointDevice` or a `StretchDevice`. Matrices are 4 x 4
over U, V, W and Theta of the reference curve at the device (theory section 3). They are tuples, so this module does not
need numpy.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from engine.outcome import Fault, require
from engine.spec.environment import GRAVITY, Aerodynamics
from engine.spec.rules import finite, not_negative, positive, stretch_faults

Row = tuple[float, float, float, float]
Matrix = tuple[Row, Row, Row, Row]

NOTHING: Row = (0.0, 0.0, 0.0, 0.0)
THIS = "this"  # the name by which interphase spacers and tables call the line itself


@dataclass(frozen=True, slots=True)
class PointDevice:
    """A device at a position [m] with a mass [kg]; this base class is a point mass on the reference curve.

    A subclass overrides the methods in which it differs. turn: static twist of the cross-section at the device [rad].
    """

    position: float
    mass: float

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(not_negative("position", self.position), not_negative("mass", self.mass), *self.own_faults())

    def own_faults(self) -> Iterable[Fault | None]:
        """Check the rules of the fields besides position and mass."""
        return ()

    def inertia(self, turn: float = 0.0) -> Matrix:
        """Return the contribution to M [kg, kg m, kg m2]."""
        del turn
        return mass_matrix(self.mass, 0.0)

    def stiffness(self, turn: float = 0.0) -> Matrix:
        """Return the contribution to K [N/m, N, N m]."""
        del turn
        return on_torsion(0.0)

    def damping(self) -> Matrix:
        """Return the contribution to C [N s/m, N s, N m s]."""
        return on_torsion(0.0)

    def load(self, turn: float = 0.0) -> Row:
        """Return the static forces and the torsional moment on the cross-section [N, N, N, N m]."""
        del turn
        return NOTHING

    @property
    def end(self) -> tuple[str, float]:
        """The name of the field that says where the device ends, and that position [m]."""
        return "position", self.position

    @property
    def points(self) -> tuple["PointDevice", ...]:
        """The parts that act at a point."""
        return (self,)

    @property
    def stretches(self) -> tuple["StretchDevice", ...]:
        """The parts that act on a stretch."""
        return ()

    @property
    def placed(self) -> Mapping[str, float]:
        """The values that a placement search may vary, by their columns in the placements table."""
        return {}

    def total_mass(self, subconductors: int) -> float:
        """Return the mass on a bundle with this number of sub-conductors [kg]."""
        del subconductors
        return self.mass


@dataclass(frozen=True, slots=True)
class StretchDevice:
    """A device on a stretch [start, stop] [m] that replaces the aerodynamics there and adds mass.

    aerodynamics: None leaves those of the ice in force; mass: added per length of each sub-conductor [kg/m].
    """

    start: float
    stop: float
    aerodynamics: Aerodynamics | None
    mass: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(*stretch_faults(self.start, self.stop), not_negative("mass", self.mass))

    @property
    def end(self) -> tuple[str, float]:
        """The name of the field that says where the device ends, and that position [m]."""
        return "stop", self.stop

    @property
    def points(self) -> tuple[PointDevice, ...]:
        """The parts that act at a point."""
        return ()

    @property
    def stretches(self) -> tuple["StretchDevice", ...]:
        """The parts that act on a stretch."""
        return (self,)

    @property
    def placed(self) -> Mapping[str, float]:
        """The values that a placement search may vary, by their columns in the placements table."""
        return {}

    def total_mass(self, subconductors: int) -> float:
        """Return the mass on a bundle with this number of sub-conductors [kg]."""
        return self.mass * (self.stop - self.start) * subconductors


Device = PointDevice | StretchDevice


@dataclass(frozen=True, slots=True)
class Spacer(PointDevice):
    """Rigid spacer at a position [m]: mass m_s [kg], polar inertia I_s about the reference curve [kg m2], eq. (5)."""

    polar_inertia: float

    def own_faults(self) -> Iterable[Fault | None]:
        """Check the polar inertia."""
        yield not_negative("polar_inertia", self.polar_inertia)

    def inertia(self, turn: float = 0.0) -> Matrix:
        """Return m_s on U, V, W and I_s on Theta."""
        del turn
        return mass_matrix(self.mass, self.polar_inertia)


@dataclass(frozen=True, slots=True)
class DetuningPendulum(PointDevice):
    """Pendulum: a mass [kg] on a rigid arm [m], angle [rad] from straight down, positive downwind. Theory section 3."""

    arm: float
    angle: float = 0.0

    def own_faults(self) -> Iterable[Fault | None]:
        """Check the arm and its angle."""
        yield positive("arm", self.arm)
        yield finite("angle", self.angle)

    def offset(self, turn: float = 0.0) -> tuple[float, float]:
        """Return (y, z) of the mass about the reference curve [m]."""
        angle = self.angle - turn
        return -self.arm * math.cos(angle), self.arm * math.sin(angle)

    def inertia(self, turn: float = 0.0) -> Matrix:
        """Return the inertia of a point mass at its offset."""
        return mass_matrix(self.mass, self.mass * self.arm**2, self.offset(turn))

    def stiffness(self, turn: float = 0.0) -> Matrix:
        """Return the gravity stiffness -m g y on Theta."""
        return on_torsion(-GRAVITY * (self.mass * self.offset(turn)[0]))

    def load(self, turn: float = 0.0) -> Row:
        """Return the moment m g z of the weight."""
        return (0.0, 0.0, 0.0, self.mass * GRAVITY * self.offset(turn)[1])

    @property
    def placed(self) -> Mapping[str, float]:
        """Position [m], mass [kg] and arm [m]."""
        return {"position_m": self.position, "mass_kg": self.mass, "arm_m": self.arm}


@dataclass(frozen=True, slots=True)
class TorsionalDamper(PointDevice):
    """Clamped viscous damper of torsion: polar inertia about the reference curve [kg m2].

    coefficient: moment per angular velocity of the cross-section [N m s].
    """

    polar_inertia: float
    coefficient: float

    def own_faults(self) -> Iterable[Fault | None]:
        """Check the polar inertia and the coefficient."""
        yield not_negative("polar_inertia", self.polar_inertia)
        yield not_negative("coefficient", self.coefficient)

    def inertia(self, turn: float = 0.0) -> Matrix:
        """Return the mass on U, V, W and the polar inertia on Theta."""
        del turn
        return mass_matrix(self.mass, self.polar_inertia)

    def damping(self) -> Matrix:
        """Return the coefficient on Theta."""
        return on_torsion(self.coefficient)


@dataclass(frozen=True, slots=True)
class InterphaseSpacer(PointDevice):
    """A spacer between two phases, hinged at both: it holds their distance and nothing else. mass: of all of it [kg].

    between: names of two phases, "this" for the line itself; axial_stiffness: against a change of its length [N/m],
    None for a rigid spacer.
    """

    between: tuple[str, str]
    axial_stiffness: float | None = None

    def own_faults(self) -> Iterable[Fault | None]:
        """Check the names and the stiffness."""
        one, other = self.between
        yield Fault("between", self.between, "must name two different phases") if one == other else None
        yield positive("axial_stiffness", self.axial_stiffness)

    @property
    def points(self) -> tuple[PointDevice, ...]:
        """Nothing: a line by itself has no other phase to be tied to."""
        return ()

    def half(self) -> PointDevice:
        """Return what each of its phases carries, at the reference curve."""
        return PointDevice(self.position, 0.5 * self.mass)


@dataclass(frozen=True, slots=True)
class AirflowSpoiler(StretchDevice):
    """Spoiler on a stretch [start, stop] [m] with its own aerodynamics; mass is added per sub-conductor [kg/m]."""

    @property
    def placed(self) -> Mapping[str, float]:
        """Start and end [m]."""
        return {"from_m": self.start, "to_m": self.stop}


def mass_matrix(mass: float, polar_inertia: float, offset: tuple[float, float] = (0.0, 0.0)) -> Matrix:
    """Return the mass matrix of a body: mass [kg] at (y, z) [m], polar inertia about the reference curve [kg m2]."""
    y, z = offset
    return (
        (mass, 0.0, 0.0, 0.0),
        (0.0, mass, 0.0, -mass * z),
        (0.0, 0.0, mass, mass * y),
        (0.0, -mass * z, mass * y, polar_inertia),
    )


def on_torsion(value: float) -> Matrix:
    """Return the matrix with this value on Theta and zeros elsewhere."""
    return (NOTHING, NOTHING, NOTHING, (0.0, 0.0, 0.0, value))
