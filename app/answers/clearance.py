"""Answers about the clearance that computed motions and ellipses leave between two phases."""

from typing import Literal

from pydantic import Field

from app.schemas.fields import Answer, described, example_of


class MotionClearance(Answer):
    """The space that one computed cycle takes where it is observed, and the clearance if both phases gallop alike."""

    model: Literal["hybrid", "finite_element"] = described("Model that the row comes from", "hybrid")
    loops: int = described("Loops per span [1]", 1)
    wind_speed_m_per_s: float = described("Wind speed [m/s]", 6.0)
    branch: int | None = described("Family of cycles", 0)
    kind: str = described("Kind of motion", "periodic")
    stability: str = described("Stability of the motion", "stable")
    observed_at_m: float = described("Observation point, from the left support [m]", 62.94)
    height_m: float = described("Height of the space that the sub-conductors sweep [m]", 0.5769)
    width_m: float = described("Width of the space that the sub-conductors sweep [m]", 0.526)
    clearance_m: float = described(
        "Distance between the envelopes of both phases; negative if they overlap [m]", 3.4231
    )


class EllipseClearance(Answer):
    """The ellipse of design practice at mid-loop, and its clearance; nulls if the method predicts no galloping."""

    method: Literal["davison", "toye", "cigre", "aeso"] = described("Method that gives the ellipse", "davison")
    major_axis_m: float | None = described("Major axis, peak to peak [m]", 2.2313)
    minor_axis_m: float | None = described("Minor axis [m]", 0.8925)
    b_m: float | None = described("Distance of the ellipse's foot below the resting conductor [m]", 0.3853)
    clearance_m: float | None = described(
        "Distance between the ellipses of both phases; negative if they overlap [m]", 1.7687
    )


class Clearance(Answer):
    """Clearance between two phases."""

    motions: list[MotionClearance] = Field(description="Every computed cycle", examples=[[example_of(MotionClearance)]])
    ellipse: EllipseClearance = described("The ellipse of design practice", example_of(EllipseClearance))
