"""The result document: the tables that the engine declares, and the fields around them."""

from typing import TYPE_CHECKING, Any, Literal

from pydantic import ConfigDict

from app import convert
from app.answers.jobs import Failure
from app.answers.rows import DenHartog, StaticState, with_tables
from app.reference.source_lines import example
from app.schemas.fields import Answer, described, example_of

Extension = Literal["svg", "png", "pdf"]
"""Formats of the pictures of a result."""


class PointFailure(Answer):
    """The failure of a point of a study, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    failure: str = described("Cause in a sentence", "InvalidSpec: devices.0.position must lie on the span")


class _Head(Answer):
    """The fields before the tables."""

    input: dict[str, Any] = described("The request with every default", {"line": example("c11-twin")})
    static: StaticState | list[StaticState] | None = described(
        "Static state of the span", convert.example_row(convert.StaticState)
    )
    den_hartog: DenHartog | list[DenHartog] | None = described(
        "Den Hartog's criterion", convert.example_row(convert.DenHartog)
    )


# Type checkers see the fields of the registry, and a table's address as any text.
if TYPE_CHECKING:
    TableName = str

    class _WithTables(_Head, convert.Tables):
        """What stands before the tables, and the tables."""

else:
    TableName = Literal[tuple(convert.TABLES_BY_ADDRESS)]
    """Tables of flat rows as addresses name them, in the order of the result document."""

    _WithTables = with_tables(_Head, convert.TABLES)


class ResultDocument(_WithTables):
    """All results; in a study every row begins with the values of the axes."""

    warnings: list[str] = described(
        "Warnings about the results, in sentences", ["The angle of attack leaves the fitted range."]
    )
    failures: list[PointFailure] = described("Points that failed", [example_of(PointFailure)])
    failure: Failure | None = described("Why the job failed; null if it did not", example_of(Failure))
    engine_version: str | None = described("Version of the engine; null if nothing was computed", "0.1.0")
