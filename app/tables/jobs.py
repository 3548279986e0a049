"""Jobs with their tags and events."""

from datetime import datetime
from typing import Any
from uuid import UUID

from sqlalchemy import BigInteger, CheckConstraint, ForeignKey, Index, Integer, String, Text, text
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.runtime import correlation
from app.tables.base import Base, FailureKind, JobEventKind, JobStatus

_WAITS = text("status = 'accepted'")


class Job(Base):
    """One request, or a chunk of a batch: the document, the state, and the worker's lease.

    batch_id, lines, failed_lines and reused_lines belong to a chunk and are null for any other job. request_id and
    trace_parent come from the request that created the job. reused_from is the job or chunk whose results were copied;
    it may have been deleted since. request_bytes is what the job takes without its results; result_bytes is what these
    are expected to take until it has ended, then what they take. lease_expires_at and claimed_at are of the steady
    clock, all other moments of the database's.
    """

    __tablename__ = "jobs"
    __table_args__ = (
        CheckConstraint("(status = 'failed') = (failure_kind IS NOT NULL)", name="failed_with_kind"),
        CheckConstraint("(status = 'running') = (lease_expires_at IS NOT NULL)", name="running_with_lease"),
        Index(None, "owner", "created_at", "id"),
        Index(None, "status", "dispatched_at"),
        Index(None, "status", "lease_expires_at"),
        Index(
            "ix_jobs_waiting", "status", "owner", "batch_id", "created_at", postgresql_where=_WAITS, sqlite_where=_WAITS
        ),
        Index(None, "owner", "asset_id", "created_at"),
        Index(None, "batch_id", "created_at"),
        Index(None, "owner", "input_hash"),
        Index(None, "owner", "request_bytes", "result_bytes"),
    )

    id: Mapped[UUID] = mapped_column(primary_key=True)
    created_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]
    status: Mapped[JobStatus]
    progress: Mapped[float] = mapped_column(default=0.0)
    step: Mapped[str] = mapped_column(Text, default="")
    attempt: Mapped[int] = mapped_column(default=0)
    lease_owner: Mapped[str | None] = mapped_column(Text)
    lease_expires_at: Mapped[datetime | None]
    cancel_requested: Mapped[bool] = mapped_column(default=False)
    dispatched_at: Mapped[datetime | None]
    failure_kind: Mapped[FailureKind | None]
    failure_detail: Mapped[str | None] = mapped_column(Text)
    name: Mapped[str | None] = mapped_column(Text)
    asset_id: Mapped[str | None] = mapped_column(Text)
    batch_id: Mapped[UUID | None]
    document: Mapped[dict[str, Any]]
    input_hash: Mapped[str] = mapped_column(String(64))
    engine_version: Mapped[str | None] = mapped_column(String(64))
    lines: Mapped[int | None]
    failed_lines: Mapped[int | None]
    owner: Mapped[str] = mapped_column(String(64))
    request_id: Mapped[str | None] = mapped_column(String(correlation.LONGEST_REQUEST_ID))
    trace_parent: Mapped[str | None] = mapped_column(String(correlation.TRACE_PARENT_LENGTH))
    reused_from: Mapped[UUID | None]
    reused_lines: Mapped[int | None]
    claimed_at: Mapped[datetime | None]
    request_bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")
    result_bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")

    tags: Mapped[list["JobTag"]] = relationship(order_by="JobTag.key", lazy="selectin", passive_deletes=True)
    events: Mapped[list["JobEvent"]] = relationship(order_by="JobEvent.id", lazy="select", passive_deletes=True)


class JobTag(Base):
    """One label of a job."""

    __tablename__ = "job_tags"
    __table_args__ = (Index(None, "key", "value", "job_id"),)

    job_id: Mapped[UUID] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)
    key: Mapped[str] = mapped_column(Text, primary_key=True)
    value: Mapped[str] = mapped_column(Text)


class JobEvent(Base):
    """One event in a job's history, ordered by id."""

    __tablename__ = "job_events"
    __table_args__ = (Index(None, "job_id", "id"),)

    id: Mapped[int] = mapped_column(BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=True)
    job_id: Mapped[UUID] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"))
    at: Mapped[datetime]
    kind: Mapped[JobEventKind]
    attempt: Mapped[int]
    detail: Mapped[str | None] = mapped_column(Text)
