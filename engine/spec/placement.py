"""The request for a placement search: the devices to place, the ranges to search, and the objective."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar, Literal

from engine.outcome import Fault, require
from engine.spec.analysis import Analysis
from engine.spec.devices import AirflowSpoiler, DetuningPendulum, Device
from engine.spec.environment import Aerodynamics
from engine.spec.line import Line
from engine.spec.rules import finite, not_negative, positive

Range = tuple[float, float]
SPAN_PARTS = 20  # a separation that is not given is the span's length over this
Placeable = Literal["detuning_pendulum", "airflow_spoiler"]


class Objective(StrEnum):
    """The quantity that the search optimizes."""

    HIGHEST_CRITICAL_WIND_SPEED = "highest_critical_wind_speed"
    LOWEST_AMPLITUDE = "lowest_amplitude"


@dataclass(frozen=True, slots=True)
class PendulumChoice:
    """A number of equal pendulums: ranges of position [m], mass [kg] and arm [m], and a fixed angle [rad]."""

    type: ClassVar[Placeable] = "detuning_pendulum"

    count: int
    position: Range
    mass: Range
    arm: Range
    angle: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            None if 1 <= self.count <= 20 else Fault("count", self.count, "must be from 1 to 20"),
            *_range_faults("position", self.position),
            *_range_faults("mass", self.mass),
            *_range_faults("arm", self.arm),
            positive("arm.lowest", self.arm[0]),
            finite("angle", self.angle),
        )

    def bounds(self, separation: float) -> tuple[Range, ...]:
        """Return the ranges of the unknowns: a number for each position [m], the mass [kg], the arm [m].

        In rising order these numbers are the positions less the room that the pendulums to the left take, so that
        pendulums at any numbers within the ranges are `separation` [m] or more apart.
        """
        last = self.position[1] - (self.count - 1) * separation
        return (*((self.position[0], last) for _ in range(self.count)), self.mass, self.arm)

    def devices(self, unknowns: Sequence[float], separation: float) -> tuple[Device, ...]:
        """Return the devices for given unknowns, from left to right."""
        *numbers, mass, arm = unknowns
        positions = [number + i * separation for i, number in enumerate(sorted(numbers))]
        return tuple(DetuningPendulum(position, mass, arm, self.angle) for position in positions)

    def unknowns(self, positions: Sequence[float], share: float, separation: float) -> tuple[float, ...]:
        """Return the unknowns of positions [m], with mass and arm at a share of their ranges, 0 to 1."""
        numbers = [position - i * separation for i, position in enumerate(sorted(positions))]
        mass, arm = (low + share * (high - low) for low, high in (self.mass, self.arm))
        return (*numbers, mass, arm)


@dataclass(frozen=True, slots=True)
class SpoilerChoice:
    """One spoiler of fixed length [m] within a range of positions [m]; mass is per sub-conductor [kg/m]."""

    type: ClassVar[Placeable] = "airflow_spoiler"

    length: float
    position: Range
    aerodynamics: Aerodynamics
    mass: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        too_long = self.length > self.position[1] - self.position[0]
        require(
            positive("length", self.length),
            *_range_faults("position", self.position),
            Fault("length", self.length, "must fit into the range of positions") if too_long else None,
            not_negative("mass", self.mass),
        )

    count: ClassVar[int] = 1

    def bounds(self, separation: float) -> tuple[Range, ...]:
        """Return the range of the only unknown, the start of the spoiler [m]."""
        del separation
        return ((self.position[0], self.position[1] - self.length),)

    def devices(self, unknowns: Sequence[float], separation: float) -> tuple[Device, ...]:
        """Return the spoiler that starts there."""
        del separation
        (start,) = unknowns
        return (AirflowSpoiler(start, start + self.length, self.aerodynamics, self.mass),)

    def unknowns(self, positions: Sequence[float], share: float, separation: float) -> tuple[float, ...]:
        """Return the unknown of a spoiler whose middle is as near as it can be to a position [m]."""
        del share
        (middle,) = positions
        ((low, high),) = self.bounds(separation)
        return (min(max(middle - 0.5 * self.length, low), high),)


@dataclass(frozen=True, slots=True)
class Placement:
    """The devices to place, the objective, and the effort: generations, members of each, and the random seed.

    separation: smallest distance of placed devices from one another and from those of the line [m]; None for a
    twentieth of the span.
    """

    choice: PendulumChoice | SpoilerChoice
    objective: Objective = Objective.HIGHEST_CRITICAL_WIND_SPEED
    generations: int = 20
    population: int = 24
    seed: int = 0
    separation: float | None = None

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            not_negative("separation", self.separation),
            None if self.generations >= 1 else Fault("generations", self.generations, "must be at least 1"),
            None if self.population >= 5 else Fault("population", self.population, "must be at least 5"),
            None if self.seed >= 0 else Fault("seed", self.seed, "must be at least 0"),
        )


def separation_on(line: Line, given: float | None) -> float:
    """Return the distance to keep between devices [m]: the given one, else a twentieth of the span."""
    return line.span.length / SPAN_PARTS if given is None else given


def room_fault(field: str, count: int, stretch: Range, separation: float) -> Fault | None:
    """Return a fault if a number of devices has no room on a stretch [m] at a separation [m]."""
    room, needed = stretch[1] - stretch[0], (count - 1) * separation
    if needed <= room:
        return None
    rule = f"must leave room: {count} devices {separation:g} m apart need {needed:g} m, and there are {room:g} m"
    return Fault(field, separation, rule)


def check_placement(line: Line, analysis: Analysis, placement: Placement) -> None:
    """Check that a placement fits its line and its analysis.

    Raises
    ------
    InvalidSpec
        If the range of positions leaves the span or has no room for the devices, a spoiler is to be placed on a line
        that has one, or the objective is an amplitude and the analysis has no wind speeds.
    """
    choice, last = placement.choice, placement.choice.position[1]
    separation = separation_on(line, placement.separation)
    first = choice.devices([lowest for lowest, _ in choice.bounds(separation)], separation)
    second_spoiler = bool(line.stretches) and any(device.stretches for device in first)
    no_wind = placement.objective is Objective.LOWEST_AMPLITUDE and not analysis.wind_speeds
    off_span = f"must lie on the span (its length is {line.span.length})"
    require(
        Fault("choice.position.highest", last, off_span) if last > line.span.length else None,
        room_fault("separation", choice.count, choice.position, separation),
        Fault("choice", None, "must not place a spoiler on a line that has one") if second_spoiler else None,
        Fault("choice", None, "must be for a span alone: devices are not placed on a section")
        if line.section
        else None,
        Fault("choice", None, "must be for a span alone: devices are not placed on phases that spacers tie")
        if line.interphase_spacers
        else None,
        Fault("objective", placement.objective.value, "needs wind speeds in the analysis") if no_wind else None,
    )


def _range_faults(name: str, limits: Range) -> Iterator[Fault | None]:
    yield not_negative(f"{name}.lowest", limits[0])
    yield finite(f"{name}.highest", limits[1])
    rule = f"must not be below the lowest ({limits[0]})"
    yield None if limits[0] <= limits[1] else Fault(f"{name}.highest", limits[1], rule)
