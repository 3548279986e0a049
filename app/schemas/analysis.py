"""The analysis: what to compute for a line, and the options of the model."""

from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from app.schemas.fields import Document, quantity

_FASTEST_WIND = 100.0

WindSpeed = Annotated[float, Field(ge=0.01, le=_FASTEST_WIND)]
Loops = Annotated[int, Field(ge=1, le=10)]


class WindSpeedRange(Document):
    """Evenly spaced wind speeds."""

    start: float = quantity("start", "First wind speed", "m/s", (0.01, _FASTEST_WIND), 4.0)
    stop: float = quantity("stop", "Last wind speed", "m/s", (0.01, _FASTEST_WIND), 6.0)
    count: int = Field(
        ge=2, le=1000, description="Number of wind speeds [1]", examples=[21], json_schema_extra={"x-unit": "1"}
    )

    @model_validator(mode="after")
    def _rising(self) -> Self:
        if not self.start < self.stop:
            raise PydanticCustomError("rising", "start must be below stop")
        return self


def _speeds_form(value: object) -> str:
    return "range" if isinstance(value, dict | WindSpeedRange) else "list"


WindSpeeds = Annotated[
    Annotated[list[WindSpeed], Field(max_length=1000), Tag("list")] | Annotated[WindSpeedRange, Tag("range")],
    Discriminator(_speeds_form),
]


class Uncertainty(Document):
    """Samples of what is assumed of a line, analysed beside it."""

    samples: int = Field(
        default=64,
        ge=0,
        le=16_384,
        description="Number of samples, best a power of two; 0 for none [1]",
        examples=[64],
        json_schema_extra={"x-unit": "1"},
    )
    seed: int = Field(
        default=1,
        ge=0,
        le=2**31 - 1,
        description="Seed of the samples; the same one draws the same samples [1]",
        examples=[1],
        json_schema_extra={"x-unit": "1"},
    )


