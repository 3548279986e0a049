"""Ice, wind and damping of a span."""

from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from app.reference.source_lines import example
from app.schemas.fields import ICED_MASS, ON_SPAN, Document, quantity
from app.schemas.measured import MeasuredCoefficients

Cubic = Annotated[list[Annotated[float, Field(ge=-1e4, le=1e4)]], Field(min_length=3, max_length=3)]

COEFFICIENTS = example("c11-twin")["ice"]["aerodynamics"]
AT_REST = {"vertical": 0.0, "horizontal": 1.0, "torsional": 0.0}

_ECCENTRICITY = (-0.2, 0.2)
_RATIO = (1e-7, 0.99)


class Aerodynamics(Document):
    """Cubic coefficients a_i1, a_i2, a_i3 of one sub-conductor over the angle of attack in radians."""

    vertical: Cubic = Field(
        description="Vertical coefficients a_y1, a_y2, a_y3 over the angle of attack [1/rad, 1/rad2, 1/rad3]",
        examples=[[-0.1667, -4.0547, 8.3581]],
        json_schema_extra={"x-unit": "1/rad^j"},
    )
    horizontal: Cubic = Field(
        description="Horizontal coefficients a_z1, a_z2, a_z3 over that angle [1/rad, 1/rad2, 1/rad3]",
        examples=[[0.8605, 0.8325, 1.7815]],
        json_schema_extra={"x-unit": "1/rad^j"},
    )
    torsional: Cubic = Field(
        description="Torsional coefficients a_theta1, a_theta2, a_theta3 over that angle [1/rad, 1/rad2, 1/rad3]",
        examples=[[-0.7272, 0.2935, 5.9704]],
        json_schema_extra={"x-unit": "1/rad^j"},
    )
    fitted_range: float | None = quantity(
        "fitted_range_deg", "Largest angle of attack for which the coefficients hold", "deg", (1e-3, 180.0), 20.0, None
    )


def _form(value: object) -> str:
    tabulated = isinstance(value, MeasuredCoefficients) or (isinstance(value, dict) and "table" in value)
    return "measured" if tabulated else "coefficients"


AerodynamicsForm = Annotated[
    Annotated[Aerodynamics, Tag("coefficients")] | Annotated[MeasuredCoefficients, Tag("measured")],
    Discriminator(_form),
]
"""Cubic coefficients, or a table of measured ones to fit; coefficients from a table follow the static twist."""


class AerodynamicsAtRest(Document):
    """Coefficients at the static angle, which the relative-wind model needs."""

    vertical: float = quantity("vertical", "Vertical coefficient a_y0", "1", (-1e3, 1e3), 0.0)
    horizontal: float = quantity("horizontal", "Horizontal coefficient a_z0", "1", (-1e3, 1e3), 1.0)
    torsional: float = quantity("torsional", "Torsional coefficient a_theta0", "1", (-1e3, 1e3), 0.0)


class IceSegment(Document):
    """A stretch with other ice; its fields override those of the span."""

    start: float = quantity("from_m", "Start of the stretch", "m", ON_SPAN, 0.0)
    stop: float = quantity("to_m", "End of the stretch", "m", ON_SPAN, 62.94)
    aerodynamics: AerodynamicsForm | None = Field(
        default=None, description="Coefficients on the stretch, or a table of measured ones", examples=[COEFFICIENTS]
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at rest on the stretch; those of the line if absent",
        examples=[AT_REST],
    )
    eccentricity_y: float | None = quantity(
        "eccentricity_y_m", "Eccentricity upward on the stretch", "m", _ECCENTRICITY, 1e-3, None
    )
    eccentricity_z: float | None = quantity(
        "eccentricity_z_m", "Eccentricity downwind on the stretch", "m", _ECCENTRICITY, 0.0, None
    )
    mass: float | None = quantity(
        "mass_kg_per_m", "Mass per length, iced, on the stretch", "kg/m", ICED_MASS, 2.3, None
    )

    @model_validator(mode="after")
    def _has_coefficients(self) -> Self:
        if self.at_rest is not None and self.aerodynamics is None:
            raise PydanticCustomError("missing", "aerodynamics_at_rest needs aerodynamics in the same segment")
        return self


class Ice(Document):
    """The ice of the span: its mass centre and its aerodynamic coefficients."""

    eccentricity_y: float = quantity(
        "eccentricity_y_m", "Mass centre of the iced section, upward", "m", _ECCENTRICITY, 2.05e-3, 0.0
    )
    eccentricity_z: float = quantity(
        "eccentricity_z_m", "Mass centre of the iced section, downwind", "m", _ECCENTRICITY, -0.63e-3, 0.0
    )
    aerodynamics: AerodynamicsForm = Field(
        description="Coefficients of one iced sub-conductor, or a table of measured ones",
        examples=[COEFFICIENTS],
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at the static angle, for the relative-wind model",
        examples=[AT_REST],
    )
    segments: list[IceSegment] = Field(
        default=[],
        max_length=200,
        description="Stretches with other ice, without overlap",
        examples=[[{"from_m": 0.0, "to_m": 62.94, "mass_kg_per_m": 2.3}]],
    )


class ProfilePoint(Document):
    """The wind at one position, as a multiple of the analysis' wind speed."""

    position: float = quantity("position_m", "Distance from the left support", "m", ON_SPAN, 0.0)
    factor: float = quantity(
        "factor", "Wind speed at this position over the wind speed of the analysis", "1", (0.01, 10.0), 0.7
    )


class BlowOut(Document):
    """The mean drag that swings the plane of the sag downwind."""

    wind_speed: float | None = quantity(
        "wind_speed_m_per_s",
        "Wind speed of the mean drag; if null, each wind speed of the analysis",
        "m/s",
        (0.0, 100.0),
        10.0,
        None,
    )
    drag_coefficient: float | None = quantity(
        "drag_coefficient", "Mean drag coefficient; if null, the horizontal one at rest", "1", (0.0, 10.0), 1.0, None
    )


class Wind(Document):
    """The wind, except its speed."""

    air_density: float = quantity("air_density_kg_per_m3", "Density of the air", "kg/m3", (0.3, 2.0), 1.2929, 1.2929)
    blow_out: BlowOut | None = Field(
        default=None,
        description="Blow-out by the mean drag, if any",
        examples=[{"wind_speed_m_per_s": 10.0, "drag_coefficient": 1.0}],
    )
    yaw: float = quantity(
        "yaw_deg", "Angle between the wind and the horizontal normal of the line", "deg", (-75.0, 75.0), 30.0, 0.0
    )
    profile: list[ProfilePoint] = Field(
        default=[],
        max_length=200,
        description="Wind profile along the span, linear between the points; uniform if empty",
        examples=[[{"position_m": 0.0, "factor": 0.7}, {"position_m": 125.88, "factor": 1.3}]],
    )


class Damping(Document):
    """Structural damping as ratios of critical damping."""

    vertical_ratio: float = quantity("vertical_ratio", "Vertical damping ratio", "1", _RATIO, 0.000515)
    horizontal_ratio: float = quantity("horizontal_ratio", "Horizontal damping ratio", "1", _RATIO, 0.000515)
    torsional_ratio: float = quantity("torsional_ratio", "Torsional damping ratio", "1", _RATIO, 0.308)
    model: Literal["constant_coefficient", "constant_ratio"] = Field(
        default="constant_coefficient",
        description="Quantity that is the same for every number of loops",
        examples=["constant_coefficient"],
    )
