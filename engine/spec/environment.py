"""Ice, wind and damping of a span."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

from engine.outcome import Fault, require
from engine.spec.rules import finite, not_negative, overlap_faults, positive, stretch_faults

Coefficients = tuple[float, float, float]

GRAVITY = 9.81  # m/s2
TURN = 2.0 * math.pi
LARGEST_STEP = math.radians(20.0)  # between two rows of a table that is used as it stands
CLOSED = 1e-6  # rad, or relative: a table within this of a full turn covers the circle
SAME_VALUE = 1e-6  # of the column's largest value: difference of the first and the last row of a circle


@dataclass(frozen=True, slots=True)
class MeasuredCoefficients:
    """The measured table behind cubic coefficients, from which they are fitted again where the section is twisted.

    angle [rad], ascending, with lift, drag and moment coefficients of one sub-conductor, all (rows,); static_angle: the
    angle in the table at which the untwisted section stands [rad]; half_range: rows no farther than this from the local
    angle enter the fit [rad].
    """

    angle: tuple[float, ...]
    lift: tuple[float, ...]
    drag: tuple[float, ...]
    moment: tuple[float, ...]
    static_angle: float
    half_range: float

    @property
    def closes_circle(self) -> bool:
        """Whether the table covers the full circle, with or without a last row that repeats the first."""
        missing = TURN - (self.angle[-1] - self.angle[0])
        widest = min(max(b - a for a, b in pairwise(self.angle)), LARGEST_STEP)
        return missing <= (1.0 + CLOSED) * widest

    def curve_faults(self) -> Iterator[Fault]:
        """Check that the table is a curve over its angles: without gaps, and the same at both ends of a circle."""
        steps = [b - a for a, b in pairwise(self.angle)]
        widest = max(range(len(steps)), key=steps.__getitem__)
        whole = self.angle[-1] - self.angle[0]
        if steps[widest] > LARGEST_STEP * (1.0 + CLOSED):
            rule = f"must not leave a gap of more than {math.degrees(LARGEST_STEP):.0f} degrees between two rows"
            yield Fault(f"table.{widest + 1}.angle", self.angle[widest + 1], rule)
        if whole > TURN + CLOSED:
            yield Fault(f"table.{len(steps)}.angle", self.angle[-1], "must not go beyond one full turn from the first")
        elif whole > TURN - CLOSED:
            columns = {"lift": self.lift, "drag": self.drag, "moment": self.moment}
            for name, column in columns.items():
                if abs(column[-1] - column[0]) > SAME_VALUE * max(map(abs, column)):
                    rule = "must be the value of the first row, one full turn before"
                    yield Fault(f"table.{len(steps)}.{name}", column[-1], rule)


@dataclass(frozen=True, slots=True)
class Aerodynamics:
    """Cubic coefficients a_i1, a_i2, a_i3 of one sub-conductor over the angle of attack [1/rad^j], eqs. (A11)-(A17).

    at_rest: a_y0, a_z0, a_theta0, which only the relative wind needs; a stretch without them has those of the line.
    fitted_range: the largest |alpha| [rad] for which the fit holds, None if unknown; measured: the table behind the
    fit, None if there is none.
    """

    vertical: Coefficients
    horizontal: Coefficients
    torsional: Coefficients
    at_rest: Coefficients | None = None
    fitted_range: float | None = None
    measured: MeasuredCoefficients | None = None

    def __post_init__(self) -> None:
        """Check that every coefficient is finite."""
        rows = {"vertical": self.vertical, "horizontal": self.horizontal, "torsional": self.torsional}
        require(
            *(finite(f"{name}.{j}", value) for name, row in rows.items() for j, value in enumerate(row)),
            *(finite(f"at_rest.{j}", value) for j, value in enumerate(self.at_rest or ())),
            positive("fitted_range", self.fitted_range),
        )


@dataclass(frozen=True, slots=True)
class IceSegment:
    """A stretch [start, stop] [m] of other ice; fields that are not None override those of the span.

    eccentricity_y, eccentricity_z [m]; mass: of one iced sub-conductor [kg/m].
    """

    start: float
    stop: float
    aerodynamics: Aerodynamics | None = None
    eccentricity_y: float | None = None
    eccentricity_z: float | None = None
    mass: float | None = None

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            *stretch_faults(self.start, self.stop),
            finite("eccentricity_y", self.eccentricity_y),
            finite("eccentricity_z", self.eccentricity_z),
            positive("mass", self.mass),
        )


@dataclass(frozen=True, slots=True)
class Ice:
    """Ice of the span: aerodynamics, eccentricity (e_y, e_z) of the iced centre of mass [m], segments of other ice."""

    aerodynamics: Aerodynamics
    eccentricity_y: float = 0.0
    eccentricity_z: float = 0.0
    segments: tuple[IceSegment, ...] = ()

    def __post_init__(self) -> None:
        """Check the rules of every field and that no two segments overlap."""
        require(
            finite("ice.eccentricity_y", self.eccentricity_y),
            finite("ice.eccentricity_z", self.eccentricity_z),
            *overlap_faults((f"ice.segments.{i}", s.start, s.stop) for i, s in enumerate(self.segments)),
        )


@dataclass(frozen=True, slots=True)
class BlowOut:
    """Mean drag at wind_speed [m/s] that turns the plane of the sag. Theory section 15.

    wind_speed: None means each wind speed of an analysis; drag_coefficient: None takes the coefficients C_z0 at rest.
    """

    wind_speed: float | None
    drag_coefficient: float | None = None

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            not_negative("wind.blow_out.wind_speed", self.wind_speed),
            not_negative("wind.blow_out.drag_coefficient", self.drag_coefficient),
        )


@dataclass(frozen=True, slots=True)
class Wind:
    """Air density [kg/m3]; profile of (position [m], factor phi), linear between points and constant outside them.

    yaw: angle between the wind and the horizontal normal of the line [rad].
    """

    air_density: float = 1.2929
    profile: tuple[tuple[float, float], ...] = ()
    blow_out: BlowOut | None = None
    yaw: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field and that the positions of the profile ascend."""
        positions = [position for position, _ in self.profile]
        rising = all(a < b for a, b in pairwise(positions))
        require(
            positive("wind.air_density", self.air_density),
            *(not_negative(f"wind.profile.{i}.position", x) for i, (x, _) in enumerate(self.profile)),
            *(positive(f"wind.profile.{i}.factor", phi) for i, (_, phi) in enumerate(self.profile)),
            None if rising else Fault("wind.profile", positions, "must have positions in rising order"),
            finite("wind.yaw", self.yaw),
            None if abs(self.yaw) < 0.5 * math.pi else Fault("wind.yaw", self.yaw, "must be below a right angle"),
        )


class DampingModel(StrEnum):
    """What all numbers of loops share: the damping coefficient per length, or the ratio. Theory section 4."""

    CONSTANT_COEFFICIENT = "constant_coefficient"
    CONSTANT_RATIO = "constant_ratio"


@dataclass(frozen=True, slots=True)
class Damping:
    """Structural damping ratios zeta_y, zeta_z, zeta_theta of eq. (11)."""

    vertical_ratio: float
    horizontal_ratio: float
    torsional_ratio: float
    model: DampingModel = DampingModel.CONSTANT_COEFFICIENT

    def __post_init__(self) -> None:
        """Check that every ratio is positive and below critical damping."""
        names = ("vertical_ratio", "horizontal_ratio", "torsional_ratio")
        require(
            *(positive(f"damping.{name}", getattr(self, name)) for name in names),
            *(
                Fault(f"damping.{name}", getattr(self, name), "must be below 1")
                for name in names
                if getattr(self, name) >= 1.0
            ),
        )
