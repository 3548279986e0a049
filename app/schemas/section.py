"""A section of several spans around the span of the line, with swinging suspension strings between them."""

from typing import Any

from pydantic import Field

from app.reference.source_lines import example
from app.schemas.environment import Ice, ProfilePoint
from app.schemas.fields import LENGTH_LIMIT_M, Document, quantity

_STRING = {"length_m": 4.5, "weight_n": 2500.0}
EXAMPLE: dict[str, Any] = {
    "spans": [{"length_m": 150.0}, {"length_m": 125.88}, {"length_m": 140.0}],
    "span_of_interest": 2,
    "strings": [{"length_m": 1.2, "weight_n": 600.0}] * 2,
}


class SectionSpan(Document):
    """One span of a section; all have the tension of the span of interest."""

    length: float = quantity("length_m", "Horizontal length", "m", (1.0, LENGTH_LIMIT_M), 350.0)
    level_difference: float = quantity(
        "level_difference_m",
        "Height of the right end above the left one",
        "m",
        (-LENGTH_LIMIT_M, LENGTH_LIMIT_M),
        0.0,
        0.0,
    )
    ice: Ice | None = Field(
        default=None,
        description="Ice on this span, of the same weight; if null, that of the span of interest, in proportion to "
        "the length",
        examples=[example("c11-twin")["ice"]],
    )
    profile: list[ProfilePoint] | None = Field(
        default=None,
        alias="wind_profile",
        max_length=200,
        description="Wind profile along this span; if null, that of the span of interest, in proportion to the length",
        examples=[[{"position_m": 0.0, "factor": 0.7}]],
    )


class SuspensionString(Document):
    """A suspension insulator string between two spans, which swings along and across the line."""

    length: float = quantity("length_m", "Length", "m", (0.01, 30.0), 4.5)
    weight: float = quantity("weight_n", "Weight of the whole string", "N", (0.1, 1e6), 2500.0)


class Section(Document):
    """Spans between two dead ends, from left to right, one of which is the span of the line."""

    spans: list[SectionSpan] = Field(
        min_length=1, max_length=20, description="The spans from left to right", examples=[EXAMPLE["spans"]]
    )
    span_of_interest: int = Field(
        default=1,
        ge=1,
        le=20,
        description="Number of the span that the line describes, from 1 at the left [1]",
        examples=[2],
        json_schema_extra={"x-unit": "1"},
    )
    strings: list[SuspensionString] = Field(
        max_length=19,
        description="The suspension strings between the spans, one fewer than spans",
        examples=[[_STRING] * 2],
    )
