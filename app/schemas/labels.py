"""Labels of a job, changed after it was submitted."""

from typing import Annotated

from pydantic import Field

from app.schemas.fields import Document, Label, TagKey


class JobLabels(Document):
    """Labels to change: those that are absent stay, and null removes one (JSON Merge Patch, RFC 7396)."""

    name: Label | None = Field(default=None, description="Name to show to people", examples=["C11 twin, 126 m"])
    asset_id: Label | None = Field(default=None, description="Identity in the owner's records", examples=["L204-S017"])
    tags: Annotated[dict[TagKey, Label | None], Field(max_length=50)] | None = Field(
        default=None,
        description="Tags to add or change by their keys, and with null to remove; null in place of all removes all",
        examples=[{"region": "north", "season": None}],
    )
