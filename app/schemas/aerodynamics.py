"""Fits of measured coefficients: the table that comes in, and the coefficients that go out, ready for a line's ice."""

from itertools import pairwise

from pydantic import Field, field_validator
from pydantic_core import PydanticCustomError

from app.schemas.answers import DenHartog
from app.schemas.environment import COEFFICIENTS, Aerodynamics, AerodynamicsAtRest
from app.schemas.fields import Answer, Document, example_of, quantity, told

FULL_TURN = (-360.0, 360.0)
_COEFFICIENT = (-1e3, 1e3)
_ROW = {"angle_deg": 40.0, "lift": 0.31, "drag": 1.18, "moment": -0.12}


class CoefficientRow(Document):
    """What was measured at one angle, of one iced sub-conductor."""

    angle: float = quantity("angle_deg", "Angle of the ice against the wind", "deg", FULL_TURN, 40.0)
    lift: float = quantity("lift", "Lift coefficient, positive upward, over the diameter", "1", _COEFFICIENT, 0.31)
    drag: float = quantity("drag", "Drag coefficient, positive downwind, over the diameter", "1", _COEFFICIENT, 1.18)
    moment: float = quantity("moment", "Moment coefficient, over the squared diameter", "1", _COEFFICIENT, -0.12)


class FitRequest(Document):
    """A table of measured coefficients, and the angle about which they are fitted."""

    table: list[CoefficientRow] = Field(
        min_length=5, max_length=10_000, description="Rows in the order of rising angles", examples=[[_ROW] * 5]
    )
    static_angle: float = quantity(
        "static_angle_deg", "Angle at which the ice rests: alpha is counted from it", "deg", FULL_TURN, 40.0
    )
    half_range: float = quantity(
        "half_range_deg", "Rows within this angle of the static one are used", "deg", (0.01, 180.0), 20.0
    )

    @field_validator("table")
    @classmethod
    def _rising(cls, table: list[CoefficientRow]) -> list[CoefficientRow]:
        for number, (before, here) in enumerate(pairwise(table), start=1):
            if not before.angle < here.angle:
                found = {"number": number, "angle": here.angle, "before": before.angle}
                message = "angles must rise, but row {number} (from 0) has {angle} after {before}"
                raise PydanticCustomError("rising", message, found)
        return table


class FitResidual(Answer):
    """Root mean square of what the cubics leave of the measured coefficients."""

    vertical: float = told("Of C_y [1]", 0.012)
    horizontal: float = told("Of C_z [1]", 0.009)
    torsional: float = told("Of C_theta [1]", 0.004)


class DenHartogRow(Answer):
    """Den Hartog's criterion at one row of the table."""

    angle_deg: float = told("Angle of the row [deg]", 40.0)
    coefficient: float = told("dC_L/dalpha + C_D there, by central differences [1/rad]", -0.15)
    unstable: bool = told("Whether the coefficient is negative", True)


class FitAnswer(Answer):
    """Cubics about the static angle; the first two members can be put into a line's `ice` as they are."""

    aerodynamics: Aerodynamics = told(
        "Coefficients, with the range of angles for which they hold", {**COEFFICIENTS, "fitted_range_deg": 20.0}
    )
    aerodynamics_at_rest: AerodynamicsAtRest = told(
        "Constant terms, which the relative-wind model needs", {"vertical": 0.31, "horizontal": 1.18, "torsional": 0.1}
    )
    residual: FitResidual = told("What the fit leaves", example_of(FitResidual))
    rows_used: int = told("Rows of the table within the range [1]", 21)
    den_hartog: DenHartog = told("Den Hartog's criterion of the fit, at the static angle", example_of(DenHartog))
    den_hartog_over_angle: list[DenHartogRow] = told("The same over the whole table", [example_of(DenHartogRow)])
