"""Devices mounted on a span."""

from typing import Annotated, Literal

from pydantic import Field

from app.schemas.environment import AT_REST, COEFFICIENTS, AerodynamicsAtRest, AerodynamicsForm
from app.schemas.fields import ON_SPAN, Document, Label, quantity


class Spacer(Document):
    """A rigid spacer."""

    type: Literal["spacer"] = Field(description="Kind of device", examples=["spacer"])
    position: float = quantity("position_m", "Distance from the left support", "m", ON_SPAN, 25.0)
    mass: float = quantity("mass_kg", "Mass", "kg", (0.0, 1e4), 6.5)
    polar_inertia: float = quantity(
        "polar_inertia_kg_m2", "Polar inertia about the reference curve", "kg m2", (0.0, 1e4), 0.4
    )


class DetuningPendulum(Document):
    """A mass on a rigid arm below the reference curve."""

    type: Literal["detuning_pendulum"] = Field(description="Kind of device", examples=["detuning_pendulum"])
    position: float = quantity("position_m", "Distance from the left support", "m", ON_SPAN, 62.94)
    mass: float = quantity("mass_kg", "Mass", "kg", (0.0, 1e4), 12.0)
    arm: float = quantity("arm_m", "Length of the arm from the reference curve", "m", (1e-3, 10.0), 0.35)
    angle: float = quantity(
        "angle_deg", "Angle of the arm from straight down, positive downwind", "deg", (-360.0, 360.0), 0.0, 0.0
    )


class TorsionalDamper(Document):
    """A clamped viscous damper against torsion."""

    type: Literal["torsional_damper"] = Field(description="Kind of device", examples=["torsional_damper"])
    position: float = quantity("position_m", "Distance from the left support", "m", ON_SPAN, 62.94)
    mass: float = quantity("mass_kg", "Mass", "kg", (0.0, 1e4), 20.0)
    polar_inertia: float = quantity(
        "polar_inertia_kg_m2", "Polar inertia about the reference curve", "kg m2", (0.0, 1e4), 0.8
    )
    coefficient: float = quantity(
        "damping_n_m_s", "Moment per angular velocity of the bundle", "N m s", (0.0, 1e6), 15.0
    )


class AirflowSpoiler(Document):
    """A spoiler: a stretch of the span with other aerodynamic coefficients."""

    type: Literal["airflow_spoiler"] = Field(description="Kind of device", examples=["airflow_spoiler"])
    start: float = quantity("from_m", "Start of the stretch", "m", ON_SPAN, 30.0)
    stop: float = quantity("to_m", "End of the stretch", "m", ON_SPAN, 60.0)
    aerodynamics: AerodynamicsForm = Field(
        description="Coefficients of one sub-conductor on the stretch, or a table of measured ones",
        examples=[COEFFICIENTS],
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at rest on the stretch; those of the line if absent",
        examples=[AT_REST],
    )
    mass: float = quantity("mass_kg_per_m", "Added mass per length of a sub-conductor", "kg/m", (0.0, 100.0), 0.3, 0.0)


class InterphaseSpacer(Document):
    """A spacer between two phases, hinged at both; the phases then move together."""

    type: Literal["interphase_spacer"] = Field(description="Kind of device", examples=["interphase_spacer"])
    position: float = quantity("position_m", "Distance from the left support", "m", ON_SPAN, 62.94)
    mass: float = quantity(
        "mass_kg", "Mass of the whole spacer, half of which moves with each phase", "kg", (0.0, 1e4), 30.0
    )
    between: Annotated[list[Label], Field(min_length=2, max_length=2)] = Field(
        description='Names of the two phases that it ties, "this" for the line itself', examples=[["this", "top"]]
    )
    axial_stiffness: float | None = quantity(
        "stiffness_n_per_m", "Stiffness against a change of its length; rigid if null", "N/m", (1.0, 1e12), 1e5, None
    )


Device = Annotated[
    Spacer | DetuningPendulum | AirflowSpoiler | TorsionalDamper | InterphaseSpacer, Field(discriminator="type")
]
