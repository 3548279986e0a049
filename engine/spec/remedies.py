"""Remedies against galloping that are compared with doing nothing, placed by search or as given."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

from engine.outcome import Fault, InvalidSpec, require
from engine.spec.analysis import Analysis, check_compatible
from engine.spec.devices import (
    AirflowSpoiler,
    DetuningPendulum,
    Device,
    InterphaseSpacer,
    PointDevice,
    Spacer,
    TorsionalDamper,
)
from engine.spec.line import Line
from engine.spec.placement import room_fault, separation_on
from engine.spec.rules import not_negative, positive

RemedyKind = Literal[
    "detuning_pendulum",
    "spacer",
    "torsional_damper",
    "interphase_spacer",
    "airflow_spoiler",
    "moved",
    "tension",
]
MOST_DEVICES = 20
MOST_REMEDIES = 20
_OWN_FIELDS = {"between": "between", "position": "positions", "stop": "position"}  # of a device -> of its remedy
NAMES: dict[type[PointDevice], RemedyKind] = {
    DetuningPendulum: "detuning_pendulum",
    Spacer: "spacer",
    TorsionalDamper: "torsional_damper",
    InterphaseSpacer: "interphase_spacer",
}


@dataclass(frozen=True, slots=True)
class AddedDevices:
    """Equal devices at points, as `device` whatever its position; positions [m], None to search for them."""

    device: PointDevice
    count: int
    positions: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        """Check the number of devices and their positions."""
        require(*_count_faults(self.count, self.positions))

    @property
    def kind(self) -> RemedyKind:
        """The name of the remedy."""
        return NAMES[type(self.device)]

    def on(self, line: Line, places: Sequence[float]) -> Line:
        """Return a line with the devices at these places [m]."""
        added = tuple(replace(self.device, position=place) for place in sorted(places))
        return replace(line, devices=(*line.devices, *added))


@dataclass(frozen=True, slots=True)
class AddedSpoiler:
    """One spoiler of the length of `spoiler`; middle of its stretch [m], None to search for it."""

    spoiler: AirflowSpoiler
    middle: float | None = None
    count: int = 1

    @property
    def kind(self) -> RemedyKind:
        """The name of the remedy."""
        return "airflow_spoiler"

    @property
    def length(self) -> float:
        """Length along the span [m]."""
        return self.spoiler.stop - self.spoiler.start

    @property
    def positions(self) -> tuple[float, ...] | None:
        """The middle of the spoiler [m], None to search for it."""
        return None if self.middle is None else (self.middle,)

    def on(self, line: Line, places: Sequence[float]) -> Line:
        """Return a line with the middle of the spoiler at this place [m], as near as it fits onto the span."""
        (middle,) = places
        start = min(max(middle - 0.5 * self.length, 0.0), line.span.length - self.length)
        added: Device = replace(self.spoiler, start=start, stop=min(start + self.length, line.span.length))
        return replace(line, devices=(*line.devices, added))


@dataclass(frozen=True, slots=True)
class MovedDevices:
    """The line's devices of one class elsewhere: positions [m] from left to right, None to search for them."""

    moved: type[PointDevice]
    positions: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        """Check the positions."""
        require(*(_count_faults(len(self.positions), self.positions) if self.positions is not None else ()))

    @property
    def kind(self) -> RemedyKind:
        """The name of the remedy."""
        return "moved"

    def devices(self, line: Line) -> list[PointDevice]:
        """Return the devices that move, from left to right."""
        found = [device for device in line.devices if isinstance(device, self.moved)]
        return sorted(found, key=lambda device: device.position)

    def on(self, line: Line, places: Sequence[float]) -> Line:
        """Return a line whose devices of this class stand at these places [m], in the same order."""
        moving = self.devices(line)
        kept = tuple(device for device in line.devices if not isinstance(device, self.moved))
        moved = (replace(device, position=place) for device, place in zip(moving, sorted(places), strict=True))
        return replace(line, devices=(*kept, *moved))


@dataclass(frozen=True, slots=True)
class ChangedTension:
    """Another horizontal tension: a factor on the one there is, or its value [N].

    It is that of the everyday state where that is known, else that under ice.
    """

    factor: float | None = None
    horizontal_tension: float | None = None

    def __post_init__(self) -> None:
        """Check that one measure is given."""
        both = (self.factor is None) == (self.horizontal_tension is None)
        require(
            positive("factor", self.factor),
            positive("horizontal_tension", self.horizontal_tension),
            Fault("factor", self.factor, "must be given, or the horizontal tension, and not both") if both else None,
        )

    @property
    def kind(self) -> RemedyKind:
        """The name of the remedy."""
        return "tension"

    def of(self, tension: float) -> float:
        """Return what a horizontal tension becomes [N]."""
        return self.horizontal_tension if self.factor is None else self.factor * tension  # type: ignore[return-value]


