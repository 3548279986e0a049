"""What all tables share: state names, UTC times, named constraints."""

from datetime import UTC, datetime
from enum import StrEnum
from typing import Any
from uuid import UUID

from sqlalchemy import JSON, DateTime, Dialect, Double, Enum, Integer, MetaData, String, TypeDecorator, Uuid
from sqlalchemy.orm import DeclarativeBase


class JobStatus(StrEnum):
    """States of a job, as in OGC API - Processes."""

    ACCEPTED = "accepted"
    RUNNING = "running"
    SUCCESSFUL = "successful"
    FAILED = "failed"
    DISMISSED = "dismissed"


ENDED = frozenset({JobStatus.SUCCESSFUL, JobStatus.FAILED, JobStatus.DISMISSED})
"""The final states."""


class FailureKind(StrEnum):
    """Kinds of failure: the first three come from the input or the model, the others from the service."""

    INPUT = "input"
    NO_CONVERGENCE = "no_convergence"
    TIME_LIMIT = "time_limit"
    WORKER_LOST = "worker_lost"
    INTERNAL = "internal"


class JobEventKind(StrEnum):
    """Kinds of events in a job's history."""

    ACCEPTED = "accepted"
    RUNNING = "running"
    RELEASED = "released"
    CANCEL_REQUESTED = "cancel_requested"
    SUCCESSFUL = "successful"
    FAILED = "failed"
    DISMISSED = "dismissed"


class UtcDateTime(TypeDecorator[datetime]):
    """A time in UTC, timezone-aware in Python on both databases, though SQLite stores no time zone."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Convert an aware time to UTC.

        Raises
        ------
        ValueError
            If the time is naive.
        """
        if value is not None and value.tzinfo is None:
            raise ValueError(f"a time needs a time zone, got {value!r}")
        return value and value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Attach the time zone."""
        return value and (value.astimezone(UTC) if value.tzinfo else value.replace(tzinfo=UTC))


def _words(kind: type[StrEnum], name: str) -> Enum:
    """Return a column type for an enum's words, with a CHECK constraint of this name."""
    words = [member.value for member in kind]
    return Enum(
        kind, name=name, native_enum=False, create_constraint=True, length=32, values_callable=lambda _: list(words)
    )


class Base(DeclarativeBase):
    """Base of all tables; constraints have names, so that migrations can refer to them on both databases."""

    metadata = MetaData(
        naming_convention={
            "pk": "pk_%(table_name)s",
            "fk": "fk_%(table_name)s_%(referred_table_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        }
    )
    type_annotation_map = {  # noqa: RUF012 - SQLAlchemy expects a class attribute
        datetime: UtcDateTime,
        float: Double,
        int: Integer,
        str: String,
        UUID: Uuid,
        JobStatus: _words(JobStatus, "status"),
        FailureKind: _words(FailureKind, "failure_kind"),
        JobEventKind: _words(JobEventKind, "kind"),
        dict[str, Any]: JSON(none_as_null=True),
        list[dict[str, str]]: JSON(none_as_null=True),
        list[str]: JSON,
        list[float]: JSON,
    }
