"""The ice as an engineer knows it: its accretion, and coefficients that may be borrowed by name."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from app.schemas.environment import Aerodynamics, AerodynamicsAtRest, Ice, IceSegment
from app.schemas.fields import Document, Label, quantity
from app.schemas.known.parts import as_in
from app.schemas.line import Position
from app.schemas.measured import FULL_TURN, MeasuredCoefficients

ACCRETION = {"shape": "crescent", "thickness_m": 0.012, "density_kg_per_m3": 900.0, "angle_deg": 270.0}
_REFERENCE = "Diameter to which the coefficients refer: forces over it, moments over its square"


class Accretion(Document):
    """Ice by its shape and how much of it there is."""

    shape: Literal["uniform", "crescent", "d_shape", "profile"] = Field(
        description="Outline of the ice", examples=["crescent"]
    )
    thickness: float | None = quantity("thickness_m", "Largest radial thickness", "m", (1e-5, 0.3), 0.012, None)
    mass: float | None = quantity(
        "mass_kg_per_m", "Alternatively, mass of the ice per length", "kg/m", (1e-4, 100.0), 0.75, None
    )
    kind: Literal["glaze", "wet_snow", "hard_rime", "soft_rime"] | None = Field(
        default=None, description="Kind of ice, whose usual density is taken; if null, glaze", examples=["glaze"]
    )
    density: float | None = quantity("density_kg_per_m3", "Density of the ice", "kg/m3", (50.0, 1000.0), 900.0, None)
    angle: float | None = quantity(
        "angle_deg",
        "Direction of the thickest point, clockwise from straight up; if null, windward (270)",
        "deg",
        FULL_TURN,
        270.0,
        None,
    )
    points: list[Position] | None = Field(
        default=None,
        alias="points_m",
        min_length=3,
        max_length=1000,
        description="Outline of a profile: points (y up, z downwind) about the centre of the conductor [m]",
        examples=[[[0.02, 0.0], [0.0, 0.02], [-0.02, 0.0], [0.0, -0.02]]],
        json_schema_extra={"x-unit": "m"},
    )


class CatalogueShape(Document):
    """An ice shape of the catalogue, or an own table, by its name."""

    catalogue: Label = Field(description="Name of an own table or of a shape in the catalogue", examples=["c11-40"])
    angle: float | None = quantity(
        "angle_deg",
        "Angle of the ice; a shape of the catalogue has one only, an own table is fitted at it",
        "deg",
        FULL_TURN,
        40.0,
        None,
    )
    reference_diameter: float | None = quantity("reference_diameter_m", _REFERENCE, "m", (1e-3, 0.5), 0.0286, None)


class KnownCubics(Aerodynamics):
    """Cubic coefficients as in a line, with the diameter to which they refer."""

    reference_diameter: float | None = quantity("reference_diameter_m", _REFERENCE, "m", (1e-3, 0.5), 0.0286, None)


class KnownTable(MeasuredCoefficients):
    """Measured coefficients as in a line, with the diameter to which they refer."""

    reference_diameter: float | None = quantity("reference_diameter_m", _REFERENCE, "m", (1e-3, 0.5), 0.0286, None)


def _form(value: object) -> str:
    if isinstance(value, CatalogueShape) or (isinstance(value, dict) and "catalogue" in value):
        return "named"
    tabulated = isinstance(value, MeasuredCoefficients) or (isinstance(value, dict) and "table" in value)
    return "measured" if tabulated else "coefficients"


KnownAerodynamics = Annotated[
    Annotated[KnownCubics, Tag("coefficients")]
    | Annotated[KnownTable, Tag("measured")]
    | Annotated[CatalogueShape, Tag("named")],
    Discriminator(_form),
]


class KnownIce(Document):
    """The ice by its accretion, or by mass centre (with the conductor's iced mass and inertia) as in a line."""

    eccentricity_y: float | None = as_in(Ice, "eccentricity_y")
    eccentricity_z: float | None = as_in(Ice, "eccentricity_z")
    accretion: Accretion | None = Field(default=None, description="Shape and amount of the ice", examples=[ACCRETION])
    aerodynamics: KnownAerodynamics | None = Field(
        default=None,
        description="Coefficients, a measured table, or the name of a shape; if null, the shape is not known: any of "
        "`GET /v1/ice-shapes` is assumed, and samples draw among them",
        examples=[{"catalogue": "c11-40"}],
    )
    at_rest: AerodynamicsAtRest | None = Field(
        default=None,
        alias="aerodynamics_at_rest",
        description="Coefficients at the static angle",
        examples=[{"vertical": 0.0, "horizontal": 1.0, "torsional": 0.0}],
    )
    segments: list[IceSegment] = Field(
        default=[],
        max_length=200,
        description="Stretches with other ice, without overlap",
        examples=[[{"from_m": 0.0, "to_m": 62.94, "mass_kg_per_m": 2.3}]],
    )
