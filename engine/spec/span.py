"""Conductor, bundle, span geometry and supports."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from engine.outcome import Fault, require
from engine.spec.rules import finite, not_negative, positive


@dataclass(frozen=True, slots=True)
class Conductor:
    """One iced sub-conductor.

    diameter [m]; axial_rigidity EA [N]; torsional_rigidity GJ [N m2]; mass m [kg/m]; polar_inertia I about the bare
    centre [kg m]; axial_torsional_coupling B_T [N m]; rated_strength: tension at which it breaks [N], None if unknown,
    which only shares of it need. Theory section 1.
    """

    diameter: float
    axial_rigidity: float
    torsional_rigidity: float
    mass: float
    polar_inertia: float
    axial_torsional_coupling: float = 0.0
    rated_strength: float | None = None

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            *(
                positive(f"conductor.{name}", getattr(self, name))
                for name in (
                    "diameter",
                    "axial_rigidity",
                    "torsional_rigidity",
                    "mass",
                    "polar_inertia",
                    "rated_strength",
                )
            ),
            finite("conductor.axial_torsional_coupling", self.axial_torsional_coupling),
            self._coupling_fault(),
        )

    def _coupling_fault(self) -> Fault | None:
        if not self.axial_torsional_coupling**2 < self.axial_rigidity * self.torsional_rigidity:
            rule = "squared must be below axial times torsional rigidity (else the strain energy is not positive)"
            return Fault("conductor.axial_torsional_coupling", self.axial_torsional_coupling, rule)
        return None


class CrossSection(StrEnum):
    """How the sub-conductors of a bundle move along the span: all by one U, or each by its own. Theory section 12.2."""

    RIGID = "rigid"
    FREE = "free"


class Yoke(StrEnum):
    """Whether a yoke holds the sub-conductors of a free section together along the span, or yaws and pitches freely."""

    HELD = "held"
    FREE = "free"


@dataclass(frozen=True, slots=True)
class Bundle:
    """Positions (y, z) [m] of the bare sub-conductor centres about the reference curve, and how the section moves.

    section: None where it is open. `with_section` then gives that of the physics; without it, it is rigid.
    """

    positions: tuple[tuple[float, float], ...] = ((0.0, 0.0),)
    section: CrossSection | None = None

    def __post_init__(self) -> None:
        """Check that there is a sub-conductor and that positions are finite and distinct."""
        require(
            None if self.positions else Fault("bundle.positions", self.positions, "must hold a sub-conductor"),
            *(
                finite(f"bundle.positions.{i}.{j}", value)
                for i, position in enumerate(self.positions)
                for j, value in enumerate(position)
            ),
            None
            if len(set(self.positions)) == len(self.positions)
            else Fault("bundle.positions", self.positions, "must be distinct"),
        )

    @classmethod
    def regular(
        cls, subconductors: int, radius: float, orientation: float, section: CrossSection | None = None
    ) -> "Bundle":
        """Place sub-conductors on a circle at equal angles.

        Parameters
        ----------
        subconductors : int
            Their number n, at least 1.
        radius : float
            Distance r_i from the reference curve [m]; 0 for one sub-conductor, positive for more.
        orientation : float
            Angle theta_10 of the first, clockwise from straight up [rad]: y = r cos(theta), z = r sin(theta), eq. (3).
        section : CrossSection or None
            How the section moves.

        Raises
        ------
        InvalidSpec
            If the number is below 1 or the radius does not fit it.
        """
        single = subconductors == 1
        require(
            None if subconductors >= 1 else Fault("bundle.subconductors", subconductors, "must be at least 1"),
            finite("bundle.orientation", orientation),
            not_negative("bundle.radius", radius) if single else positive("bundle.radius", radius),
            Fault("bundle.radius", radius, "must be 0 for one sub-conductor") if single and radius > 0.0 else None,
        )
        if single:
            return cls(section=section)
        angles = [orientation + 2.0 * math.pi * i / subconductors for i in range(subconductors)]
        return cls(tuple((radius * math.cos(angle), radius * math.sin(angle)) for angle in angles), section)


@dataclass(frozen=True, slots=True)
class Span:
    """Span: horizontal length L_x [m], number of elements, and exactly one measure of its tightness.

    horizontal_tension H per sub-conductor [N], catenary_parameter H/p [m] or mid-span sag s_a from the chord [m], each
    of the iced conductor in still air. level_difference: height of the right support above the left one [m]. Theory
    sections 2 and 16.
    """

    length: float
    horizontal_tension: float | None = None
    catenary_parameter: float | None = None
    sag: float | None = None
    elements: int = 10
    level_difference: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field and that one measure of tightness is given."""
        given = [v for v in (self.horizontal_tension, self.catenary_parameter, self.sag) if v is not None]
        one_measure = "must have exactly one of horizontal_tension, catenary_parameter and sag"
        require(
            positive("span.length", self.length),
            positive("span.horizontal_tension", self.horizontal_tension),
            positive("span.catenary_parameter", self.catenary_parameter),
            positive("span.sag", self.sag),
            None if len(given) == 1 else Fault("span", tuple(given), one_measure),
            None if self.elements >= 2 else Fault("span.elements", self.elements, "must be at least 2"),
            *self._level_faults(),
        )

    def _level_faults(self) -> Iterator[Fault | None]:
        yield finite("span.level_difference", self.level_difference)
        if abs(self.level_difference) > self.length > 0.0:
            rule = f"must not exceed the span's length ({self.length}), up or down"
            yield Fault("span.level_difference", self.level_difference, rule)


@dataclass(frozen=True, slots=True)
class Support:
    """One end of the span: a dead end fixes U; else the adjacent span and the insulator string hold it, eq. (A10).

    adjacent_span: its length [m], None for the length of this span; insulator_length L_i [m]; insulator_weight W_i per
    sub-conductor [N]; yoke: None for free at a string and held elsewhere.
    """

    dead_end: bool = False
    adjacent_span: float | None = None
    insulator_length: float | None = None
    insulator_weight: float = 0.0
    yoke: Yoke | None = None

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            positive("adjacent_span", self.adjacent_span),
            positive("insulator_length", self.insulator_length),
            not_negative("insulator_weight", self.insulator_weight),
        )

    @property
    def holds_differences(self) -> bool:
        """Whether sub-conductors of a free section have a common U here."""
        if self.yoke is None:
            return self.dead_end or self.insulator_length is None
        return self.yoke is Yoke.HELD


@dataclass(frozen=True, slots=True)
class Supports:
    """Both ends; longitudinal_stiffness K_x per sub-conductor [N/m], if given, replaces that computed from them."""

    longitudinal_stiffness: float | None = None
    left: Support = Support()
    right: Support = Support()

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(positive("supports.longitudinal_stiffness", self.longitudinal_stiffness))
