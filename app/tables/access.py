"""API keys, and the audit record of who changed what."""

from datetime import datetime
from enum import StrEnum
from uuid import UUID

from sqlalchemy import Enum, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class AuditAction(StrEnum):
    """The actions that the audit record holds."""

    KEY_CREATED = "key_created"
    KEY_REVOKED = "key_revoked"
    KEY_REFUSED = "key_refused"
    SIGNED_IN = "signed_in"
    SIGNED_OUT = "signed_out"
    JOB_SUBMITTED = "job_submitted"
    JOB_CANCELLED = "job_cancelled"
    JOB_RELABELLED = "job_relabelled"
    JOB_REMOVED = "job_removed"
    BATCH_SUBMITTED = "batch_submitted"
    BATCH_RESUBMITTED = "batch_resubmitted"
    BATCH_RELABELLED = "batch_relabelled"
    BATCH_CANCELLED = "batch_cancelled"
    BATCH_REMOVED = "batch_removed"
    PRUNED = "pruned"


# No CHECK constraint: a new action would force SQLite to rebuild its largest table.
_ACTION = Enum(AuditAction, native_enum=False, length=32, values_callable=lambda kind: [word.value for word in kind])


class ApiKey(Base):
    """A key, stored as the SHA-256 of its text; `prefix` is the part that may be shown."""

    __tablename__ = "api_keys"

    id: Mapped[UUID] = mapped_column(primary_key=True)
    created_at: Mapped[datetime]
    expires_at: Mapped[datetime | None]
    revoked_at: Mapped[datetime | None]
    used_at: Mapped[datetime | None]
    owner: Mapped[str] = mapped_column(String(64))
    name: Mapped[str | None] = mapped_column(Text)
    prefix: Mapped[str] = mapped_column(String(32))
    digest: Mapped[str] = mapped_column(String(64), unique=True)
    scopes: Mapped[list[str]]


class EndedSession(Base):
    """A session of a browser that was ended before its cookie expires, which it has done by then on every clock."""

    __tablename__ = "ended_sessions"
    __table_args__ = (Index(None, "expires_at"),)

    id: Mapped[UUID] = mapped_column(primary_key=True)
    expires_at: Mapped[datetime]


class AuditEvent(Base):
    """One change and who made it. It remains when its subject or the key is deleted, so it references neither.

    The ids follow the order of time. key_id is null for the operator and for a caller without a key.
    """

    __tablename__ = "audit_events"

    id: Mapped[UUID] = mapped_column(primary_key=True)
    at: Mapped[datetime]
    owner: Mapped[str] = mapped_column(String(64))
    key_id: Mapped[UUID | None]
    action: Mapped[AuditAction] = mapped_column(_ACTION)
    subject: Mapped[UUID | None]
    detail: Mapped[str | None] = mapped_column(Text)
