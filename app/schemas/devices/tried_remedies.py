"""Remedies to be tried on a line: devices placed by search or as given, devices moved, another tension."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from app.schemas.environment import COEFFICIENTS, AerodynamicsAtRest, AerodynamicsForm
from app.schemas.fields import ON_SPAN, Document, Label, quantity

_MOST = 20
_POINTS = Literal["spacer", "detuning_pendulum", "torsional_damper", "interphase_spacer"]

Place = Annotated[float, Field(ge=ON_SPAN[0], le=ON_SPAN[1])]


def _count(example: int) -> Any:
    return Field(
        default=None,
        ge=1,
        le=_MOST,
        description="Number of devices whose places are searched; absent where positions_m are given [1]",
        examples=[example],
        json_schema_extra={"x-unit": "1"},
    )


def _positions(example: list[float]) -> Any:
    return Field(
        default=None,
        alias="positions_m",
        min_length=1,
        max_length=_MOST,
        description="Distances from the left support; null: searched for [m]",
        examples=[example],
        json_schema_extra={"x-unit": "m"},
    )


class _Added(Document):
    """Equal devices, with a number to search places for, or places."""

    count: int | None
    positions: list[Place] | None

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.count is None) == (self.positions is None):
            raise PydanticCustomError("exactly_one", "give count, to search for places, or positions_m")
        return self


class PendulumsTried(_Added):
    """Equal detuning pendulums; mass and arm are assumed if absent."""

    type: Literal["detuning_pendulum"] = Field(description="Kind of remedy", examples=["detuning_pendulum"])
    count: int | None = _count(3)
    positions: list[Place] | None = _positions([75.0, 150.0, 225.0])
    mass: float = quantity("mass_kg", "Mass of each", "kg", (0.0, 1e4), 20.0, 20.0)
    arm: float = quantity("arm_m", "Length of the arm from the reference curve", "m", (1e-3, 10.0), 0.4, 0.4)
    angle: float = quantity(
        "angle_deg", "Angle of the arm from straight down, positive downwind", "deg", (-360.0, 360.0), 0.0, 0.0
    )


class SpacersTried(_Added):
    """Equal further spacers; mass and inertia are assumed if absent."""

    type: Literal["spacer"] = Field(description="Kind of remedy", examples=["spacer"])
    count: int | None = _count(4)
    positions: list[Place] | None = _positions([60.0, 120.0, 180.0, 240.0])
    mass: float = quantity("mass_kg", "Mass of each", "kg", (0.0, 1e4), 6.5, 6.5)
    polar_inertia: float = quantity(
        "polar_inertia_kg_m2", "Polar inertia about the reference curve", "kg m2", (0.0, 1e4), 0.4, 0.4
    )


class DampersTried(_Added):
    """Equal torsional dampers; what is absent is assumed."""

    type: Literal["torsional_damper"] = Field(description="Kind of remedy", examples=["torsional_damper"])
    count: int | None = _count(2)
    positions: list[Place] | None = _positions([75.0, 225.0])
    mass: float = quantity("mass_kg", "Mass of each", "kg", (0.0, 1e4), 20.0, 20.0)
    polar_inertia: float = quantity(
        "polar_inertia_kg_m2", "Polar inertia about the reference curve", "kg m2", (0.0, 1e4), 0.8, 0.8
    )
    coefficient: float = quantity(
        "damping_n_m_s", "Moment per angular velocity of the bundle", "N m s", (0.0, 1e6), 15.0, 15.0
    )


class InterphaseSpacersTried(_Added):
    """Equal interphase spacers between two phases; a search tries quarter points and mid-span."""

    type: Literal["interphase_spacer"] = Field(description="Kind of remedy", examples=["interphase_spacer"])
    count: int | None = _count(1)
    positions: list[Place] | None = _positions([150.0])
    mass: float = quantity("mass_kg", "Mass of the whole spacer", "kg", (0.0, 1e4), 30.0, 30.0)
    between: Annotated[list[Label], Field(min_length=2, max_length=2)] = Field(
        description='Names of the two phases that they tie, "this" for the line itself', examples=[["this", "top"]]
    )
    axial_stiffness: float | None = quantity(
        "stiffness_n_per_m", "Stiffness against a change of length; rigid if null", "N/m", (1.0, 1e12), 1e5, None
    )


class SpoilerTried(Document):
    """One airflow spoiler. Its coefficients decide what it does and must be given."""

    type: Literal["airflow_spoiler"] = Field(description="Kind of remedy", examples=["airflow_spoiler"])
    length: float = quantity("length_m", "Length along the span", "m", (0.1, ON_SPAN[1]), 60.0)
    position: float | None = quantity(
        "position_m", "Its middle, from the left support; null: searched for", "m", ON_SPAN, 150.0, None
    )
    aerodynamics: AerodynamicsForm = Field(
        description="Coefficients of one sub-conductor on the spoiler, or a table of measured ones",
        examples=[COEFFICIENTS],
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at rest on the spoiler; those of the line if absent",
        examples=[{"vertical": 0.0, "horizontal": 1.0, "torsional": 0.0}],
    )
    mass: float = quantity("mass_kg_per_m", "Added mass per length of a sub-conductor", "kg/m", (0.0, 100.0), 0.3, 0.0)


class DevicesMoved(Document):
    """The line's devices of one kind elsewhere, in the same order."""

    type: Literal["moved"] = Field(description="Kind of remedy", examples=["moved"])
    device: _POINTS = Field(description="Kind of the devices that move", examples=["spacer"])
    positions: list[Place] | None = _positions([60.0, 120.0, 180.0, 240.0])


class TensionTried(Document):
    """Another tension: of the everyday state, if the line says that, else of the iced one."""

    type: Literal["tension"] = Field(description="Kind of remedy", examples=["tension"])
    factor: float | None = quantity("factor", "Times the tension that there is", "1", (0.1, 10.0), 1.2, None)
    horizontal_tension: float | None = quantity(
        "horizontal_tension_n", "Horizontal tension of one sub-conductor", "N", (10.0, 1e6), 33600.0, None
    )

    @model_validator(mode="after")
    def _one_measure(self) -> Self:
        if (self.factor is None) == (self.horizontal_tension is None):
            raise PydanticCustomError("exactly_one", "give factor or horizontal_tension_n")
        return self


RemedyTried = Annotated[
    PendulumsTried | SpacersTried | DampersTried | InterphaseSpacersTried | SpoilerTried | DevicesMoved | TensionTried,
    Field(discriminator="type"),
]
EXAMPLE = {
    "tried": [
        {"type": "detuning_pendulum", "count": 3, "mass_kg": 20.0, "arm_m": 0.4},
        {"type": "detuning_pendulum", "positions_m": [31.47, 94.41], "mass_kg": 15.0, "arm_m": 0.3},
        {"type": "tension", "factor": 1.2},
    ]
}


class Remedies(Document):
    """Remedies to compare with the line as it is, and how far apart a search keeps devices."""

    tried: list[RemedyTried] | None = Field(
        default=None,
        min_length=1,
        max_length=_MOST,
        description="The remedies; null: pendulums, torsional dampers, spacers (interphase spacers with the finite "
        "element model), and the tension a fifth lower and higher, as far as they suit the line",
        examples=[EXAMPLE["tried"]],
    )
    separation: float | None = quantity(
        "separation_m",
        "Smallest distance of searched places from one another, from devices of the line other than spacers, and from "
        "the supports; a twentieth of the span if null",
        "m",
        ON_SPAN,
        6.0,
        None,
    )
