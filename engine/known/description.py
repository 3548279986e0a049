"""A line as an engineer knows it; None means that a value was not said. SI, radians, degrees Celsius."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from enum import StrEnum

from engine.known.ice_sections import Accretion
from engine.known.provenance import Origin
from engine.outcome import Fault, require
from engine.spec import Aerodynamics, Bundle, DampingModel, Device, IceSegment, Phase, Section, Span, Supports, Wind
from engine.spec.rules import finite, not_negative, positive

_PERCENT = 100.0
# Figure -> what any conductor has, and the slip that leads out of it.
_PLAUSIBLE = {
    "diameter": (1e-3, 0.2, "m", "28.1 mm is 0.0281 m"),
    "bare_mass": (5e-3, 50.0, "kg/m", "1,628 kg/km is 1.628 kg/m"),
    "area": (1e-6, 1e-2, "m2", "468.6 mm2 is 468.6e-6 m2"),
    "aluminium_area": (1e-6, 1e-2, "m2", "402.8 mm2 is 402.8e-6 m2"),
    "modulus": (1e10, 3e11, "Pa", "74 GPa is 74e9 Pa"),
    "rated_strength": (500.0, 1e7, "N", "140.1 kN is 140.1e3 N"),
    "thermal_expansion": (1e-6, 1e-4, "1/K", "18.9 millionths per kelvin are 18.9e-6 1/K"),
}
_METALS = (2500.0, 9500.0)  # kg/m3 over the area of the wires, which are longer than the conductor


@dataclass(frozen=True, slots=True)
class ConductorData:
    """Figures of a bare conductor, or of its iced one where a rigidity is meant: all of them may be unknown.

    diameter [m]; bare_mass per length [kg/m]; area of all metal and aluminium_area [m2]; modulus, final, over the whole
    area [Pa]; axial_rigidity [N]; torsional_rigidity [N m2]; axial_torsional_coupling [N m]; bare_polar_inertia per
    length [kg m]; rated_strength [N]; thermal_expansion [1/K]; numbers of wires.
    """

    diameter: float | None = None
    bare_mass: float | None = None
    area: float | None = None
    aluminium_area: float | None = None
    modulus: float | None = None
    axial_rigidity: float | None = None
    torsional_rigidity: float | None = None
    axial_torsional_coupling: float | None = None
    bare_polar_inertia: float | None = None
    rated_strength: float | None = None
    thermal_expansion: float | None = None
    aluminium_wires: int | None = None
    steel_wires: int | None = None

    def __post_init__(self) -> None:
        """Check that every figure is that of a conductor, and that areas and mass fit each other."""
        free = {"axial_torsional_coupling": finite, "steel_wires": not_negative}
        require(
            *(free.get(f.name, positive)(f"conductor.{f.name}", getattr(self, f.name)) for f in fields(self)),
            *self._implausible(),
            Fault("conductor.aluminium_area", self.aluminium_area, f"must not exceed the area ({self.area} m2)")
            if self.area is not None and self.aluminium_area is not None and self.aluminium_area > self.area
            else None,
            self._density_fault(),
        )

    def _implausible(self) -> Iterator[Fault]:
        for name, (lowest, highest, unit, slip) in _PLAUSIBLE.items():
            value = getattr(self, name)
            if value is not None and value > 0.0 and not lowest <= value <= highest:
                rule = f"must lie between {lowest:g} and {highest:g} {unit}: {slip}"
                yield Fault(f"conductor.{name}", value, rule)

    def _density_fault(self) -> Fault | None:
        if self.bare_mass is None or self.area is None or not self.area > 0.0:
            return None
        density = self.bare_mass / self.area
        if _METALS[0] <= density <= _METALS[1]:
            return None
        rule = f"must be that of metal wires, 2,500 to 9,500 kg/m3 over the area; it makes {density:.0f}"
        return Fault("conductor.bare_mass", self.bare_mass, rule)


@dataclass(frozen=True, slots=True)
class CatalogueRow:
    """A conductor of a catalogue: name, the sentence that names its source, and its figures."""

    name: str
    source: str
    data: ConductorData


@dataclass(frozen=True, slots=True)
class KnownConductor:
    """What is given of a conductor, which overrides the row of a catalogue, if there is one."""

    given: ConductorData = ConductorData()
    row: CatalogueRow | None = None


@dataclass(frozen=True, slots=True)
class EverydayState:
    """The bare span at a temperature [degrees Celsius]: one measure of its tension, and the wind on it.

    share_of_rated_strength: horizontal tension over rated strength; horizontal_tension [N]; sag from the chord [m];
    wind_pressure on the diameter [Pa].
    """

    share_of_rated_strength: float | None = None
    horizontal_tension: float | None = None
    sag: float | None = None
    temperature: float | None = None
    wind_pressure: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field and that one measure is given."""
        given = [v for v in (self.share_of_rated_strength, self.horizontal_tension, self.sag) if v is not None]
        rule = "must have exactly one of share_of_rated_strength, horizontal_tension and sag"
        require(
            None if len(given) == 1 else Fault("span.everyday", tuple(given), rule),
            *(positive(f"span.everyday.{name}", getattr(self, name)) for name in ("horizontal_tension", "sag")),
            positive("span.everyday.share_of_rated_strength", self.share_of_rated_strength),
            self._share_fault(),
            finite("span.everyday.temperature", self.temperature),
            not_negative("span.everyday.wind_pressure", self.wind_pressure),
        )

    def _share_fault(self) -> Fault | None:
        share = self.share_of_rated_strength
        if share is None or share < 1.0:
            return None
        slip = f"; {share:g} % is {share / _PERCENT:g}" if share <= _PERCENT else ""
        return Fault("span.everyday.share_of_rated_strength", share, f"must be below 1, as a fraction{slip}")


