"""What a line segment of CIM is made of: its wire, its bundle, and where the other phases hang beside it."""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from app.exchange.rdf import CimModel, CimObject, bare
from app.reference import conductors
from app.schemas.faults import Fault

_NAME = frozenset({"IdentifiedObject.name"})
_WIRE_KINDS = frozenset({"WireInfo", "OverheadWireInfo"})
_CABLE_KINDS = frozenset({"CableInfo", "ConcentricNeutralCableInfo", "TapeShieldCableInfo"})
_SPACING_KINDS = frozenset({"WireSpacingInfo", "WireSpacing"})
_SPACING_NAMES = ("WireSpacingInfo", "WireSpacing")
_NEUTRAL = frozenset({"N", "none", ""})
_TO_SPACING = ("WirePosition.WireSpacingInfo", "WirePosition.WireSpacing")

WIRES: Mapping[str, frozenset[str]] = {
    **dict.fromkeys(sorted(_WIRE_KINDS), _NAME | {"WireInfo.radius", "WireInfo.sizeDescription"}),
    **dict.fromkeys(sorted(_CABLE_KINDS), _NAME),
    **dict.fromkeys(
        sorted(_SPACING_KINDS),
        _NAME
        | {f"{kind}.{name}" for kind in _SPACING_NAMES for name in ("phaseWireCount", "phaseWireSpacing", "isCable")},
    ),
    "WirePosition": _NAME
    | set(_TO_SPACING)
    | {f"WirePosition.{name}" for name in ("xCoord", "yCoord", "phase", "sequenceNumber")},
    "ACLineSegmentPhase": frozenset(
        {
            "ACLineSegmentPhase.ACLineSegment",
            "ACLineSegmentPhase.WireInfo",
            "ACLineSegmentPhase.phase",
            "ACLineSegmentPhase.sequenceNumber",
            "PowerSystemResource.AssetDatasheet",
        }
    ),
}
"""The classes that are read here, and their attributes."""


@dataclass(slots=True)
class MadeOf:
    """Fields of a line, what they were called, and what is wrong; refusal: why a segment can be no line."""

    document: dict[str, Any] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)
    refusal: str | None = None


@dataclass(frozen=True, slots=True)
class _Wire:
    """Where a wire hangs: its phase or none, distance to the side and height [m]."""

    name: str
    is_neutral: bool
    x: float
    y: float


class Wires:
    """Wires, spacings and phases of a model, ready to be looked up."""

    def __init__(self, model: CimModel, has_conductor: bool) -> None:
        """Take a model; has_conductor: whether the defaults say a conductor."""
        self._model = model
        self._has_conductor = has_conductor
        self._phases: dict[str, list[CimObject]] = defaultdict(list)
        self._positions: dict[str, list[CimObject]] = defaultdict(list)
        for phase in model.all_of(frozenset({"ACLineSegmentPhase"})):
            for link in phase.links.get("ACLineSegmentPhase.ACLineSegment", ()):
                self._phases[bare(link)].append(phase)
        for position in model.all_of(frozenset({"WirePosition"})):
            for name in _TO_SPACING:
                for link in position.links.get(name, ()):
                    self._positions[bare(link)].append(position)

    def of(self, segment: CimObject, of_assets: Sequence[str]) -> MadeOf:
        """Return what a segment is made of, from its data sheets, those of its phases, and those of its assets."""
        own = [*segment.links.get("ACLineSegment.WireSpacingInfo", ()), *_sheets(segment), *of_assets]
        phases = self._phases.get(bare(segment.identity), ())
        live = [phase for phase in phases if phase_of(phase, "ACLineSegmentPhase.phase") not in _NEUTRAL] or phases
        for phase in live:
            own += [*phase.links.get("ACLineSegmentPhase.WireInfo", ()), *_sheets(phase)]
        found = {bare(link): self._model.objects.get(bare(link)) for link in own}
        sheets = [sheet for sheet in found.values() if sheet is not None]
        made = MadeOf()
        wires = [sheet for sheet in sheets if sheet.kind in _WIRE_KINDS]
        spacing = next((sheet for sheet in sheets if sheet.kind in _SPACING_KINDS), None)
        if any(sheet.kind in _CABLE_KINDS for sheet in sheets) or (spacing is not None and _is_cable(spacing)):
            made.refusal = "is a cable, which does not gallop"
        self._add_wire(made, wires)
        if spacing is not None:
            _add_bundle(made, spacing)
            self._add_phases(made, spacing, phases)
        return made

    def _add_wire(self, made: MadeOf, wires: Sequence[CimObject]) -> None:
        if len(wires) > 1:
            named = " and ".join(wire.texts.get("IdentifiedObject.name", wire.identity)[:80] for wire in wires[:2])
            detail = f"the phases have different wires, {named}; send them as segments of their own"
            made.faults.append(Fault("/conductor", "several_wires", detail))
        if len(wires) != 1:
            return
        (wire,) = wires
        texts = (wire.texts.get(name) for name in ("WireInfo.sizeDescription", "IdentifiedObject.name"))
        names = [text for text in texts if text]
        known = next((name for name in names if conductors.named(name)), None)
        if known is None and names and not self._has_conductor:
            known = names[-1]
        conductor: dict[str, Any] = {} if known is None else {"catalogue": known}
        radius, fault = number(wire, "WireInfo.radius", "/conductor/diameter_m")
        if fault is not None:
            made.faults.append(fault)
        elif radius is not None:
            conductor["diameter_m"] = 2.0 * radius
            made.sources["/conductor/diameter_m"] = f"twice WireInfo.radius of {wire.identity[:80]}"
        made.sources["/conductor/catalogue"] = f"the name of {wire.kind} {wire.identity[:80]}"
        if conductor:
            made.document["conductor"] = conductor

    def _add_phases(self, made: MadeOf, spacing: CimObject, phases: Iterable[CimObject]) -> None:
        letters = {
            phase.texts.get("ACLineSegmentPhase.sequenceNumber"): phase_of(phase, "ACLineSegmentPhase.phase")
            for phase in phases
        }
        hung: list[_Wire] = []
        for position in self._positions.get(bare(spacing.identity), ()):
            order = position.texts.get("WirePosition.sequenceNumber")
            letter = phase_of(position, "WirePosition.phase") or letters.get(order) or ""
            x, wrong_x = number(position, "WirePosition.xCoord", "/phases")
            y, wrong_y = number(position, "WirePosition.yCoord", "/phases")
            made.faults += [fault for fault in (wrong_x, wrong_y) if fault is not None]
            name = letter or f"wire {order or len(hung) + 1}"
            hung.append(_Wire(name, letter in _NEUTRAL and bool(letter), x or 0.0, y or 0.0))
        if len(hung) > 1:
            made.document["phases"] = _beside(hung)
            made.sources["/phases"] = f"WirePositions of {spacing.identity[:80]}"


