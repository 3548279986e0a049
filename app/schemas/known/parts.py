"""Conductor, bundle and span as an engineer knows them."""

from typing import Any, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from app.schemas.fields import LENGTH_LIMIT_M, Document, Label, quantity
from app.schemas.line import Bundle, Conductor, Position, Span

_TEMPERATURE = (-60.0, 60.0)
_EVERYDAY = {"temperature_c": 15.0, "share_of_rated_strength": 0.2}


def as_in(model: type[Document], name: str) -> Any:
    """Declare a field as another document has it, but not required."""
    field = model.model_fields[name]
    bounds = {key: getattr(mark, key) for mark in field.metadata for key in ("ge", "le") if hasattr(mark, key)}
    return Field(
        default=None,
        alias=field.alias,
        description=field.description,
        examples=field.examples,
        json_schema_extra=field.json_schema_extra,
        **bounds,
    )


class KnownConductor(Document):
    """One sub-conductor: named, or by its figures, which override those of the name."""

    catalogue: Label | None = Field(
        default=None,
        description="Name or designation of an own conductor or of one in the catalogue",
        examples=["Drake"],
    )
    diameter: float | None = as_in(Conductor, "diameter")
    axial_rigidity: float | None = as_in(Conductor, "axial_rigidity")
    area: float | None = as_in(Conductor, "area")
    aluminium_area: float | None = quantity(
        "aluminium_area_m2", "Area of the wires of aluminium", "m2", (1e-7, 0.01), 4.028e-4, None
    )
    youngs_modulus: float | None = as_in(Conductor, "youngs_modulus")
    torsional_rigidity: float | None = as_in(Conductor, "torsional_rigidity")
    axial_torsional_coupling: float | None = as_in(Conductor, "axial_torsional_coupling")
    mass: float | None = as_in(Conductor, "mass")
    polar_inertia: float | None = as_in(Conductor, "polar_inertia")
    bare_mass: float | None = quantity(
        "bare_mass_kg_per_m", "Mass per length without ice", "kg/m", (0.01, 100.0), 1.628, None
    )
    bare_polar_inertia: float | None = quantity(
        "bare_polar_inertia_kg_m", "Polar inertia per length without ice", "kg m", (1e-8, 10.0), 1.5e-4, None
    )
    rated_strength: float | None = as_in(Conductor, "rated_strength")
    thermal_expansion: float | None = quantity(
        "thermal_expansion_per_k", "Thermal expansion", "1/K", (1e-6, 1e-4), 1.88e-5, None
    )
    aluminium_wires: int | None = Field(
        default=None, ge=1, le=200, description="Number of wires of aluminium [1]", examples=[26]
    )
    steel_wires: int | None = Field(
        default=None, ge=0, le=200, description="Number of wires of steel [1]", examples=[7]
    )


class KnownBundle(Document):
    """The sub-conductors: as in a line, or by their distance and arrangement."""

    subconductors: int | None = as_in(Bundle, "subconductors")
    radius: float | None = as_in(Bundle, "radius")
    orientation: float | None = as_in(Bundle, "orientation")
    positions: list[Position] | None = Field(
        default=None,
        alias="positions_m",
        min_length=1,
        max_length=32,
        description=Bundle.model_fields["positions"].description,
        examples=Bundle.model_fields["positions"].examples,
        json_schema_extra={"x-unit": "m"},
    )
    spacing: float | None = quantity("spacing_m", "Distance of neighbours on the circle", "m", (0.01, 5.0), 0.457, None)
    arrangement: (
        Literal["horizontal", "vertical", "triangle", "inverted_triangle", "square", "diamond", "polygon"] | None
    ) = Field(
        default=None,
        description="Arrangement with this spacing; if null, horizontal for two, one below for three, square for four",
        examples=["horizontal"],
    )
    section: Literal["rigid", "free"] | None = Field(
        default=None, description=Bundle.model_fields["section"].description, examples=["free"]
    )

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        circle = self.radius is not None or self.orientation is not None
        spaced = self.spacing is not None or self.arrangement is not None
        if sum((circle, spaced, self.positions is not None)) > 1:
            ways = "radius_m with orientation_deg, spacing_m with arrangement, and positions_m"
            raise PydanticCustomError("exactly_one", "give one of {ways}", {"ways": ways})
        if self.subconductors is None and self.positions is None:
            raise PydanticCustomError("missing", "subconductors is needed for a regular bundle")
        if self.subconductors is not None and self.positions is not None:
            raise PydanticCustomError("exactly_one", "give either subconductors or positions_m")
        return self


