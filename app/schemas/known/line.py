"""The whole line as an engineer knows it."""

from typing import Annotated, Literal

from pydantic import Field

from app.schemas.climate import CLIMATE, Climate
from app.schemas.devices import Device
from app.schemas.environment import Damping, Wind
from app.schemas.fields import Document, Label, TagKey
from app.schemas.known.ice import ACCRETION, KnownIce
from app.schemas.known.parts import KnownBundle, KnownConductor, KnownSpan, as_in
from app.schemas.line import Line, Phase, Supports
from app.schemas.section import Section

_EVERYDAY = {"temperature_c": 15.0, "share_of_rated_strength": 0.2}


class KnownDamping(Document):
    """Structural damping; a ratio that is not said is assumed."""

    vertical_ratio: float | None = as_in(Damping, "vertical_ratio")
    horizontal_ratio: float | None = as_in(Damping, "horizontal_ratio")
    torsional_ratio: float | None = as_in(Damping, "torsional_ratio")
    model: Literal["constant_coefficient", "constant_ratio"] = Field(
        default="constant_coefficient",
        description="Quantity that is the same for every number of loops",
        examples=["constant_coefficient"],
    )


class KnownLine(Document):
    """One span as an engineer knows it; what is not said is estimated, and listed with its range."""

    name: Label | None = Field(default=None, description="Name to show to people", examples=["L204, span 17"])
    asset_id: Label | None = Field(default=None, description="Identity in the owner's records", examples=["L204-S017"])
    tags: Annotated[dict[TagKey, Label], Field(max_length=50)] = Field(
        default={}, description="Labels for finding jobs; a key contains no colon", examples=[{"region": "north"}]
    )
    conductor: KnownConductor = Field(description="One sub-conductor", examples=[{"catalogue": "Drake"}])
    bundle: KnownBundle = Field(
        default=KnownBundle(subconductors=1),
        description="Arrangement of the sub-conductors; a single one if absent",
        examples=[{"subconductors": 2, "spacing_m": 0.457, "arrangement": "horizontal"}],
    )
    span: KnownSpan = Field(
        description="Length and tension",
        examples=[{"length_m": 300.0, "temperature_c": -5.0, "everyday": _EVERYDAY}],
    )
    supports: Supports = Field(
        default=Supports(),
        description="Supports at both ends",
        examples=[{"left": {"adjacent_span_m": 280.0, "insulator_length_m": 2.4}}],
    )
    ice: KnownIce = Field(
        description="Ice on the span", examples=[{"accretion": ACCRETION, "aerodynamics": {"catalogue": "c11-40"}}]
    )
    wind: Wind | None = Field(
        default=None, description="The wind, except its speed", examples=Line.model_fields["wind"].examples
    )
    damping: KnownDamping = Field(
        default=KnownDamping(), description="Structural damping, assumed if absent", examples=[{"torsional_ratio": 0.1}]
    )
    devices: list[Device] = Field(
        default=[],
        max_length=200,
        description="What is mounted on the span",
        examples=[[{"type": "spacer", "position_m": 60.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}]],
    )
    phases: list[Phase] = Field(
        default=[],
        max_length=20,
        description=Line.model_fields["phases"].description,
        examples=Line.model_fields["phases"].examples,
    )
    required_clearance: float | None = as_in(Line, "required_clearance")
    design_wind: float | None = as_in(Line, "design_wind")
    section: Section | None = Field(
        default=None,
        description=Line.model_fields["section"].description,
        examples=Line.model_fields["section"].examples,
    )
    climate: Climate | None = Field(
        default=None, description="Winds and icing of the year, for the table `risk`", examples=[CLIMATE]
    )