@dataclass(frozen=True, slots=True)
class KnownSpan:
    """A span whose tension is known in its everyday state.

    length, level_difference, ruling_span [m]; temperature of the iced state [degrees Celsius]; elements: number.
    """

    length: float
    everyday: EverydayState | None = None
    temperature: float | None = None
    ruling_span: float | None = None
    level_difference: float = 0.0
    elements: int = 10


class Reference(StrEnum):
    """The diameter of the line at hand that coefficients of a similar section are referred to."""

    BARE = "bare"
    ICED = "iced"


@dataclass(frozen=True, slots=True)
class KnownAerodynamics:
    """Aerodynamic coefficients, the diameter that they are referred to, and how far they fit the ice at hand.

    reference_diameter [m], or reference, where the section is similar to that of the measurement at any size; neither
    if it is not known. spread: relative half range of all coefficients, for a shape that stands for another one.
    """

    aerodynamics: Aerodynamics
    reference_diameter: float | None = None
    reference: Reference | None = None
    origin: Origin = Origin.GIVEN
    source: str = "as given"
    spread: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        wide = Fault("ice.aerodynamics.spread", self.spread, "must be below 1, which leaves the signs of coefficients")
        twice = self.reference_diameter is not None and self.reference is not None
        require(
            Fault("ice.aerodynamics.reference", self.reference, "must be absent where the reference diameter is given")
            if twice
            else None,
            positive("ice.aerodynamics.reference_diameter", self.reference_diameter),
            not_negative("ice.aerodynamics.spread", self.spread),
            wide if self.spread >= 1.0 else None,
        )


@dataclass(frozen=True, slots=True)
class UnknownShape:
    """Ice of a shape that nobody knows: any of several, none likelier than another, each with its name.

    The first one stands for the line with its values as assumed.
    """

    shapes: tuple[KnownAerodynamics, ...]
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        """Check that there is a shape, and a name for each."""
        counts = len(self.shapes), len(self.names)
        rule = "must hold one shape or more, each with a name"
        require(None if counts[0] == counts[1] > 0 else Fault("ice.aerodynamics", counts, rule))


@dataclass(frozen=True, slots=True)
class KnownIce:
    """Ice by its accretion, or by what it makes of the sub-conductor: mass, inertia and eccentricity with ice.

    mass [kg/m], polar_inertia about the bare centre [kg m], eccentricity_y and eccentricity_z [m] of an iced
    sub-conductor; None with an accretion. Without both there is no ice.
    """

    aerodynamics: KnownAerodynamics | UnknownShape
    accretion: Accretion | None = None
    mass: float | None = None
    polar_inertia: float | None = None
    eccentricity_y: float | None = None
    eccentricity_z: float | None = None
    segments: tuple[IceSegment, ...] = ()

    def __post_init__(self) -> None:
        """Check that an accretion excludes what it computes."""
        require(*(self._excluded() if self.accretion is not None else ()))

    def _excluded(self) -> Iterator[Fault]:
        paths = {
            "conductor.mass": self.mass,
            "conductor.polar_inertia": self.polar_inertia,
            "ice.eccentricity_y": self.eccentricity_y,
            "ice.eccentricity_z": self.eccentricity_z,
        }
        for path, value in paths.items():
            if value is not None:
                yield Fault(path, value, "must be absent with ice.accretion, which it follows from")


@dataclass(frozen=True, slots=True)
class KnownDamping:
    """Structural damping ratios by direction, and what all numbers of loops share."""

    vertical_ratio: float | None = None
    horizontal_ratio: float | None = None
    torsional_ratio: float | None = None
    model: DampingModel = DampingModel.CONSTANT_COEFFICIENT


@dataclass(frozen=True, slots=True)
class KnownLine:
    """A span with everything that is known of it. A `Span` in the place of a `KnownSpan` says its iced tension.

    section: the spans and strings around it, which then hold its ends; phases: those that spacers may tie, by name and
    place, since what differs of them changes nothing of the line.
    """

    conductor: KnownConductor
    bundle: Bundle
    span: KnownSpan | Span
    ice: KnownIce
    supports: Supports = Supports()
    wind: Wind | None = None
    damping: KnownDamping = KnownDamping()
    devices: tuple[Device, ...] = ()
    section: Section | None = None
    phases: tuple[Phase, ...] = ()