Placed = AddedDevices | AddedSpoiler | MovedDevices
Remedy = Placed | ChangedTension


@dataclass(frozen=True, slots=True)
class Remedies:
    """What to try, None for what is usual; separation: in a search, between devices and from supports [m].

    Without a separation it is a twentieth of the span.
    """

    tried: tuple[Remedy, ...] | None
    separation: float | None = None

    def __post_init__(self) -> None:
        """Check that there is a remedy and not too many."""
        count = 1 if self.tried is None else len(self.tried)
        require(
            None if 1 <= count <= MOST_REMEDIES else Fault("tried", count, f"must hold 1 to {MOST_REMEDIES} remedies"),
            not_negative("separation", self.separation),
        )


def check_remedies(line: Line, analysis: Analysis, remedies: Remedies) -> None:
    """Check that every remedy fits the line, the analysis and the separation.

    Raises
    ------
    InvalidSpec
        With the number of the remedy in the path: `tried.0.positions`.
    """
    check_compatible(line, analysis)
    faults = [
        fault if fault.field == "separation" else replace(fault, field=f"tried.{i}.{fault.field}")
        for i, remedy in enumerate(remedies.tried or ())
        if not isinstance(remedy, ChangedTension)
        for fault in _faults_of(remedy, line, analysis, remedies.separation)
    ]
    require(*faults)


def _faults_of(remedy: Placed, line: Line, analysis: Analysis, separation: float | None) -> Iterator[Fault]:
    count = len(remedy.devices(line)) if isinstance(remedy, MovedDevices) else remedy.count
    if count == 0:
        yield Fault("device", None, "must be a device that the line has")
        return
    evenly = [line.span.length * (i + 1) / (count + 1) for i in range(count)]
    if remedy.positions is None:
        yield from _search_faults(remedy, count, line, separation_on(line, separation))
    elif len(remedy.positions) != count:
        yield Fault("positions", remedy.positions, f"must hold as many positions as the line has devices ({count})")
        return
    else:
        yield from _separation_faults(remedy.positions, separation)
    yield from _changed_faults(remedy, remedy.positions or evenly, line, analysis)


def _search_faults(remedy: Placed, count: int, line: Line, separation: float) -> Iterator[Fault]:
    length = line.span.length
    if line.section is not None:
        yield Fault("positions", None, "must be given for a section of spans, on which no places are searched")
    if isinstance(remedy, AddedSpoiler):
        if line.stretches:
            yield Fault("positions", None, "must be given on a line that has a spoiler")
        return
    fault = room_fault("separation", count, (separation, length - separation), separation)
    if fault is not None:
        yield fault


def _separation_faults(positions: Sequence[float], separation: float | None) -> Iterator[Fault]:
    """Yield a fault where given positions contradict a given separation."""
    if separation is None:
        return
    rising = sorted(positions)
    if any(right - left < separation * (1.0 - 1e-9) for left, right in pairwise(rising)):
        yield Fault("positions", tuple(positions), f"must be {separation:g} m or more apart, as the separation says")


def _changed_faults(remedy: Placed, places: Sequence[float], line: Line, analysis: Analysis) -> Iterator[Fault]:
    """Yield what is wrong with the changed line, at the places of the remedy."""
    if isinstance(remedy, AddedSpoiler) and remedy.length > line.span.length:
        yield Fault("length", remedy.length, f"must fit onto the span ({line.span.length} m)")
        return
    try:
        check_compatible(remedy.on(line, places), analysis)
    except InvalidSpec as error:
        for fault in error.faults:
            yield replace(fault, field=_OWN_FIELDS.get(fault.field.rsplit(".", 1)[-1], ""))


def _count_faults(count: int, positions: tuple[float, ...] | None) -> Iterator[Fault | None]:
    yield None if 1 <= count <= MOST_DEVICES else Fault("count", count, f"must be from 1 to {MOST_DEVICES}")
    if positions is None:
        return
    if len(positions) != count:
        yield Fault("count", count, f"must be the number of positions ({len(positions)}), or absent")
    yield from (not_negative(f"positions.{i}", place) for i, place in enumerate(positions))