def number(found: CimObject, attribute: str, pointer: str) -> tuple[float | None, Fault | None]:
    """Return a number, None if it is absent, or the fault of a text that is none."""
    text = found.texts.get(attribute)
    if text is None:
        return None, None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isfinite(value):
        return value, None
    detail = f"{attribute} of {found.identity[:80]} must be a number, got {text[:60]!r}"
    return None, Fault(pointer, "cim_value", detail)


def phase_of(found: CimObject, attribute: str) -> str:
    """Return the letter of a phase: the end of an enumeration's address, or the text itself."""
    links = found.links.get(attribute)
    return links[0].rpartition(".")[2] if links else found.texts.get(attribute, "").rpartition(".")[2]


def _sheets(found: CimObject) -> Sequence[str]:
    return found.links.get("PowerSystemResource.AssetDatasheet", ())


def _of_spacing(spacing: CimObject, name: str) -> str | None:
    return next((key for kind in _SPACING_NAMES if (key := f"{kind}.{name}") in spacing.texts), None)


def _is_cable(spacing: CimObject) -> bool:
    key = _of_spacing(spacing, "isCable")
    return key is not None and spacing.texts[key].lower() == "true"


def _add_bundle(made: MadeOf, spacing: CimObject) -> None:
    key = _of_spacing(spacing, "phaseWireCount")
    if key is None:
        return
    count, fault = number(spacing, key, "/bundle/subconductors")
    if fault is None and count is not None and not count.is_integer():
        fault = Fault("/bundle/subconductors", "cim_value", f"{key} must be a whole number, got {count:g}")
    if fault is not None or count is None:
        made.faults += [fault] if fault is not None else []
        return
    made.document["bundle"] = {"subconductors": int(count)}
    made.sources["/bundle/subconductors"] = f"{key} of {spacing.identity[:80]}"
    distance = _of_spacing(spacing, "phaseWireSpacing")
    if distance is not None and count > 1.0:
        value, fault = number(spacing, distance, "/bundle/spacing_m")
        made.faults += [fault] if fault is not None else []
        made.document["bundle"]["spacing_m"] = value
        made.sources["/bundle/spacing_m"] = f"{distance} of {spacing.identity[:80]}"


def _beside(hung: Sequence[_Wire]) -> list[dict[str, Any]]:
    """Return the other wires seen from the phase in the middle: the one with the least distance to the others."""
    live = [wire for wire in hung if not wire.is_neutral] or list(hung)
    own = min(live, key=lambda wire: sum(math.hypot(wire.x - other.x, wire.y - other.y) for other in live))
    names: set[str] = set()
    beside = []
    for wire in hung:
        if wire is own:
            continue
        name = wire.name if wire.name not in names else f"{wire.name} {len(names) + 1}"
        names.add(name)
        beside.append({"name": name, "y_m": round(wire.y - own.y, 6), "z_m": round(wire.x - own.x, 6)})
    return beside
