"""One iced span as a whole, and the rules that concern several of its parts."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from engine.outcome import Fault, require
from engine.spec.climate import Climate
from engine.spec.devices import Device, InterphaseSpacer, StretchDevice
from engine.spec.environment import Aerodynamics, Damping, Ice, IceSegment, Wind
from engine.spec.phases import Phase, phase_faults
from engine.spec.rules import overlap_faults, positive
from engine.spec.section import Section
from engine.spec.span import Bundle, Conductor, Span, Support, Supports


@dataclass(frozen=True, slots=True)
class Line:
    """One iced span with everything that its motion depends on, or the span of interest of a section of spans.

    phases: other phases and wires of the same span, which clearances are taken to and interphase spacers tie; climate:
    how its winds and its icing are spread over the year, which no motion depends on; required_clearance: the smallest
    distance that phases must keep which say none themselves [m]; design_wind: the wind speed at which the verdict is
    put [m/s].

    Raises
    ------
    InvalidSpec
        If a position lies off the span, devices overlap, the eccentricity is too large for the polar inertia, the
        blow-out has no drag, the section does not hold the span, or phases coincide or are not those that spacers tie.
    """

    conductor: Conductor
    bundle: Bundle
    span: Span
    ice: Ice
    wind: Wind
    damping: Damping
    supports: Supports = Supports()
    devices: tuple[Device, ...] = ()
    section: Section | None = None
    phases: tuple[Phase, ...] = ()
    climate: Climate | None = None
    required_clearance: float | None = None
    design_wind: float | None = None

    def __post_init__(self) -> None:
        """Check positions, overlaps of devices, that inertia is positive, that drag is known, and the section."""
        require(
            *self._position_faults(),
            *overlap_faults(self._stretches_by_field()),
            *self._inertia_faults(),
            self._drag_fault(),
            *self._section_faults(),
            *phase_faults(self),
            positive("required_clearance", self.required_clearance),
            positive("design_wind", self.design_wind),
        )

    @property
    def stretches(self) -> tuple[StretchDevice, ...]:
        """The parts of the devices that act on a stretch."""
        return tuple(part for device in self.devices for part in device.stretches)

    @property
    def interphase_spacers(self) -> tuple[InterphaseSpacer, ...]:
        """The devices that tie it to other phases."""
        return tuple(device for device in self.devices if isinstance(device, InterphaseSpacer))

    @property
    def coefficients(self) -> Iterator[tuple[str, Aerodynamics]]:
        """The coefficients of the span, its ice segments and its devices, with the path of what owns them."""
        yield "ice", self.ice.aerodynamics
        owners: list[tuple[str, IceSegment | StretchDevice]] = []
        owners += [(f"ice.segments.{i}", segment) for i, segment in enumerate(self.ice.segments)]
        owners += [(f"devices.{i}", part) for i, device in enumerate(self.devices) for part in device.stretches]
        yield from ((path, owner.aerodynamics) for path, owner in owners if owner.aerodynamics is not None)

    @property
    def has_table(self) -> bool:
        """Whether any coefficients come from a measured table."""
        return any(owner.measured is not None for _, owner in self.coefficients)

    def curve_faults(self) -> Iterator[Fault]:
        """Check that every measured table is a curve over its angles, which only some analyses need."""
        for path, owner in self.coefficients:
            if owner.measured is not None:
                for fault in owner.measured.curve_faults():
                    yield replace(fault, field=f"{path}.aerodynamics.{fault.field}")

    @property
    def follows_wind(self) -> bool:
        """Whether the blow-out is that of each wind speed, so that the static state depends on it."""
        return self.wind.blow_out is not None and self.wind.blow_out.wind_speed is None

    def blown_out_at(self, wind_speed: float) -> "Line":
        """Return the line with its blow-out at a given wind speed [m/s]."""
        if self.wind.blow_out is None:
            return self
        return replace(self, wind=replace(self.wind, blow_out=replace(self.wind.blow_out, wind_speed=wind_speed)))

    def _stretches_by_field(self) -> Iterator[tuple[str, float, float]]:
        for i, device in enumerate(self.devices):
            yield from ((f"devices.{i}", part.start, part.stop) for part in device.stretches)

    def _position_faults(self) -> Iterator[Fault]:
        ends = [(f"ice.segments.{i}.stop", segment.stop) for i, segment in enumerate(self.ice.segments)]
        ends += [(f"wind.profile.{i}.position", position) for i, (position, _) in enumerate(self.wind.profile)]
        ends += [(f"devices.{i}.{device.end[0]}", device.end[1]) for i, device in enumerate(self.devices)]
        for name, value in ends:
            if value > self.span.length * (1.0 + 1e-9):
                yield Fault(name, value, f"must lie on the span (its length is {self.span.length})")

    def _inertia_faults(self) -> Iterator[Fault]:
        pieces: list[tuple[str, Ice | IceSegment]] = [("ice", self.ice)]
        pieces += [(f"ice.segments.{i}", segment) for i, segment in enumerate(self.ice.segments)]
        for path, piece in pieces:
            e_y, e_z, mass = ice_properties(self, piece)
            if not self.conductor.polar_inertia > mass * (e_y**2 + e_z**2):
                rule = "must leave the polar inertia about the mass centre positive: I > m (e_y^2 + e_z^2)"
                yield Fault(f"{path}.eccentricity_y", math.hypot(e_y, e_z), rule)

    def _section_faults(self) -> Iterator[Fault]:
        """Check that the section holds this span, and that its supports are those of the section."""
        section = self.section
        if section is None or not 1 <= section.span_of_interest <= len(section.spans):
            return
        path = f"section.spans.{section.span_of_interest - 1}"
        own = section.spans[section.span_of_interest - 1]
        for name in ("length", "level_difference"):
            if getattr(own, name) != getattr(self.span, name):
                rule = f"must be that of the line's span ({getattr(self.span, name)}), which is the span of interest"
                yield Fault(f"{path}.{name}", getattr(own, name), rule)
        for name in ("ice", "profile"):
            if getattr(own, name) is not None:
                yield Fault(f"{path}.{name}", None, "must be absent for the span of interest: the line describes it")
        held = replace(self.supports, left=_dead_end(self.supports.left), right=_dead_end(self.supports.right))
        if held != _DEAD_ENDS:
            rule = "must be absent or dead ends for a section, whose strings are in section.strings"
            yield Fault("supports", None, rule)
        if self.wind.blow_out is not None:
            yield Fault("wind.blow_out", None, "must be absent for a section: its static state is that of still air")

    def _drag_fault(self) -> Fault | None:
        blow_out = self.wind.blow_out
        if blow_out is None or blow_out.drag_coefficient is not None or self.ice.aerodynamics.at_rest is not None:
            return None
        return Fault("wind.blow_out.drag_coefficient", None, "must be given where ice.aerodynamics_at_rest is not")


_DEAD_ENDS = Supports(left=Support(dead_end=True), right=Support(dead_end=True))


def _dead_end(end: Support) -> Support:
    return replace(end, dead_end=True)


def ice_properties(line: Line, piece: Ice | IceSegment) -> tuple[float, float, float]:
    """Return e_y [m], e_z [m] and the mass per length m [kg/m] of one sub-conductor under a piece of ice."""
    e_y = line.ice.eccentricity_y if piece.eccentricity_y is None else piece.eccentricity_y
    e_z = line.ice.eccentricity_z if piece.eccentricity_z is None else piece.eccentricity_z
    own_mass = piece.mass if isinstance(piece, IceSegment) else None
    return e_y, e_z, line.conductor.mass if own_mass is None else own_mass
