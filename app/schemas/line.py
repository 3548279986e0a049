"""The line document: a utility's data of one span. Attributes have the engine's names, aliases the names in JSON."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from app.reference.source_lines import example
from app.schemas.climate import CLIMATE, Climate
from app.schemas.devices import Device
from app.schemas.environment import Damping, Ice, Wind
from app.schemas.fields import ICED_MASS, LENGTH_LIMIT_M, Document, Label, TagKey, quantity
from app.schemas.section import EXAMPLE as SECTION
from app.schemas.section import Section

_TWIN = example("c11-twin")
_SPACER = {"type": "spacer", "position_m": 62.94, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}

_CLEARANCE = (0.0, 50.0)
_PHASES = [{"name": "top", "y_m": 7.0}, {"name": "ground wire", "y_m": 14.0, "z_m": 1.0, "required_clearance_m": 1.2}]

Position = Annotated[list[Annotated[float, Field(ge=-5.0, le=5.0)]], Field(min_length=2, max_length=2)]


def _one_way(given: list[bool], ways: str) -> None:
    """Check that exactly one of several alternatives is given.

    Raises
    ------
    PydanticCustomError
        If none or several are given.
    """
    if sum(given) != 1:
        raise PydanticCustomError("exactly_one", "give exactly one of {ways}", {"ways": ways})


class Conductor(Document):
    """One iced sub-conductor; mass and inertia include the ice."""

    diameter: float = quantity("diameter_m", "Diameter of the bare sub-conductor", "m", (1e-3, 0.2), 0.0286)
    axial_rigidity: float | None = quantity(
        "axial_rigidity_n",
        "Axial rigidity EA; alternatively give area and Young's modulus",
        "N",
        (1e4, 1e10),
        28418105.8,
        None,
    )
    area: float | None = quantity(
        "area_m2", "Metallic area, with youngs_modulus_pa", "m2", (1e-6, 0.01), 4.2324e-4, None
    )
    youngs_modulus: float | None = quantity(
        "youngs_modulus_pa", "Young's modulus, with area_m2", "Pa", (1e8, 1e12), 4.78033e10, None
    )
    torsional_rigidity: float = quantity("torsional_rigidity_n_m2", "Torsional rigidity GJ", "N m2", (1e-3, 1e5), 101.0)
    axial_torsional_coupling: float = quantity(
        "axial_torsional_coupling_n_m", "Axial-torsional coupling B_T", "N m", (-1e6, 1e6), 0.0, 0.0
    )
    mass: float = quantity("mass_kg_per_m", "Mass per length, iced", "kg/m", ICED_MASS, 2.379)
    polar_inertia: float = quantity(
        "polar_inertia_kg_m",
        "Polar inertia per length about the centre of the bare sub-conductor, iced",
        "kg m",
        (1e-7, 10.0),
        3.334e-4,
    )
    rated_strength: float | None = quantity(
        "rated_strength_n",
        "Rated strength; tensions are then reported as shares of it, too",
        "N",
        (1e2, 1e7),
        140000.0,
        None,
    )

    @model_validator(mode="after")
    def _one_rigidity(self) -> Self:
        pair = [self.area is not None, self.youngs_modulus is not None]
        ways = "axial_rigidity_n, and area_m2 with youngs_modulus_pa"
        _one_way([self.axial_rigidity is not None, any(pair)], ways)
        _one_way([self.axial_rigidity is not None, all(pair)], ways)
        return self


class Bundle(Document):
    """Arrangement of the sub-conductors: regular on a circle, or at given positions."""

    subconductors: int | None = Field(
        default=None,
        ge=1,
        le=12,
        description="Number of sub-conductors on the circle [1]",
        examples=[2],
        json_schema_extra={"x-unit": "1"},
    )
    radius: float | None = quantity(
        "radius_m", "Radius of the circle; 0 or absent for one sub-conductor", "m", (0.0, 5.0), 0.2355, None
    )
    orientation: float | None = quantity(
        "orientation_deg",
        "Angle of the first sub-conductor, clockwise from straight up",
        "deg",
        (-360.0, 360.0),
        90.0,
        None,
    )
    positions: list[Position] | None = Field(
        default=None,
        alias="positions_m",
        min_length=1,
        max_length=32,
        description="Alternatively, positions (y up, z downwind) of the centres about the reference curve [m]",
        examples=[[[0.0, -0.2], [0.0, 0.2]]],
        json_schema_extra={"x-unit": "m"},
    )
    section: Literal["rigid", "free"] | None = Field(
        default=None,
        description="How sub-conductors move along the span: `rigid`, all alike, as if spacers could not yaw or pitch; "
        "`free`, each by itself between the yokes at the ends, which lowers the torsional frequencies; if null, as "
        "the physics of the analysis has it: rigid (source), free (full)",
        examples=["free"],
    )

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        circle = any(value is not None for value in (self.subconductors, self.radius, self.orientation))
        _one_way(
            [circle, self.positions is not None], "subconductors (with radius_m, orientation_deg), and positions_m"
        )
        if self.positions is None and self.subconductors is None:
            raise PydanticCustomError("missing", "subconductors is needed for a regular bundle")
        return self


class Span(Document):
    """A span with exactly one measure of its tension."""

    length: float = quantity("length_m", "Horizontal length", "m", (1.0, LENGTH_LIMIT_M), 125.88)
    horizontal_tension: float | None = quantity(
        "horizontal_tension_n", "Horizontal tension of one iced sub-conductor", "N", (10.0, 1e6), 30000.0, None
    )
    catenary_parameter: float | None = quantity(
        "catenary_parameter_m",
        "Alternatively, catenary parameter: tension over weight per length, iced",
        "m",
        (1.0, 1e5),
        1285.5,
        None,
    )
    sag: float | None = quantity(
        "sag_m", "Alternatively, sag from the chord at mid-span, iced", "m", (1e-3, 1000.0), 1.54, None
    )
    level_difference: float = quantity(
        "level_difference_m",
        "Height of the right support above the left one",
        "m",
        (-LENGTH_LIMIT_M, LENGTH_LIMIT_M),
        0.0,
        0.0,
    )
    elements: int = Field(
        default=10, ge=2, le=100, description="Finite elements [1]", examples=[10], json_schema_extra={"x-unit": "1"}
    )

    @model_validator(mode="after")
    def _one_measure(self) -> Self:
        measures = (self.horizontal_tension, self.catenary_parameter, self.sag)
        ways = "horizontal_tension_n, catenary_parameter_m and sag_m"
        _one_way([value is not None for value in measures], ways)
        return self


class Support(Document):
    """One end of the span."""

    dead_end: bool = Field(default=False, description="Whether the end fixes the conductor", examples=[False])
    adjacent_span: float | None = quantity(
        "adjacent_span_m",
        "Length of the adjacent span; if null, the length of this span",
        "m",
        (1.0, LENGTH_LIMIT_M),
        150.0,
        None,
    )
    insulator_length: float | None = quantity(
        "insulator_length_m", "Length of the suspension insulator string", "m", (0.01, 30.0), 2.0, None
    )
    insulator_weight: float = quantity(
        "insulator_weight_n", "Weight of the string per sub-conductor", "N", (0.0, 1e5), 0.0, 0.0
    )
    yoke: Literal["held", "free"] | None = Field(
        default=None,
        description="Whether the yoke holds the sub-conductors of a free section together along the span, or turns "
        "with them; if null, free at an insulator string and held elsewhere",
        examples=["held"],
    )


class Supports(Document):
    """Both ends; a given longitudinal stiffness replaces the one computed from them."""

    longitudinal_stiffness: float | None = quantity(
        "longitudinal_stiffness_n_per_m",
        "Longitudinal stiffness of both ends together, per sub-conductor",
        "N/m",
        (1e-3, 1e12),
        1.285e5,
        None,
    )
    left: Support = Field(default=Support(), description="Left end", examples=[{"dead_end": True}])
    right: Support = Field(default=Support(), description="Right end", examples=[{"insulator_length_m": 2.0}])


class PhaseLine(Document):
    """The parts in which a phase differs from the line; what is absent, it has as the line."""

    conductor: Conductor | None = Field(
        default=None, description="One iced sub-conductor", examples=[_TWIN["conductor"]]
    )
    bundle: Bundle | None = Field(
        default=None, description="Arrangement of the sub-conductors", examples=[{"subconductors": 1}]
    )
    span: Span | None = Field(
        default=None, description="Length and tension", examples=[{"length_m": 125.88, "horizontal_tension_n": 25000.0}]
    )
    supports: Supports | None = Field(
        default=None, description="Supports at both ends", examples=[{"left": {"dead_end": True}}]
    )
    ice: Ice | None = Field(default=None, description="Ice on the span", examples=[_TWIN["ice"]])
    devices: list[Device] | None = Field(
        default=None, max_length=200, description="What is mounted on it, besides interphase spacers", examples=[[]]
    )


class Phase(Document):
    """Another phase or wire of the same span, attached beside the line."""

    name: Label = Field(description='Name by which spacers and tables call it; not "this"', examples=["top"])
    y: float = quantity("y_m", "Height of its attachment above this one's", "m", (-200.0, 200.0), 7.0)
    z: float = quantity("z_m", "Distance of its attachment downwind of this one's", "m", (-200.0, 200.0), 0.0, 0.0)
    required_clearance: float | None = quantity(
        "required_clearance_m", "Required clearance to it; that of the line if null", "m", _CLEARANCE, 1.2, None
    )
    ice: Ice | None = Field(default=None, description="Its own ice; that of the line if null", examples=[_TWIN["ice"]])
    line: PhaseLine | None = Field(
        default=None,
        description="What else differs from the line; if null, it is a copy of the line with its devices",
        examples=[{"span": {"length_m": 125.88, "horizontal_tension_n": 25000.0}}],
    )


class Line(Document):
    """One iced span with everything that its motion depends on, by itself or in a section of spans."""

    name: Label | None = Field(default=None, description="Name to show to people", examples=["C11 twin, 126 m"])
    asset_id: Label | None = Field(default=None, description="Identity in the owner's records", examples=["L204-S017"])
    tags: Annotated[dict[TagKey, Label], Field(max_length=50)] = Field(
        default={}, description="Labels for finding jobs; a key contains no colon", examples=[{"region": "north"}]
    )
    conductor: Conductor = Field(description="One iced sub-conductor", examples=[_TWIN["conductor"]])
    bundle: Bundle = Field(
        default=Bundle(subconductors=1),
        description="Arrangement of the sub-conductors; a single one if absent",
        examples=[_TWIN["bundle"]],
    )
    span: Span = Field(description="Length and tension", examples=[_TWIN["span"]])
    supports: Supports = Field(
        default=Supports(), description="Supports at both ends", examples=[{"left": {"dead_end": True}}]
    )
    ice: Ice = Field(description="Ice on the span", examples=[_TWIN["ice"]])
    wind: Wind = Field(default=Wind(), description="The wind, except its speed", examples=[_TWIN["wind"]])
    damping: Damping = Field(description="Structural damping", examples=[_TWIN["damping"]])
    devices: list[Device] = Field(
        default=[], max_length=200, description="What is mounted on the span", examples=[[_SPACER]]
    )
    climate: Climate | None = Field(
        default=None, description="Winds and icing of the year, for the table `risk`", examples=[CLIMATE]
    )
    section: Section | None = Field(
        default=None,
        description="The spans around this one between two dead ends, all of which then move, with their strings",
        examples=[SECTION],
    )
    phases: list[Phase] = Field(
        default=[],
        max_length=20,
        description="Other phases and wires, to which clearances are taken and which interphase spacers tie",
        examples=[_PHASES],
    )
    required_clearance: float | None = quantity(
        "required_clearance_m", "Required clearance between phases that say none", "m", _CLEARANCE, 1.5, None
    )
    design_wind: float | None = quantity(
        "design_wind_m_per_s", "Wind speed of design, at which the verdict is put", "m/s", (0.1, 100.0), 10.0, None
    )
