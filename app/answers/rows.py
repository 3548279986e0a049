"""Schemas of result rows, generated from the columns that the engine declares: description, unit and example."""

from collections.abc import Callable, Mapping
from enum import Enum
from inspect import cleandoc
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, create_model, model_validator

from app import convert, schemas
from app.convert import Column, Table
from app.schemas.fields import Answer, described

__all__ = ["DenHartog", "Row", "StaticState", "row_schema", "with_tables"]


class Row(Answer):
    """A result row; in a study it begins with the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _completed(cls, row: Any) -> Any:
        """Add columns that a stored row lacks, because they were declared later, as null."""
        return {**dict.fromkeys(cls.model_fields), **row} if isinstance(row, dict) else row


def row_schema(row: type[Any], *, nullable: bool = False) -> type[Row]:
    """Make the schema of a declared row.

    Parameters
    ----------
    row : type
        A dataclass of `engine.result`; the first paragraph of its docstring becomes the schema's.
    nullable : bool
        Whether any column may be null, as in SQL, where null replaces a value that is not finite.
    """
    columns: dict[str, Any] = {
        name: (_inlined(kind) | None if nullable else _inlined(kind), _field(column))
        for name, (kind, column) in convert.columns_of(row).items()
    }
    sentence = cleandoc(row.__doc__ or "").partition("\n\n")[0]
    name = row.__name__.removesuffix("Row")
    name = row.__name__ if hasattr(schemas, name) else name  # no two schemas of the API have the same name
    return create_model(name, __base__=Row, __doc__=sentence, __module__=__name__, **columns)


def with_tables(head: type[BaseModel], tables: Mapping[str, Table]) -> type[BaseModel]:
    """Make a schema that has a field for every table beside those of another one."""
    fields: dict[str, Any] = {}
    for name, table in tables.items():
        rows = tuple[row_schema(table.row), ...]  # type: ignore[misc, valid-type]  # a type that is made here
        fields[name] = (rows, described(table.title, [convert.example_row(table.row)]))
    return create_model("WithTables", __base__=head, __module__=__name__, **fields)


def _field(column: Column) -> Any:
    if column.unit is None:
        return described(column.description, column.example)
    return Field(
        description=f"{column.description} [{column.unit}]",
        examples=[column.example],
        json_schema_extra={"x-unit": column.unit},
    )


def _inlined(kind: Any) -> Any:
    """Return a type whose enums are words in the JSON schema, and members of the enum when they are read."""
    if isinstance(kind, UnionType):
        return Union[tuple(_inlined(part) for part in get_args(kind))]  # noqa: UP007 - of parts known at run time
    if isinstance(kind, type) and issubclass(kind, Enum):
        return Annotated[Literal[tuple(member.value for member in kind)], AfterValidator(_member_of(kind))]
    return kind


def _member_of(kind: type[Enum]) -> Callable[[Any], Enum]:
    """Return a function from a word to its member; from Python 3.12 on pydantic takes no enum as a function."""

    def member(word: Any) -> Enum:
        return kind(word)

    return member


# Type checkers cannot see models created at run time, so show them the engine's rows with the same attributes.
if TYPE_CHECKING:
    from app.convert import DenHartog, StaticState
else:
    StaticState = row_schema(convert.StaticState, nullable=True)
    DenHartog = row_schema(convert.DenHartog, nullable=True)
