"""Batches as they go out: how far they are, what came of their lines, and which gallop first."""

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Literal
from uuid import UUID

from pydantic import Field

from app.answers.jobs import Link, Status
from app.answers.results import TableName
from app.schemas.fields import Answer, example_of, told

if TYPE_CHECKING:
    BatchTableName = str
else:
    BatchTableName = Literal[TableName, "summary"]
Count = Annotated[int, Field(ge=0)]


class LineCounts(Answer):
    """How many lines are in which state."""

    total: Count = told("All lines that came in [1]", 3)
    accepted: Count = told("Waiting [1]", 0)
    running: Count = told("In a chunk that is being worked on [1]", 0)
    successful: Count = told("With results [1]", 2)
    failed: Count = told("Without; see their failures in the results [1]", 0)
    dismissed: Count = told("Cancelled before they were worked on [1]", 0)
    rejected: Count = told("Never taken, since they are at fault; see errors [1]", 1)
    reused: Count = told("Of the successful: stored before, and not computed again [1]", 0)


class LineSummary(Answer):
    """What came of one line, in a row, beside its static state and Den Hartog's criterion, which declare themselves."""

    number: int = told("Number of the line, from 1; headers and the analysis do not count [1]", 1)
    reference: str | None = told("The caller's reference of the line", "row-1")
    asset_id: str | None = told("Identity of the line in the owner's records", "L204-S017")
    status: str = told("State of the line", "successful")
    failure: str | None = told("Why there is nothing, in a sentence", "The job ran longer than 3600 s.")
    lowest_critical_wind_speed_m_per_s: float | None = told("Wind speed from which the line gallops [m/s]", 2.403)
    largest_vertical_m: float | None = told("Largest vertical amplitude of a stable motion [m]", 0.1568)
    largest_height_m: float | None = told(
        "Height of all that a stable motion of all sub-conductors reaches [m]", 0.3136
    )
    largest_width_m: float | None = told("Width of all that a stable motion of all sub-conductors reaches [m]", 0.4908)
    engine_version: str | None = told("Version of the computation", "0.1.0")


class RankedLine(Answer):
    """One line of a ranking."""

    rank: int = told("Place in the ranking, from 1 [1]", 1)
    number: int = told("Number of the line, from 1 [1]", 17)
    reference: str | None = told("The caller's reference of the line", "row-17")
    asset_id: str | None = told("Identity of the line in the owner's records", "L204-S017")
    lowest_critical_wind_speed_m_per_s: float | None = told("Wind speed from which the line gallops [m/s]", 2.403)
    largest_vertical_m: float | None = told("Largest vertical amplitude of a stable motion [m]", 0.1568)
    largest_height_m: float | None = told(
        "Height of all that a stable motion of all sub-conductors reaches [m]", 0.3136
    )
    largest_width_m: float | None = told("Width of all that a stable motion of all sub-conductors reaches [m]", 0.4908)
    margin_m_per_s: float | None = told("Critical less design wind speed; null unless ranked by it [m/s]", -2.597)
    clearance_m: float | None = told("Spacing less height or width; null unless ranked by it [m]", 3.6864)


class RankingPage(Answer):
    """Some lines of a ranking, in its order."""

    lines: list[RankedLine] = told("The lines of the page", [example_of(RankedLine)])
    next: str | None = told(
        "Address of the next page; null on the last",
        "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f/ranking?by=amplitude&cursor=AZmjxFt-fBqdLj9KW2x9jg",
    )


class LineFault(Answer):
    """One fault of a line that was rejected."""

    number: int = told("Number of the line, from 1; headers and the analysis do not count [1]", 3)
    reference: str | None = told("The caller's reference of the line", "row-3")
    pointer: str = told("JSON pointer from the root of the line", "/span/length_m")
    code: str = told("The kind of fault, for programs", "greater_than_equal")
    detail: str = told("What is wrong, in a sentence", "input should be greater than or equal to 1, got -5.0")


class BatchErrors(Answer):
    """Every fault of the lines that were rejected, in the order of their numbers."""

    errors: list[LineFault] = told("The faults", [example_of(LineFault)])


class BatchDocument(Answer):
    """State of a batch."""

    id: UUID = told("Identity of the batch", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f")
    status: Status = told("State; successful if any line is, once all have ended", "successful")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = told("How much is done, 0 to 1 [1]", 1.0)
    lines: LineCounts = told("How many lines are in which state", example_of(LineCounts))
    created_at: datetime = told("When the batch was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = told("When work on it began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = told("When its last line ended", "2026-11-22T10:00:05+00:00")
    errors: list[LineFault] = told(
        "Faults of the first rejected lines; a link leads to all of them", [example_of(LineFault)]
    )
    links: list[Link] = told(
        "Where to go on", [{"rel": "self", "href": "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f"}]
    )


class BatchSummary(Answer):
    """State of a batch in a list."""

    id: UUID = told("Identity of the batch", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f")
    status: Status = told("State; successful if any line is, once all have ended", "successful")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = told("How much is done, 0 to 1 [1]", 1.0)
    lines: LineCounts = told("How many lines are in which state", example_of(LineCounts))
    created_at: datetime = told("When the batch was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = told("When work on it began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = told("When its last line ended", "2026-11-22T10:00:05+00:00")
    links: list[Link] = told(
        "Where to go on", [{"rel": "self", "href": "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f"}]
    )


class BatchPage(Answer):
    """Some batches, newest first."""

    batches: list[BatchSummary] = told("The batches of the page", [example_of(BatchSummary)])
    next: str | None = told(
        "Address of the next page; null on the last", "/v1/batches?limit=20&cursor=AZmjxFt-fBqdLj9KW2x9jg"
    )
