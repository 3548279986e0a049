"""What computed motions and ellipses leave between two phases."""

from typing import Literal

from pydantic import Field

from app.schemas.fields import Answer, example_of, told


class MotionClearance(Answer):
    """The room that one computed cycle takes where it is observed, and what it leaves if both phases gallop alike."""

    model: Literal["hybrid", "finite_element"] = told("Model that the row comes from", "hybrid")
    loops: int = told("Loops per span [1]", 1)
    wind_speed_m_per_s: float = told("Wind speed [m/s]", 6.0)
    branch: int | None = told("Family of cycles", 0)
    kind: str = told("Kind of motion", "periodic")
    stability: str = told("Whether the motion lasts", "stable")
    observed_at_m: float = told("Where, from the left support [m]", 62.94)
    height_m: float = told("Height of all that the sub-conductors reach [m]", 0.5769)
    width_m: float = told("Width of all that the sub-conductors reach [m]", 0.526)
    clearance_m: float = told("Distance of both phases' envelopes; negative by their overlap [m]", 3.4231)


class EllipseClearance(Answer):
    """The ellipse of design practice at mid-loop, and what it leaves; nulls where the method sees no galloping."""

    method: Literal["davison", "toye", "cigre", "aeso"] = told("Whose ellipse", "davison")
    major_axis_m: float | None = told("Major axis, peak to peak [m]", 2.2313)
    minor_axis_m: float | None = told("Minor axis [m]", 0.8925)
    b_m: float | None = told("How far the foot lies below the resting wire [m]", 0.3853)
    clearance_m: float | None = told("Distance of both phases' ellipses; negative by their overlap [m]", 1.7687)


class Clearance(Answer):
    """Clearance between two phases."""

    motions: list[MotionClearance] = Field(description="Every computed cycle", examples=[[example_of(MotionClearance)]])
    ellipse: EllipseClearance = told("The ellipse beside them", example_of(EllipseClearance))
