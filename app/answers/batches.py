"""Answers about batches: status, results of lines, faults and rankings."""

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Literal
from uuid import UUID

from pydantic import Field

from app.answers.jobs import Link, Status
from app.answers.results import TableName
from app.schemas.fields import Answer, described, example_of

if TYPE_CHECKING:
    BatchTableName = str
else:
    BatchTableName = Literal[TableName, "summary"]
Count = Annotated[int, Field(ge=0)]


class LineCounts(Answer):
    """Number of lines in each state."""

    total: Count = described("All lines received [1]", 3)
    accepted: Count = described("Lines that wait for a worker [1]", 0)
    running: Count = described("Lines in a chunk that a worker is computing [1]", 0)
    successful: Count = described("Lines with results [1]", 2)
    failed: Count = described("Lines without results; the results list their failures [1]", 0)
    dismissed: Count = described("Lines cancelled before they were computed [1]", 0)
    rejected: Count = described("Lines rejected because of faults; see errors [1]", 1)
    reused: Count = described("Successful lines whose results were stored before [1]", 0)


_HOURS = (
    "Hours a year in which the line gallops or nothing is known of it, by the model with the most of them; null "
    "without a climate [h]"
)


class LineSummary(Answer):
    """The result of one line in a row, together with its verdict, static state and Den Hartog's criterion."""

    number: int = described("Number of the line, from 1; headers and the analysis do not count [1]", 1)
    reference: str | None = described("The caller's reference of the line", "row-1")
    asset_id: str | None = described("Identity of the line in the owner's records", "L204-S017")
    name: str | None = described("Name of the line", "C11 twin, 126 m")
    status: str = described("State of the line", "successful")
    failure: str | None = described("Why there are no results, in a sentence", "The job ran longer than 3600 s.")
    lowest_critical_wind_speed_m_per_s: float | None = described("Wind speed from which the line gallops [m/s]", 2.403)
    largest_vertical_m: float | None = described("Largest vertical amplitude of a stable motion [m]", 0.1568)
    largest_height_m: float | None = described(
        "Largest height of the space that the sub-conductors sweep in a stable motion [m]", 0.3136
    )
    largest_width_m: float | None = described(
        "Largest width of the space that the sub-conductors sweep in a stable motion [m]", 0.4908
    )
    galloping_hours_a_year: float | None = described(_HOURS, 6.8)
    unknown_motions: bool = described(
        "Whether a motion is unknown or unbounded at some wind speed; amplitude, height and width are then null", False
    )
    engine_version: str | None = described("Version of the computation", "0.1.0")


class RankedLine(Answer):
    """One line of a ranking."""

    rank: int = described("Place in the ranking, from 1 [1]", 1)
    number: int = described("Number of the line, from 1 [1]", 17)
    reference: str | None = described("The caller's reference of the line", "row-17")
    asset_id: str | None = described("Identity of the line in the owner's records", "L204-S017")
    lowest_critical_wind_speed_m_per_s: float | None = described("Wind speed from which the line gallops [m/s]", 2.403)
    largest_vertical_m: float | None = described("Largest vertical amplitude of a stable motion [m]", 0.1568)
    largest_height_m: float | None = described(
        "Largest height of the space that the sub-conductors sweep in a stable motion [m]", 0.3136
    )
    largest_width_m: float | None = described(
        "Largest width of the space that the sub-conductors sweep in a stable motion [m]", 0.4908
    )
    galloping_hours_a_year: float | None = described(_HOURS, 6.8)
    unknown_motions: bool = described(
        "Whether a motion is unknown or unbounded at some wind speed; amplitude, height and width are then null", False
    )
    margin_m_per_s: float | None = described("Critical minus design wind speed; null unless ranked by it [m/s]", -2.597)
    clearance_m: float | None = described("Spacing minus height or width; null unless ranked by it [m]", 3.6864)