class Everyday(Document):
    """The bare span at a temperature, with one measure of its tension."""

    temperature: float | None = quantity(
        "temperature_c", "Temperature; if null, 15 °C is assumed", "degC", _TEMPERATURE, 15.0, None
    )
    share_of_rated_strength: float | None = quantity(
        "share_of_rated_strength", "Horizontal tension over rated strength", "1", (1e-3, 100.0), 0.2, None
    )
    horizontal_tension: float | None = quantity(
        "horizontal_tension_n", "Horizontal tension of one sub-conductor", "N", (10.0, 1e6), 28000.0, None
    )
    sag: float | None = quantity("sag_m", "Sag from the chord at mid-span", "m", (1e-3, 1000.0), 6.5, None)
    wind_pressure: float = quantity(
        "wind_pressure_pa", "Pressure of the wind on the diameter", "Pa", (0.0, 1e4), 0.0, 0.0
    )

    @model_validator(mode="after")
    def _one_measure(self) -> Self:
        measures = (self.share_of_rated_strength, self.horizontal_tension, self.sag)
        if sum(value is not None for value in measures) != 1:
            ways = "share_of_rated_strength, horizontal_tension_n and sag_m"
            raise PydanticCustomError("exactly_one", "give exactly one of {ways}", {"ways": ways})
        return self


class KnownSpan(Document):
    """A span by its iced tension as in a line, or by its everyday state, which if absent is assumed."""

    length: float = quantity("length_m", "Horizontal length", "m", (1.0, LENGTH_LIMIT_M), 300.0)
    horizontal_tension: float | None = as_in(Span, "horizontal_tension")
    catenary_parameter: float | None = as_in(Span, "catenary_parameter")
    sag: float | None = as_in(Span, "sag")
    level_difference: float = quantity(
        "level_difference_m",
        "Height of the right support above the left one",
        "m",
        (-LENGTH_LIMIT_M, LENGTH_LIMIT_M),
        0.0,
        0.0,
    )
    ruling_span: float | None = quantity(
        "ruling_span_m", "Ruling span of the section", "m", (1.0, LENGTH_LIMIT_M), 305.0, None
    )
    temperature: float | None = quantity(
        "temperature_c", "Temperature under ice; if null, -3 °C is assumed", "degC", _TEMPERATURE, -5.0, None
    )
    everyday: Everyday | None = Field(
        default=None, description="The bare span on an ordinary day", examples=[_EVERYDAY]
    )
    elements: int = Field(
        default=10, ge=2, le=100, description="Finite elements [1]", examples=[10], json_schema_extra={"x-unit": "1"}
    )

    @property
    def is_iced(self) -> bool:
        """Whether the tension under ice is said."""
        return any(value is not None for value in (self.horizontal_tension, self.catenary_parameter, self.sag))

    @model_validator(mode="after")
    def _one_measure(self) -> Self:
        iced = (self.horizontal_tension, self.catenary_parameter, self.sag)
        everyday = (self.ruling_span, self.temperature, self.everyday)
        if sum(value is not None for value in iced) + any(value is not None for value in everyday) > 1:
            ways = "horizontal_tension_n, catenary_parameter_m and sag_m under ice, and everyday with its temperatures"
            raise PydanticCustomError("exactly_one", "give one of {ways}", {"ways": ways})
        return self