class Analysis(Document):
    """What to compute, and the model's options."""

    loops: list[Loops] = Field(
        default=[1, 2],
        min_length=1,
        max_length=10,
        description="Numbers of loops per span [1]",
        examples=[[1, 2]],
        json_schema_extra={"x-unit": "1"},
    )
    models: list[Literal["hybrid", "finite_element"]] = Field(
        default=["hybrid", "finite_element"],
        min_length=1,
        max_length=2,
        description="hybrid: three degrees of freedom per number of loops; finite_element: several modes a direction",
        examples=[["hybrid", "finite_element"]],
    )
    wind_speeds: WindSpeeds = Field(
        default=[4.0, 5.0, 6.0],
        alias="wind_speeds_m_per_s",
        description="Wind speeds for limit cycles: a list, or start, stop and count; if absent, the line's design "
        "wind as well [m/s]",
        examples=[[4.0, 5.0, 6.0], {"start": 4.0, "stop": 6.0, "count": 21}],
        json_schema_extra={"x-unit": "m/s"},
    )
    closure: Literal["exact", "published"] = Field(
        default="exact", description="How the angle of attack varies along the span", examples=["exact"]
    )
    physics: Literal["full", "source"] | None = Field(
        default=None,
        description="Full physics, or the source's simplifications; null: full if the line's coefficients at rest are "
        "known, else the source's with a warning. Sets aerodynamic_model, longitudinal_inertia, stretching, "
        "static_twist and the line's bundle.section where they are null",
        examples=["full"],
    )
    aerodynamic_model: Literal["published", "relative_wind", "table"] | None = Field(
        default=None,
        description="Which velocities change the wind: the vertical one (published, source), or all those of each "
        "sub-conductor (relative_wind, full), which needs ice.aerodynamics_at_rest or a table; table: all of them, by "
        "a measured table as it stands and about the twist in the wind; null: set by physics",
        examples=["published"],
    )
    aerodynamic_load: Literal["expanded", "unexpanded"] = Field(
        default="expanded",
        description="Whether the load of the relative wind is expanded to third order in the motion, or evaluated as "
        "it stands; a measured table is always evaluated as it stands",
        examples=["expanded"],
    )
    longitudinal_inertia: Literal["neglected", "condensed"] | None = Field(
        default=None,
        description="Longitudinal inertia in the hybrid model: neglected (source), condensed (full); null: set by "
        "physics",
        examples=["neglected"],
    )
    stretching: Literal["neglected", "included"] | None = Field(
        default=None,
        description="Whether large motions stretch the conductors, which stiffens them: neglected (source), included "
        "(full), which also gives tensions; null: set by physics",
        examples=["included"],
    )
    critical_wind_limit: float = quantity(
        "critical_wind_limit_m_per_s",
        "Upper limit of the search for critical wind speeds",
        "m/s",
        (0.1, 100.0),
        30.0,
        30.0,
    )
    harmonics: int = Field(
        default=5,
        ge=1,
        le=20,
        description="Harmonics of the harmonic balance [1]",
        examples=[5],
        json_schema_extra={"x-unit": "1"},
    )
    finite_element_loops: list[Loops] = Field(
        default=[1, 2, 3],
        max_length=10,
        description="Loops of the modes in the finite element model; an empty list gives its frequencies only [1]",
        examples=[[1, 2, 3]],
        json_schema_extra={"x-unit": "1"},
    )

    static_twist: Literal["neglected", "where_large", "solved"] | None = Field(
        default=None,
        description="Whether eccentric ice twists the span at rest: neglected (source), solved, so that mass, weight "
        "and tables turn with it, or where_large, solved for lines that turn by more than 5 degrees (full); null: "
        "set by physics",
        examples=["neglected"],
    )
    loop_competition: Literal["neglected", "checked"] = Field(
        default="neglected",
        description="Whether to check that the hybrid model's stable cycles stay stable among the other loops",
        examples=["checked"],
    )

    device_effect: Literal["neglected", "reported"] = Field(
        default="neglected",
        description="Whether to analyse the line also without its devices, to report their effect",
        examples=["reported"],
    )

    amplitude_curves: Literal["neglected", "reported"] = Field(
        default="neglected",
        description="Whether every computed point of each branch of limit cycles is reported, from its Hopf point on",
        examples=["reported"],
    )

    quasi_periodic: Literal["lasting", "every"] = Field(
        default="lasting",
        description="Which quasi-periodic motions to search for: those that may be stable, or also unstable ones",
        examples=["every"],
    )

    check: Literal["none", "direct"] = Field(
        default="none",
        description="Whether to compare every stable motion with 50 periods of direct integration, and to search for "
        "more cycles by integrating from large initial motions at up to three of the wind speeds",
        examples=["direct"],
    )

    risk: bool | None = Field(
        default=None,
        description="Whether to weigh the motions with the line's climate (table `risk`); if null, where it has one",
        examples=[True],
    )

    uncertainty: Uncertainty | None = Field(
        default=None,
        description="Samples of the assumed values of a line as engineers know it, for probabilities and for the "
        "assumption that decides; null: 64 samples of a line by itself, none in a batch. Studies and placements have "
        "none",
        examples=[{"samples": 64, "seed": 1}],
    )

    @model_validator(mode="after")
    def _distinct(self) -> Self:
        for name in ("loops", "models", "finite_element_loops"):
            values = getattr(self, name)
            if len(set(values)) != len(values):
                raise PydanticCustomError("distinct", "{name} must be distinct", {"name": name})
        return self

    def with_design_wind(self, speed: float | None) -> Self:
        """Return the analysis with a line's design wind [m/s] among its wind speeds, if it names none itself."""
        if speed is None or "wind_speeds" in self.model_fields_set:
            return self
        return self.model_copy(update={"wind_speeds": sorted({*self.speeds(), speed})})

    def speeds(self) -> tuple[float, ...]:
        """Return the wind speeds as a list [m/s]."""
        if isinstance(self.wind_speeds, WindSpeedRange):
            span = self.wind_speeds
            step = (span.stop - span.start) / (span.count - 1)
            return (*(span.start + step * i for i in range(span.count - 1)), span.stop)
        return tuple(self.wind_speeds)
