"""Results, one row for each point: columns for filters, rankings and summaries, and everything else packed."""

from typing import Any
from uuid import UUID

from sqlalchemy import JSON, ForeignKey, Index, LargeBinary, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class PointRow(Base):
    """One point of a study, or one line of a chunk under its number; a job without a study has the single point 0.

    tables and orbits are JSON compressed by Zstandard (`app.storage.stored_results`), null for a point that failed. The
    indexed figures rank the lines of a batch. input_hash finds the result of a line again (`app.jobs.reuse`); it is
    null for points of a study. verdict is the row of that table; it is null in rows that were stored before the column.
    """

    __tablename__ = "results"
    __table_args__ = tuple(
        Index(None, "batch_id", column, "point")
        for column in (
            "lowest_critical_wind_speed_m_per_s",
            "largest_vertical_m",
            "largest_height_m",
            "largest_width_m",
            "galloping_hours_a_year",
        )
    )

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
    lowest_critical_wind_speed_m_per_s: Mapped[float | None]
    largest_vertical_m: Mapped[float | None]
    tables: Mapped[bytes | None] = mapped_column(LargeBinary)
    orbits: Mapped[bytes | None] = mapped_column(LargeBinary)
    twist_rad: Mapped[float | None]
    batch_id: Mapped[UUID | None]
    largest_height_m: Mapped[float | None]
    largest_width_m: Mapped[float | None]
    input_hash: Mapped[str | None] = mapped_column(String(64), index=True)
    verdict: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    galloping_hours_a_year: Mapped[float | None]
