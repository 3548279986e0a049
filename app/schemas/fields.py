"""What all documents share: strict models that refuse unknown fields, and fields with unit and bounds."""

from functools import cache
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from app.reference.text_forms import composed
from app.schemas.units import any_unit, in_unit

LENGTH_LIMIT_M = 5000.0
"""Longest plausible span and farthest plausible position [m]."""

ON_SPAN = (0.0, LENGTH_LIMIT_M)
ICED_MASS = (0.01, 100.0)

_NULL = "\0null"

# Names contain no control characters, and PostgreSQL cannot store NUL.
_PRINTABLE = r"^[^\x00-\x1f\x7f]*$"

# A caller matches rows by it, so it is given back character by character.
Reference = Annotated[str, Field(min_length=1, max_length=200, pattern=_PRINTABLE)]
Label = Annotated[Reference, AfterValidator(composed)]
TagKey = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[^\x00-\x1f\x7f:]*$"), AfterValidator(composed)]


class Document(BaseModel):
    """A part of a request; it refuses unknown fields, words for numbers, NaN and infinity."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _in_own_units(cls, given: Any) -> Any:
        """Convert numbers that come with a unit to the unit of their field."""
        if type(given) is not dict or not any_unit(given.values()):
            return given
        units = _units_of(cls)
        return {name: in_unit(value, units[name]) if name in units else value for name, value in given.items()}

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        """Return the document itself: documents are immutable, so requests may share the default of an absent field."""
        return self


@cache
def _units_of(model: type[Document]) -> dict[str, str]:
    """Return the units of a document's numbers by their names in JSON."""
    found = {}
    for name, field in model.model_fields.items():
        extra = field.json_schema_extra
        if isinstance(extra, dict) and isinstance(extra.get("x-unit"), str):
            found[field.alias or name] = str(extra["x-unit"])
    return {name: unit for name, unit in found.items() if "^j" not in unit}


def with_marks(value: Any) -> Any:
    """Put a mark in the place of every null of an example, since FastAPI drops nulls when it writes its document."""
    if isinstance(value, dict):
        return {key: with_marks(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [with_marks(inner) for inner in value]
    return _NULL if value is None else value


def with_nulls(document: Any) -> Any:
    """Return a document in which nulls replace the marks."""
    if isinstance(document, dict):
        return {key: with_nulls(value) for key, value in document.items()}
    if isinstance(document, list):
        return [with_nulls(value) for value in document]
    return None if document == _NULL else document


def _with_marks_in_examples(schema: dict[str, Any]) -> None:
    for field in schema.get("properties", {}).values():
        if "examples" in field:
            field["examples"] = with_marks(field["examples"])


class Answer(BaseModel):
    """A part of an answer."""

    model_config = ConfigDict(extra="forbid", frozen=True, json_schema_extra=_with_marks_in_examples)


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
        json_schema_extra={"x-unit": unit},
    )