class RankingPage(Answer):
    """One page of a ranking."""

    lines: list[RankedLine] = described("The lines of the page", [example_of(RankedLine)])
    next: str | None = described(
        "Address of the next page; null on the last",
        "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f/ranking?by=amplitude&cursor=AZmjxFt-fBqdLj9KW2x9jg",
    )


class LineFault(Answer):
    """One fault of a rejected line."""

    number: int = described("Number of the line, from 1; headers and the analysis do not count [1]", 3)
    reference: str | None = described("The caller's reference of the line", "row-3")
    row: int | None = described("Number of the row as the spreadsheet shows it; null if the body was none [1]", 4)
    place: str | None = described("Where the line stands in the body, if that was a sheet or features", "row 4")
    pointer: str = described("JSON pointer from the root of the line", "/span/length_m")
    code: str = described("The kind of fault, for programs", "greater_than_equal")
    detail: str = described("What is wrong, in a sentence", "input should be greater than or equal to 1, got -5.0")


class BatchErrors(Answer):
    """Every fault of the rejected lines, in the order of their numbers."""

    errors: list[LineFault] = described("The faults", [example_of(LineFault)])


class BatchDocument(Answer):
    """Status of a batch."""

    id: UUID = described("Identity of the batch", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f")
    status: Status = described("State; a finished batch is successful if any line is", "successful")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = described("Share of the work done, 0 to 1 [1]", 1.0)
    name: str | None = described("Name of the batch", "Winter check")
    tags: dict[str, str] = described("Labels of the batch", {"region": "north"})
    lines: LineCounts = described("Number of lines in each state", example_of(LineCounts))
    created_at: datetime = described("When the batch was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = described("When work on it began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = described("When its last line ended", "2026-11-22T10:00:05+00:00")
    duration_seconds: float | None = described("Time from the begin of the work to its end [s]", 4.0)
    errors: list[LineFault] = described(
        "Faults of the first rejected lines; a link leads to all of them", [example_of(LineFault)]
    )
    notes: list[str] = described(
        "How the body was read, where that is not plain", ["Row 4 is not UTF-8; read as Windows-1252."]
    )
    links: list[Link] = described(
        "Links to related addresses", [{"rel": "self", "href": "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f"}]
    )


class BatchCheck(Answer):
    """What would become of a batch, of which nothing was stored."""

    total: Count = described("Lines read [1]", 3)
    rejected: Count = described("Lines that would be rejected because of faults [1]", 1)
    seconds: float = described("Computing time of the other lines on one core, estimated [s]", 1.3)
    errors: list[LineFault] = described("Faults of the first lines that would be rejected", [example_of(LineFault)])
    notes: list[str] = described(
        "How the body was read, where that is not plain", ["Row 4 is not UTF-8; read as Windows-1252."]
    )


class BatchSummary(Answer):
    """Status of a batch in a list."""

    id: UUID = described("Identity of the batch", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f")
    status: Status = described("State; a finished batch is successful if any line is", "successful")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = described("Share of the work done, 0 to 1 [1]", 1.0)
    name: str | None = described("Name of the batch", "Winter check")
    tags: dict[str, str] = described("Labels of the batch", {"region": "north"})
    lines: LineCounts = described("Number of lines in each state", example_of(LineCounts))
    created_at: datetime = described("When the batch was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = described("When work on it began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = described("When its last line ended", "2026-11-22T10:00:05+00:00")
    duration_seconds: float | None = described("Time from the begin of the work to its end [s]", 4.0)
    links: list[Link] = described(
        "Links to related addresses", [{"rel": "self", "href": "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f"}]
    )


class BatchPage(Answer):
    """One page of batches, newest first."""

    batches: list[BatchSummary] = described("The batches of the page", [example_of(BatchSummary)])
    next: str | None = described(
        "Address of the next page; null on the last", "/v1/batches?limit=20&cursor=AZmjxFt-fBqdLj9KW2x9jg"
    )
