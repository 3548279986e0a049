"""Other phases and wires beside a line, and what those that interphase spacers tie may not be."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from engine.outcome import Fault, InvalidSpec, require
from engine.spec.devices import THIS, InterphaseSpacer
from engine.spec.environment import Ice
from engine.spec.rules import finite, positive

if TYPE_CHECKING:
    from engine.spec.line import Line


@dataclass(frozen=True, slots=True)
class Phase:
    """Another phase or wire of the same span, attached y [m] above and z [m] downwind of the line.

    required_clearance: the smallest distance that it must keep to the line [m]; ice: its own, else that of the line;
    line: all that it is, where it differs from the line, else it is a copy of the line with its devices.
    """

    name: str
    y: float
    z: float
    required_clearance: float | None = None
    ice: Ice | None = None
    line: "Line | None" = None

    def __post_init__(self) -> None:
        """Check name and numbers, and that a line of its own is a single span."""
        require(
            Fault("name", self.name, f'must not be empty or "{THIS}"') if self.name in {"", THIS} else None,
            finite("y", self.y),
            finite("z", self.z),
            positive("required_clearance", self.required_clearance),
            *self._line_faults(),
        )

    def _line_faults(self) -> Iterator[Fault]:
        if self.line is None:
            return
        if self.ice is not None:
            yield Fault("ice", None, "must be absent where the phase has a line of its own, which has its ice")
        if self.line.phases:
            yield Fault("line.phases", len(self.line.phases), "must be absent: all phases stand in one list")
        if self.line.section is not None:
            yield Fault("line.section", None, "must be absent: a phase is a single span")


def own_line(line: "Line", phase: Phase) -> "Line":
    """Return the line of a phase by itself, with its devices but no interphase spacers."""
    own = line if phase.line is None else phase.line
    return replace(
        own,
        ice=own.ice if phase.ice is None else phase.ice,
        devices=tuple(device for device in own.devices if not isinstance(device, InterphaseSpacer)),
        section=None,
        phases=(),
    )


def own_ice_of_tied(line: "Line") -> Iterator[tuple[str, Ice]]:
    """Yield the ice of each phase that moves with the line and has its own, with its path."""
    tied = {name for spacer in line.interphase_spacers for name in spacer.between}
    for i, phase in enumerate(line.phases):
        if phase.name in tied and phase.line is not None:
            yield f"phases.{i}.line.ice", phase.line.ice
        elif phase.name in tied and phase.ice is not None:
            yield f"phases.{i}.ice", phase.ice


def phase_faults(line: "Line") -> Iterator[Fault]:
    """Yield a fault for phases that coincide or share a name, and for spacers that do not fit to the phases."""
    places = [(THIS, 0.0, 0.0, line), *((p.name, p.y, p.z, p.line or line) for p in line.phases)]
    for i, (name, y, z, own) in enumerate(places):
        path = f"phases.{i - 1}"
        if name in {other for other, *_ in places[:i]}:
            yield Fault(f"{path}.name", name, "must be the name of one phase only")
        for other, above, beside, of_other in places[:i]:
            needed = _reach(own) + _reach(of_other)
            if math.hypot(y - above, z - beside) < needed:
                rule = f'must be {needed:.3g} m or more away from "{other}", as far as both bundles reach'
                yield Fault(f"{path}.y", (y, z), rule)
    for i, phase in enumerate(line.phases):
        yield from _ice_faults(line, phase, f"phases.{i}")
    spacers = [(i, device) for i, device in enumerate(line.devices) if isinstance(device, InterphaseSpacer)]
    for i, spacer in spacers:
        for name in spacer.between:
            if name not in {known for known, *_ in places}:
                known = ", ".join(f'"{known}"' for known, *_ in places)
                yield Fault(f"devices.{i}.between", name, f"must be one of the phases that are given: {known}")
    yield from _tied_faults(line, [spacer for _, spacer in spacers])


def _ice_faults(line: "Line", phase: Phase, path: str) -> Iterator[Fault]:
    """Yield what is wrong with the ice of a phase on its conductor and span."""
    if phase.ice is None:
        return
    try:
        own_line(line, phase)
    except InvalidSpec as error:
        for fault in error.faults:
            if fault.field.startswith("ice."):
                yield replace(fault, field=f"{path}.{fault.field}")


def _tied_faults(line: "Line", spacers: Sequence[InterphaseSpacer]) -> Iterator[Fault]:
    """Yield a fault for what phases that move together may not be, or may not differ in."""
    if not spacers:
        return
    if line.section is not None:
        yield Fault("section", None, "must be absent with interphase spacers: they tie single spans")
    if line.wind.blow_out is not None:
        rule = "must be absent with interphase spacers: they tie phases as they hang in still air"
        yield Fault("wind.blow_out", None, rule)
    tied = {name for spacer in spacers for name in spacer.between}
    for i, phase in enumerate(line.phases):
        if phase.name in tied and phase.line is not None:
            yield from _unlike_faults(line, phase.line, f"phases.{i}.line")


def _unlike_faults(line: "Line", own: "Line", path: str) -> Iterator[Fault]:
    if own.span.length != line.span.length:
        yield Fault(f"{path}.span.length", own.span.length, f"must be that of the line ({line.span.length})")
    if own.span.elements != line.span.elements:
        yield Fault(f"{path}.span.elements", own.span.elements, f"must be that of the line ({line.span.elements})")
    count = len(line.bundle.positions)
    if len(own.bundle.positions) != count:
        rule = f"must hold as many sub-conductors as the line ({count}) where an interphase spacer ties them"
        yield Fault(f"{path}.bundle", len(own.bundle.positions), rule)
    if own.wind.blow_out is not None:
        yield Fault(f"{path}.wind.blow_out", None, "must be absent with interphase spacers")
    for i, device in enumerate(own.devices):
        if isinstance(device, InterphaseSpacer):
            yield Fault(f"{path}.devices.{i}", device.between, "must stand in the devices of the line")


def _reach(line: "Line") -> float:
    """Return how far the bare bundle reaches from its reference curve [m]."""
    return max(math.hypot(y, z) for y, z in line.bundle.positions) + 0.5 * line.conductor.diameter
