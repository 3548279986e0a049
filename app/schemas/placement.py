"""A search for the places of devices: what is to be placed where, and what it is to reach."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from app.schemas.environment import AT_REST, COEFFICIENTS, AerodynamicsAtRest, AerodynamicsForm
from app.schemas.fields import ON_SPAN, Document, quantity


class _Range(Document):
    """A lowest and a highest value; equal ones keep the quantity as it is."""

    lowest: float
    highest: float

    @model_validator(mode="after")
    def _rising(self) -> Self:
        if self.lowest > self.highest:
            raise PydanticCustomError("rising", "lowest must not be above highest")
        return self

    @property
    def pair(self) -> tuple[float, float]:
        """Both values."""
        return self.lowest, self.highest


class PositionRange(_Range):
    """Positions from the left support."""

    lowest: float = quantity("lowest", "Nearest to the left support", "m", ON_SPAN, 10.0)
    highest: float = quantity("highest", "Farthest from the left support", "m", ON_SPAN, 115.0)


class MassRange(_Range):
    """Masses of one pendulum."""

    lowest: float = quantity("lowest", "Lightest", "kg", (0.0, 1e4), 5.0)
    highest: float = quantity("highest", "Heaviest", "kg", (0.0, 1e4), 20.0)


class ArmRange(_Range):
    """Lengths of the arm."""

    lowest: float = quantity("lowest", "Shortest", "m", (1e-3, 10.0), 0.2)
    highest: float = quantity("highest", "Longest", "m", (1e-3, 10.0), 0.5)


_POSITIONS = {"lowest": 10.0, "highest": 115.0}
_MASSES = {"lowest": 5.0, "highest": 20.0}
_ARMS = {"lowest": 0.2, "highest": 0.5}
_PENDULUMS = {"type": "detuning_pendulum", "count": 2, "position_m": _POSITIONS, "mass_kg": _MASSES, "arm_m": _ARMS}


class PendulumChoice(Document):
    """Equal pendulums, each anywhere within a range."""

    type: Literal["detuning_pendulum"] = Field(description="Kind of device", examples=["detuning_pendulum"])
    count: int = Field(ge=1, le=20, description="Their number [1]", examples=[2], json_schema_extra={"unit": "1"})
    position: PositionRange = Field(alias="position_m", description="Where they may hang [m]", examples=[_POSITIONS])
    mass: MassRange = Field(
        alias="mass_kg", description="What each may weigh, the same for all [kg]", examples=[_MASSES]
    )
    arm: ArmRange = Field(alias="arm_m", description="How long the arms may be, the same for all [m]", examples=[_ARMS])
    angle: float = quantity("angle_deg", "From straight down, positive downwind", "deg", (-360.0, 360.0), 0.0, 0.0)


class SpoilerChoice(Document):
    """One airflow spoiler of given length, anywhere within a range."""

    type: Literal["airflow_spoiler"] = Field(description="Kind of device", examples=["airflow_spoiler"])
    length: float = quantity("length_m", "Length along the span", "m", (0.1, ON_SPAN[1]), 30.0)
    position: PositionRange = Field(
        alias="position_m", description="Where it may begin and end [m]", examples=[{"lowest": 0.0, "highest": 125.88}]
    )
    aerodynamics: AerodynamicsForm = Field(
        description="Coefficients of one sub-conductor on the spoiler, or their table", examples=[COEFFICIENTS]
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at rest on the spoiler",
        examples=[AT_REST],
    )
    mass: float = quantity("mass_kg_per_m", "Added mass per length of a sub-conductor", "kg/m", (0.0, 100.0), 0.3, 0.0)


class Placement(Document):
    """Which devices are to be placed, for which end, and how long the search may go on."""

    choice: Annotated[PendulumChoice | SpoilerChoice, Field(discriminator="type")] = Field(
        alias="device", description="What is to be placed beside the devices of the line", examples=[_PENDULUMS]
    )
    objective: Literal["highest_critical_wind_speed", "lowest_amplitude"] = Field(
        default="highest_critical_wind_speed",
        description="Of the hybrid model, over all loops asked for: the lowest onset, or the largest stable amplitude",
        examples=["lowest_amplitude"],
    )
    generations: int = Field(
        default=20,
        ge=1,
        le=200,
        description="Most generations of the search [1]",
        examples=[20],
        json_schema_extra={"unit": "1"},
    )
    population: int = Field(
        default=24,
        ge=5,
        le=200,
        description="Candidates a generation [1]",
        examples=[24],
        json_schema_extra={"unit": "1"},
    )
    seed: int = Field(
        default=0,
        ge=0,
        le=2**31,
        description="The same seed finds the same places [1]",
        examples=[0],
        json_schema_extra={"unit": "1"},
    )


EXAMPLE = {"device": _PENDULUMS, "objective": "highest_critical_wind_speed"}
