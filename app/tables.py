"""The tables: jobs with tags and events, and the flat result rows of the contract. One schema for both databases."""

from datetime import UTC, datetime
from enum import StrEnum
from typing import Any
from uuid import UUID

from sqlalchemy import (
    JSON,
    BigInteger,
    CheckConstraint,
    DateTime,
    Dialect,
    Double,
    Enum,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    MetaData,
    String,
    Text,
    TypeDecorator,
    Uuid,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, declared_attr, mapped_column, relationship


class JobStatus(StrEnum):
    """States of a job, as in OGC API - Processes."""

    ACCEPTED = "accepted"
    RUNNING = "running"
    SUCCESSFUL = "successful"
    FAILED = "failed"
    DISMISSED = "dismissed"


class FailureKind(StrEnum):
    """Whose fault a failure is: the first three are of the input or the model, the others of the service."""

    INPUT = "input"
    NO_CONVERGENCE = "no_convergence"
    TIME_LIMIT = "time_limit"
    WORKER_LOST = "worker_lost"
    INTERNAL = "internal"


class JobEventKind(StrEnum):
    """What can happen to a job."""

    ACCEPTED = "accepted"
    RUNNING = "running"
    RELEASED = "released"
    CANCEL_REQUESTED = "cancel_requested"
    SUCCESSFUL = "successful"
    FAILED = "failed"
    DISMISSED = "dismissed"


class UtcDateTime(TypeDecorator[datetime]):
    """A moment in UTC: aware in Python on both databases, though SQLite keeps no time zone."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Turn an aware moment into UTC.

        Raises
        ------
        ValueError
            If the moment is naive.
        """
        if value is not None and value.tzinfo is None:
            raise ValueError(f"a moment needs a time zone, got {value!r}")
        return value and value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Give the moment its time zone."""
        return value and (value.astimezone(UTC) if value.tzinfo else value.replace(tzinfo=UTC))


def _words(kind: type[StrEnum], name: str) -> Enum:
    """Make a column type of an enum's words with a CHECK constraint of this name."""
    words = [member.value for member in kind]
    return Enum(
        kind, name=name, native_enum=False, create_constraint=True, length=32, values_callable=lambda _: list(words)
    )


class Base(DeclarativeBase):
    """Base of all tables; constraints have names, so that migrations can speak of them on both databases."""

    metadata = MetaData(
        naming_convention={
            "pk": "pk_%(table_name)s",
            "fk": "fk_%(table_name)s_%(referred_table_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        }
    )
    type_annotation_map = {  # noqa: RUF012 - SQLAlchemy's own way of declaring it
        datetime: UtcDateTime,
        float: Double,
        int: Integer,
        str: String,
        UUID: Uuid,
        JobStatus: _words(JobStatus, "status"),
        FailureKind: _words(FailureKind, "failure_kind"),
        JobEventKind: _words(JobEventKind, "kind"),
        dict[str, Any]: JSON,
        list[str]: JSON,
        list[float]: JSON,
    }


class Job(Base):
    """One request: the document that came in, its state, and who works on it until when."""

    __tablename__ = "jobs"
    __table_args__ = (
        CheckConstraint("(status = 'failed') = (failure_kind IS NOT NULL)", name="failed_with_kind"),
        CheckConstraint("(status = 'running') = (lease_expires_at IS NOT NULL)", name="running_with_lease"),
        Index(None, "created_at", "id"),
        Index(None, "status", "dispatched_at"),
        Index(None, "status", "lease_expires_at"),
        Index(None, "asset_id", "created_at"),
        Index(None, "batch_id", "created_at"),
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
    """One thing that happened to a job, in the order of the ids."""

    __tablename__ = "job_events"
    __table_args__ = (Index(None, "job_id", "id"),)

    id: Mapped[int] = mapped_column(BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=True)
    job_id: Mapped[UUID] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"))
    at: Mapped[datetime]
    kind: Mapped[JobEventKind]
    attempt: Mapped[int]
    detail: Mapped[str | None] = mapped_column(Text)


class PointRow(Base):
    """What holds for a whole point of a study; a job without a study has the one point 0."""

    __tablename__ = "results"

    job_id: Mapped[UUID] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)
    point: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    axes: Mapped[dict[str, Any]]
    horizontal_tension_n: Mapped[float | None]
    catenary_parameter_m: Mapped[float | None]
    sag_m: Mapped[float | None]
    longitudinal_stiffness_n_per_m: Mapped[float | None]
    den_hartog_coefficient: Mapped[float | None]
    den_hartog_unstable: Mapped[bool | None]
    warnings: Mapped[list[str]]
    engine_version: Mapped[str] = mapped_column(String(64))
    failure: Mapped[str | None] = mapped_column(Text)


class _ResultRow(Base):
    """What all result rows share: the job, the point of its study, and the row's place in the answer."""

    __abstract__ = True

    @declared_attr.directive
    @classmethod
    def __table_args__(cls) -> tuple[ForeignKeyConstraint]:
        """Tie the row to its point; each table needs a constraint object of its own."""
        return (ForeignKeyConstraint(["job_id", "point"], ["results.job_id", "results.point"], ondelete="CASCADE"),)

    job_id: Mapped[UUID] = mapped_column(primary_key=True, sort_order=-3)
    point: Mapped[int] = mapped_column(primary_key=True, autoincrement=False, sort_order=-2)
    row_number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False, sort_order=-1)


class FrequencyRow(_ResultRow):
    """Natural frequencies without wind."""

    __tablename__ = "frequencies"

    model: Mapped[str]
    loops: Mapped[int]
    vertical_hz: Mapped[float | None]
    horizontal_hz: Mapped[float | None]
    torsional_hz: Mapped[float | None]
    outcome: Mapped[str]


class CriticalWindSpeedRow(_ResultRow):
    """One crossing of the imaginary axis by eigenvalues of the static state."""

    __tablename__ = "critical_wind_speeds"

    model: Mapped[str]
    loops: Mapped[int]
    wind_speed_m_per_s: Mapped[float]
    crossing: Mapped[str]
    type: Mapped[str]
    direction: Mapped[str]
    frequency_hz: Mapped[float]
    unstable_pairs_after: Mapped[int]


class LimitCycleRow(_ResultRow):
    """One motion at one wind speed."""

    __tablename__ = "limit_cycles"

    model: Mapped[str]
    loops: Mapped[int]
    wind_speed_m_per_s: Mapped[float]
    branch: Mapped[int | None]
    kind: Mapped[str]
    stability: Mapped[str]
    frequency_hz: Mapped[float | None]
    second_frequency_hz: Mapped[float | None]
    observed_at_m: Mapped[float]
    vertical_m: Mapped[float | None]
    horizontal_m: Mapped[float | None]
    torsional_rad: Mapped[float | None]
    vertical_min_m: Mapped[float | None]
    horizontal_min_m: Mapped[float | None]
    torsional_min_rad: Mapped[float | None]
    vertical_ratio: Mapped[float | None]
    horizontal_ratio: Mapped[float | None]
    reduced_wind_speed: Mapped[float | None]
    outcome: Mapped[str]


class BifurcationRow(_ResultRow):
    """One place where the kind or the number of motions changes."""

    __tablename__ = "bifurcations"

    model: Mapped[str]
    loops: Mapped[int]
    branch: Mapped[int]
    type: Mapped[str]
    wind_speed_m_per_s: Mapped[float]
    frequency_hz: Mapped[float]
    second_frequency_hz: Mapped[float | None]
    uncertainty_m_per_s: Mapped[float]


class OrbitRow(_ResultRow):
    """Fourier coefficients (mean, cos 1, sin 1, ...) of the cycle in row `cycle` of the point's limit cycles."""

    __tablename__ = "orbits"

    cycle: Mapped[int]
    vertical: Mapped[list[float]]
    horizontal: Mapped[list[float]]
    torsional: Mapped[list[float]]
