"""The climate of a line: how the wind blows where it is iced, and how often and how long it is iced."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from engine.outcome import Fault, require
from engine.spec.rules import finite, not_negative, positive

TURN = 2.0 * math.pi
YEAR_HOURS = 8766.0  # 365.25 days
_SHARES = 1e-6  # by which the shares of the sectors may miss one
_PERCENT = 100.0


@dataclass(frozen=True, slots=True)
class Ranged:
    """A value with the ends between which it lies; an end that is not known is the value itself."""

    value: float
    lowest: float | None = None
    highest: float | None = None

    @property
    def ends(self) -> tuple[float, float]:
        """The lowest and the highest value."""
        low = self.value if self.lowest is None else self.lowest
        return low, self.value if self.highest is None else self.highest

    def faults(self, name: str) -> Iterator[Fault | None]:
        """Check that the ends enclose the value; `name` is that of its field."""
        low, high = self.ends
        for end, at in (("lowest", low), ("highest", high)):
            yield finite(f"{name}_{end}", at)
        yield None if low <= self.value else Fault(f"{name}_lowest", low, f"must not exceed the value ({self.value:g})")
        yield None if high >= self.value else Fault(f"{name}_highest", high, f"must reach the value ({self.value:g})")


@dataclass(frozen=True, slots=True)
class WindSector:
    """The wind from one sector, as a Weibull distribution of the speeds U: P(U > u) = exp(-(u / scale)^shape).

    direction: the middle of the sector, from which the wind comes, clockwise from north [rad]; share of the time; scale
    [m/s]; width [rad], over which the direction is spread evenly, None for an equal part of the circle.
    """

    direction: float
    share: float
    shape: Ranged
    scale: Ranged
    width: float | None = None

    def faults(self, path: str) -> Iterator[Fault | None]:
        """Check the rules of every field."""
        yield finite(f"{path}.direction", self.direction)
        yield not_negative(f"{path}.share", self.share)
        for name, ranged in (("shape", self.shape), ("scale", self.scale)):
            yield positive(f"{path}.{name}", ranged.value)
            yield positive(f"{path}.{name}_lowest", ranged.lowest)
            yield from ranged.faults(f"{path}.{name}")
        yield not_negative(f"{path}.width", self.width)


@dataclass(frozen=True, slots=True)
class Icing:
    """How often and how long the line is iced by one kind of ice: hours a year, or events a year and their duration.

    kind: what it is called; thickness [m]; hours [h/year]; events [1/year]; event_hours [h], the duration of an event;
    persistence [h], for which the wind of an event keeps to one speed; None where it is not known.
    """

    kind: str
    thickness: float | None = None
    hours: Ranged | None = None
    events: Ranged | None = None
    event_hours: Ranged | None = None
    persistence: Ranged | None = None

    @property
    def hours_a_year(self) -> Ranged:
        """Hours of icing a year."""
        if self.hours is not None:
            return self.hours
        assert self.events is not None and self.event_hours is not None, "checked when it is made"
        low, high = (a * b for a, b in zip(self.events.ends, self.event_hours.ends, strict=True))
        return Ranged(self.events.value * self.event_hours.value, low, high)

    def faults(self, path: str) -> Iterator[Fault | None]:
        """Check the rules of every field, and that one form is given."""
        yield positive(f"{path}.thickness", self.thickness)
        by_events = self.events is not None and self.event_hours is not None
        either = (self.hours is not None) != by_events and (self.events is None) == (self.event_hours is None)
        rule = "must have either hours, or events with event_hours"
        yield None if either else Fault(path, None, rule)
        for name in ("hours", "events", "event_hours", "persistence"):
            ranged: Ranged | None = getattr(self, name)
            if ranged is not None:
                rule_of = positive if name in ("event_hours", "persistence") else not_negative
                yield rule_of(f"{path}.{name}", ranged.value)
                yield rule_of(f"{path}.{name}_lowest", ranged.lowest)
                yield from ranged.faults(f"{path}.{name}")


@dataclass(frozen=True, slots=True)
class IcedRecord:
    """Iced hours of a weather record: for each event of icing, the wind across the line in each of its hours [m/s].

    years: length of the record without what is missing in it.
    """

    years: float
    events: tuple[tuple[float, ...], ...]

    def faults(self, path: str) -> Iterator[Fault | None]:
        """Check the rules of every field, and that the hours fit into the years."""
        yield positive(f"{path}.years", self.years)
        rule = "must hold an event: a record without icing does not say how long icing lasts"
        yield None if self.events else Fault(f"{path}.events", (), rule)
        for i, winds in enumerate(self.events):
            yield None if winds else Fault(f"{path}.events.{i}", (), "must hold an hour")
            yield from (not_negative(f"{path}.events.{i}.{j}", wind) for j, wind in enumerate(winds))
        hours = sum(map(len, self.events))
        if hours > self.years * YEAR_HOURS:
            yield Fault(f"{path}.years", self.years, f"must hold the {hours} hours of the events")


@dataclass(frozen=True, slots=True)
class Climate:
    """The wind by sector while the line is iced, at its height, and the icing; or a record of iced hours.

    azimuth: direction of the line, clockwise from north [rad]; which way along the line does not matter.

    Raises
    ------
    InvalidSpec
        If a field breaks its rule, the shares of the sectors do not make one, or the icing lasts longer than the year.
    """

    azimuth: float
    sectors: tuple[WindSector, ...] = ()
    icing: tuple[Icing, ...] = ()
    record: IcedRecord | None = None

    def __post_init__(self) -> None:
        """Check every field and what they make together."""
        if self.record is not None:
            rule = "must be absent with a record of iced hours"
            require(
                finite("climate.azimuth", self.azimuth),
                Fault("climate.sectors", len(self.sectors), rule) if self.sectors else None,
                Fault("climate.icing", len(self.icing), rule) if self.icing else None,
                *self.record.faults("climate.record"),
            )
            return
        require(
            finite("climate.azimuth", self.azimuth),
            None if self.sectors else Fault("climate.sectors", (), "must hold a sector"),
            None if self.icing else Fault("climate.icing", (), "must hold a kind of icing"),
            *(fault for i, part in enumerate(self.sectors) for fault in part.faults(f"climate.sectors.{i}")),
            *(fault for i, part in enumerate(self.icing) for fault in part.faults(f"climate.icing.{i}")),
        )
        require(self._share_fault(), self._width_fault(), self._hours_fault())

    def width(self, sector: WindSector) -> float:
        """Return the width of a sector [rad]."""
        return TURN / len(self.sectors) if sector.width is None else sector.width

    def _share_fault(self) -> Fault | None:
        total = math.fsum(sector.share for sector in self.sectors)
        if abs(total - 1.0) <= _SHARES * len(self.sectors):
            return None
        slip = "; it looks like percent: 12 % is 0.12" if abs(total - _PERCENT) <= 1.0 else ""
        return Fault("climate.sectors", total, f"must have shares that sum to 1{slip}")

    def _width_fault(self) -> Fault | None:
        total = math.fsum(self.width(sector) for sector in self.sectors)
        if total > TURN * (1.0 + 1e-9):
            rule = "must have widths that do not make more than the full circle together"
            return Fault("climate.sectors", math.degrees(total), f"{rule}, in degrees")
        step = TURN / len(self.sectors)
        turns = sorted((sector.direction - self.sectors[0].direction) % TURN for sector in self.sectors)
        even = all(abs(turn - i * step) <= 1e-6 for i, turn in enumerate(turns))
        if even or all(sector.width is not None for sector in self.sectors):
            return None
        return Fault("climate.sectors", None, "must have a width each, because their directions are not evenly spread")

    def _hours_fault(self) -> Fault | None:
        total = math.fsum(icing.hours_a_year.ends[1] for icing in self.icing)
        if total <= YEAR_HOURS:
            return None
        return Fault("climate.icing", total, f"must not last longer than the year ({YEAR_HOURS:g} hours), all together")
