"""The climate document of a line: its winds by sector while it is iced, and how often and how long it is iced."""

from typing import Annotated, Any, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from app.schemas.fields import Document, Label, quantity

_HOURS = (0.0, 8784.0)
_EVENTS = (0.0, 1000.0)
_SHAPE = (0.2, 20.0)
_SCALE = (0.05, 60.0)
_YEARS = (1e-3, 1000.0)
_Wind = Annotated[float, Field(ge=0.0, le=100.0)]


def _end(name: str, which: str, of: str, unit: str, bounds: tuple[float, float], example: float) -> Any:
    return quantity(name, f"{which} {of}; the value itself if null", unit, bounds, example, None)


class WindSector(Document):
    """The wind from one sector, with Weibull's distribution of its speeds at the height of the line."""

    direction: float = quantity(
        "direction_deg",
        "Middle of the sector, from which the wind comes, clockwise from north",
        "deg",
        (-360.0, 360.0),
        270.0,
    )
    width: float | None = quantity(
        "width_deg",
        "Width of the sector, 0 for one direction; if null, an equal part of the circle",
        "deg",
        (0.0, 360.0),
        30.0,
        None,
    )
    share: float = quantity("share", "Share of the time, 1 in all sectors together", "1", (0.0, 100.0), 0.12)
    shape: float = quantity("weibull_shape", "Weibull's shape k: P(U > u) = exp(-(u/scale)^k)", "1", _SHAPE, 2.0)
    shape_lowest: float | None = _end("weibull_shape_lowest", "Lowest", "shape", "1", _SHAPE, 1.8)
    shape_highest: float | None = _end("weibull_shape_highest", "Highest", "shape", "1", _SHAPE, 2.2)
    scale: float = quantity("weibull_scale_m_per_s", "Weibull's scale", "m/s", _SCALE, 6.0)
    scale_lowest: float | None = _end("weibull_scale_lowest_m_per_s", "Lowest", "scale", "m/s", _SCALE, 5.0)
    scale_highest: float | None = _end("weibull_scale_highest_m_per_s", "Highest", "scale", "m/s", _SCALE, 7.0)


class Icing(Document):
    """How often and how long the line is iced: by hours a year, or by events a year and their duration."""

    kind: Label = Field(description="Kind of the ice, to show to people", examples=["glaze"])
    thickness: float | None = quantity("thickness_m", "Thickness of the ice", "m", (1e-5, 0.3), 0.012, None)
    hours: float | None = quantity("hours_a_year", "Hours a year with ice on the line", "h", _HOURS, 40.0, None)
    hours_lowest: float | None = _end("hours_a_year_lowest", "Lowest", "hours", "h", _HOURS, 20.0)
    hours_highest: float | None = _end("hours_a_year_highest", "Highest", "hours", "h", _HOURS, 80.0)
    events: float | None = quantity(
        "events_a_year", "Alternatively, events of icing a year, with event_hours", "1", _EVENTS, 2.0, None
    )
    events_lowest: float | None = _end("events_a_year_lowest", "Lowest", "number of events", "1", _EVENTS, 1.0)
    events_highest: float | None = _end("events_a_year_highest", "Highest", "number of events", "1", _EVENTS, 4.0)
    event_hours: float | None = quantity(
        "event_hours", "Hours from the first ice of an event to the last", "h", _HOURS, 20.0, None
    )
    event_hours_lowest: float | None = _end("event_hours_lowest", "Lowest", "duration", "h", _HOURS, 10.0)
    event_hours_highest: float | None = _end("event_hours_highest", "Highest", "duration", "h", _HOURS, 40.0)
    persistence: float | None = quantity(
        "wind_persistence_hours",
        "Hours for which the wind keeps its speed; if null, 6 is assumed, from 1 to the whole event",
        "h",
        _HOURS,
        6.0,
        None,
    )
    persistence_lowest: float | None = _end("wind_persistence_hours_lowest", "Lowest", "persistence", "h", _HOURS, 1.0)
    persistence_highest: float | None = _end(
        "wind_persistence_hours_highest", "Highest", "persistence", "h", _HOURS, 20.0
    )

    @model_validator(mode="after")
    def _ends_have_values(self) -> Self:
        for name in ("hours", "events", "event_hours", "persistence"):
            ends = (getattr(self, f"{name}_lowest"), getattr(self, f"{name}_highest"))
            if getattr(self, name) is None and ends != (None, None):
                alias = type(self).model_fields[name].alias
                raise PydanticCustomError("missing", "{name} is needed for its ends", {"name": alias})
        return self


class IcedRecord(Document):
    """Iced hours of a weather record, as `galloping climate` prints them."""

    years: float = quantity("years", "Length of the record without what is missing in it, in years", "1", _YEARS, 9.7)
    events: Annotated[list[Annotated[list[_Wind], Field(min_length=1)]], Field(min_length=1, max_length=10_000)] = (
        Field(
            description="For each event of icing, the wind across the line in each of its hours [m/s]",
            examples=[[[4.1, 5.2, 3.9], [7.7]]],
            json_schema_extra={"x-unit": "m/s"},
        )
    )


class Climate(Document):
    """The wind while the line is iced, by sector, and the icing; or a record of iced hours."""

    azimuth: float = quantity(
        "line_azimuth_deg", "Direction of the line, clockwise from north, either way", "deg", (-360.0, 360.0), 45.0
    )
    sectors: Annotated[list[WindSector], Field(max_length=72)] = Field(
        default=[],
        description="The wind by sector, while there is ice on the line",
        examples=[[{"direction_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}]],
    )
    icing: Annotated[list[Icing], Field(max_length=20)] = Field(
        default=[],
        description="Icing by kind of ice",
        examples=[[{"kind": "glaze", "thickness_m": 0.012, "hours_a_year": 40.0}]],
    )
    record: IcedRecord | None = Field(
        default=None,
        description="Instead of sectors and icing, iced hours of a weather record",
        examples=[{"years": 9.7, "events": [[4.1, 5.2, 3.9], [7.7]]}],
    )


CLIMATE: dict[str, Any] = {
    "line_azimuth_deg": 45.0,
    "sectors": Climate.model_fields["sectors"].examples[0],  # type: ignore[index]
    "icing": Climate.model_fields["icing"].examples[0],  # type: ignore[index]
}
"""An example of a climate."""
