"""Measured coefficients over the angle of the ice, to fit alone or to give in a line instead of cubics."""

from itertools import pairwise

from pydantic import Field, field_validator
from pydantic_core import PydanticCustomError

from app.schemas.fields import Document, Label, quantity

FULL_TURN = (-360.0, 360.0)
_COEFFICIENT = (-1e3, 1e3)
_ROW = {"angle_deg": 40.0, "lift": 0.31, "drag": 1.18, "moment": -0.12}


class CoefficientRow(Document):
    """The coefficients measured at one angle, for one iced sub-conductor."""

    angle: float = quantity("angle_deg", "Angle of the ice to the wind", "deg", FULL_TURN, 40.0)
    lift: float = quantity("lift", "Lift coefficient, positive upward, over the diameter", "1", _COEFFICIENT, 0.31)
    drag: float = quantity("drag", "Drag coefficient, positive downwind, over the diameter", "1", _COEFFICIENT, 1.18)
    moment: float = quantity("moment", "Moment coefficient, over the squared diameter", "1", _COEFFICIENT, -0.12)


class MeasuredCoefficients(Document):
    """A table of measured coefficients, and the angle about which they are fitted."""

    table: list[CoefficientRow] = Field(
        min_length=5, max_length=10_000, description="Rows in order of increasing angle", examples=[[_ROW] * 5]
    )
    static_angle: float = quantity(
        "static_angle_deg", "Angle of the ice at rest, from which alpha is measured", "deg", FULL_TURN, 40.0
    )
    half_range: float = quantity(
        "half_range_deg", "Largest distance from the static angle of the rows to fit", "deg", (0.01, 180.0), 20.0
    )

    @field_validator("table")
    @classmethod
    def _rising(cls, table: list[CoefficientRow]) -> list[CoefficientRow]:
        for number, (before, here) in enumerate(pairwise(table), start=1):
            if not before.angle < here.angle:
                found = {"number": number, "angle": here.angle, "before": before.angle}
                message = "angles must increase, but row {number} (from 0) has {angle} after {before}"
                raise PydanticCustomError("rising", message, found)
        return table


class OwnTable(MeasuredCoefficients):
    """A table of measured coefficients that an owner keeps, to name in lines."""

    name: Label = Field(description='Name for `{"catalogue": name}` in a line\'s `aerodynamics`', examples=["Our D"])
    reference_diameter: float | None = quantity(
        "reference_diameter_m",
        "Diameter to which the coefficients refer: forces over it, moments over its square; the bare one if null",
        "m",
        (1e-3, 0.5),
        0.0286,
        None,
    )
    source: Label | None = Field(
        default=None, description="Where the table comes from", examples=["wind tunnel, report 12, Reynolds number 4e4"]
    )
