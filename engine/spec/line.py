"""One iced span as a whole, and the rules that concern several of its parts."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from engine.outcome import Fault, require
from engine.spec.devices import Device, StretchDevice
from engine.spec.environment import Aerodynamics, Damping, Ice, IceSegment, Wind
from engine.spec.rules import overlap_faults
from engine.spec.span import Bundle, Conductor, Span, Supports


@dataclass(frozen=True, slots=True)
class Line:
    """One iced span with everything that its motion depends on.

    Raises
    ------
    InvalidSpec
        If a position lies off the span, devices overlap, the eccentricity is too large for the polar inertia, or the
        blow-out has no drag.
    """

    conductor: Conductor
    bundle: Bundle
    span: Span
    ice: Ice
    wind: Wind
    damping: Damping
    supports: Supports = Supports()
    devices: tuple[Device, ...] = ()

    def __post_init__(self) -> None:
        """Check positions on the span, overlaps of devices, that inertia is positive and that drag is known."""
        require(
            *self._position_faults(),
            *overlap_faults(self._stretches_by_field()),
            *self._inertia_faults(),
            self._drag_fault(),
        )

    @property
    def stretches(self) -> tuple[StretchDevice, ...]:
        """The parts of the devices that act on a stretch."""
        return tuple(part for device in self.devices for part in device.stretches)

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

    def _drag_fault(self) -> Fault | None:
        blow_out = self.wind.blow_out
        if blow_out is None or blow_out.drag_coefficient is not None or self.ice.aerodynamics.at_rest is not None:
            return None
        return Fault("wind.blow_out.drag_coefficient", None, "must be given where ice.aerodynamics_at_rest is not")


def ice_properties(line: Line, piece: Ice | IceSegment) -> tuple[float, float, float]:
    """Return e_y [m], e_z [m] and the mass per length m [kg/m] of one sub-conductor under a piece of ice."""
    e_y = line.ice.eccentricity_y if piece.eccentricity_y is None else piece.eccentricity_y
    e_z = line.ice.eccentricity_z if piece.eccentricity_z is None else piece.eccentricity_z
    own_mass = piece.mass if isinstance(piece, IceSegment) else None
    return e_y, e_z, line.conductor.mass if own_mass is None else own_mass
