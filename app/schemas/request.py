"""The request: a line with its analysis and, if any, a study over its fields or a placement of devices."""

import math
from typing import Annotated, Any, Self

from pydantic import Field, WithJsonSchema, model_validator
from pydantic.functional_validators import PlainValidator
from pydantic_core import PydanticCustomError

from app.reference.source_lines import example
from app.schemas.analysis import Analysis
from app.schemas.devices.tried_remedies import EXAMPLE as REMEDIES
from app.schemas.devices.tried_remedies import Remedies
from app.schemas.fields import Document
from app.schemas.line import Line
from app.schemas.placement import EXAMPLE as PLACEMENT
from app.schemas.placement import Placement

STUDY_POINTS_LIMIT = 10_000
_LARGEST = 1e12
_AXIS = {"parameter": "span.horizontal_tension_n", "values": [24000, 30000, 36000]}


def _number_or_word(value: object) -> float | str:
    """Return a finite number or a short word unchanged.

    Raises
    ------
    PydanticCustomError
        If the value is anything else.
    """
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and -_LARGEST <= value <= _LARGEST:  # type: ignore[operator]  # false for NaN too
        return value  # type: ignore[return-value]
    if isinstance(value, str) and len(value) <= 40:
        return value
    raise PydanticCustomError("number_or_word", "must be a finite number or a word that the field allows")


AxisValue = Annotated[
    Any,
    PlainValidator(_number_or_word),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string", "maxLength": 40}]}),
]


ParameterPath = Annotated[str, Field(min_length=1, max_length=120, pattern=r"^[a-z][a-z0-9_]*(\.[a-z0-9_]+)+$")]


class Axis(Document):
    """A field of the line, or several fields together, and the values that they take in turn."""

    parameter: ParameterPath = Field(
        description="Dotted path to a number or word of the line; a list item by its number: devices.0.position_m",
        examples=["span.horizontal_tension_n"],
    )
    also: list[ParameterPath] = Field(
        default=[],
        max_length=10,
        description="Further fields that take the same values",
        examples=[["damping.horizontal_ratio"]],
    )
    values: list[AxisValue] = Field(
        min_length=1,
        max_length=STUDY_POINTS_LIMIT,
        description="Values in the field's own unit",
        examples=[[24000, 30000, 36000]],
    )

    @property
    def parameters(self) -> tuple[str, ...]:
        """Return all fields that take the values, beginning with the one that names the axis."""
        return (self.parameter, *self.also)


class Study(Document):
    """A study that varies one or two fields of the line; every combination of values is a point."""

    axes: list[Axis] = Field(
        min_length=1, max_length=2, description="The fields to vary; the last one varies fastest", examples=[[_AXIS]]
    )
    follow: bool = Field(
        default=False,
        description="Whether to follow the hybrid model's cycles over the single varied field, through folds",
        examples=[True],
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        varied = [name for axis in self.axes for name in axis.parameters]
        if len(set(varied)) != len(varied):
            raise PydanticCustomError("distinct", "the axes must vary different fields")
        points = math.prod(len(axis.values) for axis in self.axes)
        if points > STUDY_POINTS_LIMIT:
            context = {"points": points, "limit": STUDY_POINTS_LIMIT}
            raise PydanticCustomError("too_many_points", "the study has {points} points, more than {limit}", context)
        if self.follow and (len(self.axes) > 1 or not _distinct_numbers(self.axes[0].values)):
            raise PydanticCustomError("one_field", "follow needs a single axis with two or more distinct numbers")
        return self


def _distinct_numbers(values: list[Any]) -> bool:
    return all(isinstance(value, int | float) for value in values) and len(set(values)) == len(values) > 1


class JobRequest(Document):
    """A line with its analysis and, optionally, a study over its fields, a placement, or remedies to compare."""

    line: Line = Field(description="The line", examples=[example("c11-twin")])
    analysis: Analysis = Field(default=Analysis(), description="What to compute", examples=[{"loops": [1, 2]}])
    study: Study | None = Field(
        default=None, description="Fields of the line to vary, if any", examples=[{"axes": [_AXIS]}]
    )
    placement: Placement | None = Field(
        default=None, description="Devices to place, if any; not together with a study", examples=[PLACEMENT]
    )
    remedies: Remedies | None = Field(
        default=None,
        description="Remedies to compare with the line as it is, if any; not together with a study or a placement. "
        "Unless analysis.models says otherwise, the hybrid model is the only one",
        examples=[REMEDIES],
    )

    webhook_url: str | None = Field(
        default=None,
        max_length=2000,
        description="https address to which the service posts a signed message when the job ends",
        examples=["https://assets.example.com/galloping"],
    )

    known: dict[str, Any] | None = Field(
        default=None,
        description="The line as it was said, with the own rows that it names, of which `line` is the explicit form; "
        "the service writes it",
        examples=[{"line": {"conductor": {"catalogue": "Drake"}}, "conductors": [], "tables": []}],
    )

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if self.study is not None and self.placement is not None:
            raise PydanticCustomError("exclusive", "must have a study or a placement, not both")
        if self.remedies is not None and (self.study is not None or self.placement is not None):
            raise PydanticCustomError("exclusive", "must have no study or placement beside remedies")
        object.__setattr__(self, "analysis", self.analysis.with_design_wind(self.line.design_wind))  # before it is used
        return self

    @model_validator(mode="before")
    @classmethod
    def _hybrid_for_remedies(cls, given: Any) -> Any:
        """Compare remedies by the hybrid model alone where no models are named: the other one takes minutes."""
        if not isinstance(given, dict) or given.get("remedies", cls.model_fields["remedies"].default) is None:
            return given
        analysis = given.get("analysis", {})
        if not isinstance(analysis, dict) or "models" in analysis:
            return given
        return {**given, "analysis": {**analysis, "models": ["hybrid"]}}

    def kept(self) -> dict[str, Any]:
        """Return the request with all defaults, as it is stored and returned, without parts that are absent."""
        absent = {name for name in ("study", "placement", "remedies", "known") if getattr(self, name) is None}
        return self.model_dump(mode="json", by_alias=True, exclude={*absent, "webhook_url"})


class RemediesRequest(JobRequest):
    """A line with the remedies to compare with it: those named, or the usual ones."""

    remedies: Remedies = Field(
        default=Remedies(), description="Remedies to compare with the line as it is", examples=[REMEDIES]
    )
