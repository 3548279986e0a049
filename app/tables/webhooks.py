"""Webhook messages and the log of their attempts."""

from datetime import datetime
from enum import StrEnum
from typing import Any
from uuid import UUID

from sqlalchemy import JSON, CheckConstraint, ForeignKey, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class DeliveryState(StrEnum):
    """States of a delivery: its event is awaited or never comes; it is to be sent, has arrived, or was given up."""

    WAITING = "waiting"
    PENDING = "pending"
    DELIVERED = "delivered"
    FAILED = "failed"
    NOT_NEEDED = "not_needed"


class DeliveryEvent(StrEnum):
    """What a message tells: the end of a job or a batch, or of a job its beginning, its results or its failure."""

    ENDED = "ended"
    STARTED = "started"
    SUCCEEDED = "succeeded"
    FAILED = "failed"


class WebhookDelivery(Base):
    """One message for one receiver; log has an entry for each attempt.

    The payload is written when the message is due if it tells the end, and composed when it is sent if it tells another
    event, since results may be large.
    While a sender holds the message, next_attempt_at is the end of its lease.
    """

    __tablename__ = "webhook_deliveries"
    __table_args__ = (
        CheckConstraint("(job_id IS NULL) <> (batch_id IS NULL)", name="job_or_batch"),
        Index(None, "state", "next_attempt_at"),
        Index(None, "job_id"),
        Index(None, "batch_id"),
    )

    id: Mapped[UUID] = mapped_column(primary_key=True)
    owner: Mapped[str] = mapped_column(String(64))
    job_id: Mapped[UUID | None] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"))
    batch_id: Mapped[UUID | None] = mapped_column(ForeignKey("batches.id", ondelete="CASCADE"))
    url: Mapped[str] = mapped_column(Text)
    receiver: Mapped[str] = mapped_column(Text)
    created_at: Mapped[datetime]
    state: Mapped[str] = mapped_column(String(16))
    payload: Mapped[str | None] = mapped_column(Text)
    attempts: Mapped[int] = mapped_column(default=0)
    next_attempt_at: Mapped[datetime | None]
    log: Mapped[list[dict[str, Any]]] = mapped_column(JSON)
    event: Mapped[str] = mapped_column(String(16), default=DeliveryEvent.ENDED.value)
