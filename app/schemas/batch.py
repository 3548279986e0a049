"""Batches as they come in."""

from typing import Any

from pydantic import Field

from app.reference.source_lines import example
from app.schemas.analysis import Analysis
from app.schemas.fields import Document, Reference
from app.schemas.line import Line


class BatchLine(Line):
    """A line of a batch: the fields of a line, and the caller's own reference beside them."""

    reference: Reference | None = Field(
        default=None, description="The caller's reference, given back with the results", examples=["row-17"]
    )


class BatchRequest(Document):
    """Many lines under one analysis."""

    lines: list[BatchLine] = Field(
        min_length=1, max_length=100_000, description="The lines", examples=[[example("c11-twin")]]
    )
    analysis: Analysis = Field(default=Analysis(), description="Analysis of every line", examples=[{"loops": [1, 2]}])
    defaults: dict[str, Any] | None = Field(
        default=None,
        description="Fields of a line, for the lines that leave them open",
        examples=[{"wind": {"air_density_kg_per_m3": 1.34}}],
    )
    webhook_url: str | None = Field(
        default=None,
        max_length=2000,
        description="https address to which the service posts a signed message when the batch ends",
        examples=["https://assets.example.com/galloping"],
    )
