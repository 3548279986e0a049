"""Batches and their lines."""

from datetime import datetime
from typing import Any
from uuid import UUID

from sqlalchemy import JSON, BigInteger, CheckConstraint, ForeignKey, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class Batch(Base):
    """Many lines under one analysis. Its chunks, the jobs with this batch_id, hold the lines and their states.

    received_at is null while the lines arrive; the batch is invisible until then. notes are sentences on how its body
    was read, null if there is nothing to tell. request_bytes is what the batch and its lines take, rejected ones, too.
    """

    __tablename__ = "batches"
    __table_args__ = (Index(None, "owner", "created_at", "id"),)

    id: Mapped[UUID] = mapped_column(primary_key=True)
    created_at: Mapped[datetime]
    received_at: Mapped[datetime | None]
    analysis: Mapped[dict[str, Any]]
    rejected_lines: Mapped[int] = mapped_column(default=0)
    owner: Mapped[str] = mapped_column(String(64))
    notes: Mapped[list[str] | None] = mapped_column(JSON(none_as_null=True))
    name: Mapped[str | None] = mapped_column(Text)
    tags: Mapped[dict[str, str] | None] = mapped_column(JSON(none_as_null=True))
    request_bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")


class BatchItem(Base):
    """One line of a batch: its document and its chunk, or its faults if it was rejected.

    known: what was said of a line in an engineer's form, with the own rows that it names; document is what follows.
    geometry is its place as GeoJSON, computed the rows of the table `assumptions` that follow from it; null without.
    chunk_id has no foreign key: lines are stored as they arrive, their chunks all together at the end.
    """

    __tablename__ = "batch_items"
    __table_args__ = (
        CheckConstraint("(faults IS NULL) = (chunk_id IS NOT NULL)", name="faults_or_chunk"),
        CheckConstraint("(faults IS NULL) = (document IS NOT NULL)", name="faults_or_document"),
        Index(None, "chunk_id"),
    )

    batch_id: Mapped[UUID] = mapped_column(ForeignKey("batches.id", ondelete="CASCADE"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    chunk_id: Mapped[UUID | None]
    reference: Mapped[str | None] = mapped_column(Text)
    asset_id: Mapped[str | None] = mapped_column(Text)
    document: Mapped[dict[str, Any] | None]
    faults: Mapped[list[dict[str, str]] | None]
    known: Mapped[dict[str, Any] | None]
    geometry: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    computed: Mapped[list[dict[str, Any]] | None] = mapped_column(JSON(none_as_null=True))
