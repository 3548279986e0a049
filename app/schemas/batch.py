"""Batches: what comes in, and the documents that tell how far they are."""

from datetime import datetime
from typing import Annotated
from uuid import UUID

from pydantic import Field

from app.schemas.analysis import Analysis
from app.schemas.answers import Link, Status
from app.schemas.fields import Answer, Document, Label
from app.schemas.line import Line

Count = Annotated[int, Field(ge=0)]


class BatchLine(Line):
    """A line of a batch: the fields of a line, and the caller's own reference beside them."""

    reference: Label | None = Field(
        default=None, description="The caller's reference, given back with the results", examples=["row-17"]
    )


class BatchRequest(Document):
    """Many lines under one analysis."""

    lines: list[BatchLine] = Field(min_length=1, max_length=100_000, description="The lines")
    analysis: Analysis = Field(default=Analysis(), description="What is asked of every line")


class LineCounts(Answer):
    """How many lines are in which state."""

    total: Count = Field(description="All lines that came in [1]")
    accepted: Count = Field(description="Waiting [1]")
    running: Count = Field(description="In a chunk that is being worked on [1]")
    successful: Count = Field(description="With results [1]")
    failed: Count = Field(description="Without; see their failures in the results [1]")
    dismissed: Count = Field(description="Cancelled before they were worked on [1]")
    rejected: Count = Field(description="Never taken, since they are at fault; see errors [1]")


class LineFault(Answer):
    """One fault of a line that was rejected."""

    number: int = Field(description="Number of the line, from 1; headers and the analysis do not count [1]")
    reference: str | None
    pointer: str = Field(description="JSON pointer from the root of the line")
    code: str
    detail: str


class BatchErrors(Answer):
    """Every fault of the lines that were rejected, in the order of their numbers."""

    errors: list[LineFault]


class BatchDocument(Answer):
    """State of a batch."""

    id: UUID
    status: Status = Field(description="Successful if any line is, once all have ended")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = Field(description="How much is done, 0 to 1 [1]")
    lines: LineCounts
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    errors: list[LineFault] = Field(description="Faults of the first rejected lines; a link leads to all of them")
    links: list[Link]


class BatchSummary(Answer):
    """State of a batch in a list."""

    id: UUID
    status: Status
    progress: Annotated[float, Field(ge=0.0, le=1.0)]
    lines: LineCounts
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    links: list[Link]


class BatchPage(Answer):
    """Some batches, newest first."""

    batches: list[BatchSummary]
    next: str | None = Field(description="Address of the next page; null on the last")
