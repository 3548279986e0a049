"""What all documents share: strict models that refuse unknown fields, and fields that say their unit and bounds."""

from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, Field

LENGTH_LIMIT_M = 5000.0
"""Longest span and farthest position that is taken for plausible [m]."""

ON_SPAN = (0.0, LENGTH_LIMIT_M)
ICED_MASS = (0.01, 100.0)

# Control characters have no place in a name, and PostgreSQL stores no NUL.
_PRINTABLE = r"^[^\x00-\x1f\x7f]*$"

Label = Annotated[str, Field(min_length=1, max_length=200, pattern=_PRINTABLE)]
TagKey = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[^\x00-\x1f\x7f:]*$")]


class Document(BaseModel):
    """A part of what comes in: unknown fields, words for numbers, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        """Return this very document: nobody changes one, so that all who leave a field out share its default."""
        return self


class Answer(BaseModel):
    """A part of what goes out."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def told(description: str, example: Any) -> Any:
    """Declare a field of an answer: what it is, with its unit if it is a number, and a usual value."""
    return Field(description=description, examples=[example])


def example_of(model: type[BaseModel]) -> dict[str, Any]:
    """Return an example of an answer that is made of the examples of its fields."""
    return {name: field.examples[0] for name, field in model.model_fields.items() if field.examples}


def quantity(
    name: str, description: str, unit: str, bounds: tuple[float, float], example: float, default: Any = ...
) -> Any:
    """Declare a number of the contract.

    Parameters
    ----------
    name : str
        Name in the JSON document, with its unit.
    description, unit : str
        What it is, and its unit as the schema shows it; `1` for a pure number.
    bounds : tuple of two floats
        Smallest and largest value that is plausible.
    example : float
        A usual value.
    default : Any
        The value that holds if the field is absent; without it the field is required.
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
