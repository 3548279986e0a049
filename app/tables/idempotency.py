"""Idempotency keys."""

from datetime import datetime
from typing import Any
from uuid import UUID

from sqlalchemy import CheckConstraint, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class IdempotencyKey(Base):
    """An owner's key and the first answer under it; `holder` is the request that holds the key until then.

    expires_at is the end of an answered key. Before the answer it is the time from which another request may take the
    key.
    """

    __tablename__ = "idempotency_keys"
    __table_args__ = (
        CheckConstraint("(status IS NULL) = (body IS NULL)", name="status_with_body"),
        CheckConstraint("(status IS NULL) = (fingerprint IS NULL)", name="status_with_fingerprint"),
        Index(None, "expires_at"),
    )

    owner: Mapped[str] = mapped_column(String(64), primary_key=True)
    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    expires_at: Mapped[datetime]
    holder: Mapped[UUID]
    fingerprint: Mapped[str | None] = mapped_column(String(64))
    status: Mapped[int | None]
    headers: Mapped[dict[str, Any] | None]
    body: Mapped[str | None] = mapped_column(Text)
