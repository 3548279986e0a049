"""What all documents share: strict models that refuse unknown fields, and fields with unit and bounds."""

from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, Field

LENGTH_LIMIT_M = 5000.0
"""Longest plausible span and farthest plausible position [m]."""

ON_SPAN = (0.0, LENGTH_LIMIT_M)
ICED_MASS = (0.01, 100.0)

# Names contain no control characters, and PostgreSQL cannot store NUL.
_PRINTABLE = r"^[^\x00-\x1f\x7f]*$"

Label = Annotated[str, Field(min_length=1, max_length=200, pattern=_PRINTABLE)]
TagKey = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[^\x00-\x1f\x7f:]*$")]


class Document(BaseModel):
    """A part of a request; it refuses unknown fields, words for numbers, NaN and infinity."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        """Return the document itself: documents are immutable, so requests may share the default of an absent field."""
        return self


class Answer(BaseModel):
    """A part of an answer."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def described(description: str, example: Any) -> Any:
    """Declare a field of an answer: its meaning, with the unit if it is a number, and a typical value."""
    return Field(description=description, examples=[example])


def example_of(model: type[BaseModel]) -> dict[str, Any]:
    """Return an example of an answer, made of the examples of its fields."""
    return {name: field.examples[0] for name, field in model.model_fields.items() if field.examples}


def quantity(
    name: str, description: str, unit: str, bounds: tuple[float, float], example: float, default: Any = ...
) -> Any:
    """Declare a number in a request.

    Parameters
    ----------
    name : str
        Name in the JSON document, ending in its unit.
    description, unit : str
        Meaning, and unit as the schema shows it; `1` for a dimensionless number.
    bounds : tuple of two floats
        Smallest and largest plausible value.
    example : float
        A typical value.
    default : Any
        Value of an absent field; without a default the field is required.
    """
    return Field(
        default=default,
        alias=name,
        description=f"{description} [{unit}]",
        ge=bounds[0],
        le=bounds[1],
        examples=[example],
        json_schema_extra={"unit": unit},
    )
