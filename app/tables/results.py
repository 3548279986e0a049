"""The flat result rows of the contract."""

from typing import Any
from uuid import UUID

from sqlalchemy import ForeignKey, ForeignKeyConstraint, String, Text
from sqlalchemy.orm import Mapped, declared_attr, mapped_column

from app.tables.base import Base


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
