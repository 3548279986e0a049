"""Labels of jobs and batches, changed after they were submitted."""

from typing import Annotated

from pydantic import Field

from app.schemas.fields import Document, Label, TagKey


class BatchLabels(Document):
    """Labels of a batch to change: absent ones stay, and null removes one (JSON Merge Patch, RFC 7396)."""

    name: Label | None = Field(default=None, description="Name to show to people", examples=["Winter check"])
    tags: Annotated[dict[TagKey, Label | None], Field(max_length=50)] | None = Field(
        default=None,
        description="Tags to add or change by their keys, and with null to remove; null in place of all removes all",
        examples=[{"region": "north", "season": None}],
    )

    def changed_tags(self, kept: dict[str, str]) -> dict[str, str]:
        """Return tags as they are after the change."""
        if "tags" not in self.model_fields_set:
            return kept
        both = {**kept, **self.tags} if self.tags is not None else {}
        return {key: value for key, value in sorted(both.items()) if value is not None}


class JobLabels(BatchLabels):
    """Labels of a job to change: absent ones stay, and null removes one (JSON Merge Patch, RFC 7396)."""

    asset_id: Label | None = Field(default=None, description="Identity in the owner's records", examples=["L204-S017"])
