"""A search for the placement of devices: which devices, where, and for which objective."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from app.schemas.environment import AT_REST, COEFFICIENTS, AerodynamicsAtRest, AerodynamicsForm
from app.schemas.fields import ON_SPAN, Document, quantity


class Range(Document):
    """A lowest and a highest value; equal values fix the quantity."""

    lowest: float
    highest: float

    @model_validator(mode="after")
    def _rising(self) -> Self:
        if self.lowest > self.highest:
            raise PydanticCustomError("rising", "lowest must be at most highest")
        return self

    @property
    def pair(self) -> tuple[float, float]:
        """Return both values."""
        return self.lowest, self.highest


class PositionRange(Range):
    """Positions from the left support."""

    lowest: float = quantity("lowest", "Nearest to the left support", "m", ON_SPAN, 10.0)
    highest: float = quantity("highest", "Farthest from the left support", "m", ON_SPAN, 115.0)


class MassRange(Range):
    """Masses of one pendulum."""

    lowest: float = quantity("lowest", "Lightest", "kg", (0.0, 1e4), 5.0)
    highest: float = quantity("highest", "Heaviest", "kg", (0.0, 1e4), 20.0)


class ArmRange(Range):
    """Lengths of the arm."""

    lowest: float = quantity("lowest", "Shortest", "m", (1e-3, 10.0), 0.2)
    highest: float = quantity("highest", "Longest", "m", (1e-3, 10.0), 0.5)


_POSITIONS = {"lowest": 10.0, "highest": 115.0}
_MASSES = {"lowest": 5.0, "highest": 20.0}
_ARMS = {"lowest": 0.2, "highest": 0.5}
_PENDULUMS = {"type": "detuning_pendulum", "count": 2, "position_m": _POSITIONS, "mass_kg": _MASSES, "arm_m": _ARMS}


class PendulumChoice(Document):
    """Equal pendulums, each at a position within a range."""

    type: Literal["detuning_pendulum"] = Field(description="Kind of device", examples=["detuning_pendulum"])
    count: int = Field(
        ge=1, le=20, description="Number of pendulums [1]", examples=[2], json_schema_extra={"x-unit": "1"}
    )
    position: PositionRange = Field(
        alias="position_m", description="Range of their positions [m]", examples=[_POSITIONS]
    )
    mass: MassRange = Field(alias="mass_kg", description="Range of the mass, equal for all [kg]", examples=[_MASSES])
    arm: ArmRange = Field(alias="arm_m", description="Range of the arm's length, equal for all [m]", examples=[_ARMS])
    angle: float = quantity(
        "angle_deg", "Angle of the arm from straight down, positive downwind", "deg", (-360.0, 360.0), 0.0, 0.0
    )


class SpoilerChoice(Document):
    """One airflow spoiler of given length, at a position within a range."""

    type: Literal["airflow_spoiler"] = Field(description="Kind of device", examples=["airflow_spoiler"])
    length: float = quantity("length_m", "Length along the span", "m", (0.1, ON_SPAN[1]), 30.0)
    position: PositionRange = Field(
        alias="position_m",
        description="Range within which it begins and ends [m]",
        examples=[{"lowest": 0.0, "highest": 125.88}],
    )
    aerodynamics: AerodynamicsForm = Field(
        description="Coefficients of one sub-conductor on the spoiler, or a table of measured ones",
        examples=[COEFFICIENTS],
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at rest on the spoiler",
        examples=[AT_REST],
    )
    mass: float = quantity("mass_kg_per_m", "Added mass per length of a sub-conductor", "kg/m", (0.0, 100.0), 0.3, 0.0)


class Placement(Document):
    """Which devices to place, for which objective, and how long to search."""

    choice: Annotated[PendulumChoice | SpoilerChoice, Field(discriminator="type")] = Field(
        alias="device", description="Devices to place in addition to those of the line", examples=[_PENDULUMS]
    )
    objective: Literal["highest_critical_wind_speed", "lowest_amplitude"] = Field(
        default="highest_critical_wind_speed",
        description="For the hybrid model over all loops: the lowest onset, or the largest stable amplitude",
        examples=["lowest_amplitude"],
    )
    generations: int = Field(
        default=20,
        ge=1,
        le=200,
        description="Most generations of the search [1]",
        examples=[20],
        json_schema_extra={"x-unit": "1"},
    )
    population: int = Field(
        default=24,
        ge=5,
        le=200,
        description="Candidates a generation [1]",
        examples=[24],
        json_schema_extra={"x-unit": "1"},
    )
    seed: int = Field(
        default=0,
        ge=0,
        le=2**31,
        description="Seed of the random search; equal seeds give equal results [1]",
        examples=[0],
        json_schema_extra={"x-unit": "1"},
    )
    separation: float | None = quantity(
        "separation_m",
        "Smallest distance of placed devices from one another and from those of the line, spacers apart; a twentieth "
        "of the span if null",
        "m",
        ON_SPAN,
        6.0,
        None,
    )


EXAMPLE = {"device": _PENDULUMS, "objective": "highest_critical_wind_speed"}
