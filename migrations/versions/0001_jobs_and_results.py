"""Jobs with their tags and events, and the result rows.

Revision: 0001
"""

from typing import Any

import sqlalchemy as sa
from alembic import op

from app.tables import UtcDateTime

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

_RESULT_TABLES = ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations", "orbits")


def upgrade() -> None:
    _create_jobs()
    _create_job_tags()
    _create_job_events()
    _create_results()
    _create_frequencies()
    _create_critical_wind_speeds()
    _create_limit_cycles()
    _create_bifurcations()
    _create_orbits()


def downgrade() -> None:
    for table in (*reversed(_RESULT_TABLES), "results", "job_events", "job_tags", "jobs"):
        op.drop_table(table)


def _create_jobs() -> None:
    op.create_table(
        "jobs",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("created_at", UtcDateTime(), nullable=False),
        sa.Column("started_at", UtcDateTime()),
        sa.Column("finished_at", UtcDateTime()),
        _words("status", "accepted", "running", "successful", "failed", "dismissed"),
        sa.Column("progress", sa.Double(), nullable=False),
        sa.Column("step", sa.Text(), nullable=False),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("lease_owner", sa.Text()),
        sa.Column("lease_expires_at", UtcDateTime()),
        sa.Column("cancel_requested", sa.Boolean(), nullable=False),
        sa.Column("dispatched_at", UtcDateTime()),
        _words("failure_kind", "input", "no_convergence", "time_limit", "worker_lost", "internal", nullable=True),
        sa.Column("failure_detail", sa.Text()),
        sa.Column("name", sa.Text()),
        sa.Column("asset_id", sa.Text()),
        sa.Column("batch_id", sa.Uuid()),
        sa.Column("document", sa.JSON(), nullable=False),
        sa.Column("input_hash", sa.String(64), nullable=False),
        sa.Column("engine_version", sa.String(64)),
        sa.CheckConstraint("(status = 'failed') = (failure_kind IS NOT NULL)", name="failed_with_kind"),
        sa.CheckConstraint("(status = 'running') = (lease_expires_at IS NOT NULL)", name="running_with_lease"),
        sa.PrimaryKeyConstraint("id", name="pk_jobs"),
    )
    _index("jobs", "created_at", "id")
    _index("jobs", "status", "dispatched_at")
    _index("jobs", "status", "lease_expires_at")
    _index("jobs", "asset_id", "created_at")
    _index("jobs", "batch_id", "created_at")


def _create_job_tags() -> None:
    op.create_table(
        "job_tags",
        sa.Column("job_id", sa.Uuid(), nullable=False),
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("value", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("job_id", "key", name="pk_job_tags"),
        _belongs_to_job("job_tags"),
    )
    _index("job_tags", "key", "value", "job_id")


def _create_job_events() -> None:
    words = ("accepted", "running", "released", "cancel_requested", "successful", "failed", "dismissed")
    op.create_table(
        "job_events",
        sa.Column("id", sa.BigInteger().with_variant(sa.Integer(), "sqlite"), autoincrement=True, nullable=False),
        sa.Column("job_id", sa.Uuid(), nullable=False),
        sa.Column("at", UtcDateTime(), nullable=False),
        _words("kind", *words),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("detail", sa.Text()),
        sa.PrimaryKeyConstraint("id", name="pk_job_events"),
        _belongs_to_job("job_events"),
    )
    _index("job_events", "job_id", "id")


def _create_results() -> None:
    op.create_table(
        "results",
        sa.Column("job_id", sa.Uuid(), nullable=False),
        sa.Column("point", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("axes", sa.JSON(), nullable=False),
        *_numbers("horizontal_tension_n", "catenary_parameter_m", "sag_m", "longitudinal_stiffness_n_per_m"),
        *_numbers("den_hartog_coefficient"),
        sa.Column("den_hartog_unstable", sa.Boolean()),
        sa.Column("warnings", sa.JSON(), nullable=False),
        sa.Column("engine_version", sa.String(64), nullable=False),
        sa.Column("failure", sa.Text()),
        sa.PrimaryKeyConstraint("job_id", "point", name="pk_results"),
        _belongs_to_job("results"),
    )


def _create_frequencies() -> None:
    _create_result_table(
        "frequencies",
        *_numbers("vertical_hz", "horizontal_hz", "torsional_hz"),
        sa.Column("outcome", sa.String(), nullable=False),
    )


def _create_critical_wind_speeds() -> None:
    _create_result_table(
        "critical_wind_speeds",
        *_numbers("wind_speed_m_per_s", nullable=False),
        sa.Column("crossing", sa.String(), nullable=False),
        sa.Column("type", sa.String(), nullable=False),
        sa.Column("direction", sa.String(), nullable=False),
        *_numbers("frequency_hz", nullable=False),
        sa.Column("unstable_pairs_after", sa.Integer(), nullable=False),
    )


def _create_limit_cycles() -> None:
    _create_result_table(
        "limit_cycles",
        *_numbers("wind_speed_m_per_s", nullable=False),
        sa.Column("branch", sa.Integer()),
        sa.Column("kind", sa.String(), nullable=False),
        sa.Column("stability", sa.String(), nullable=False),
        *_numbers("frequency_hz", "second_frequency_hz"),
        *_numbers("observed_at_m", nullable=False),
        *_numbers("vertical_m", "horizontal_m", "torsional_rad"),
        *_numbers("vertical_min_m", "horizontal_min_m", "torsional_min_rad"),
        *_numbers("vertical_ratio", "horizontal_ratio", "reduced_wind_speed"),
        sa.Column("outcome", sa.String(), nullable=False),
    )


def _create_bifurcations() -> None:
    _create_result_table(
        "bifurcations",
        sa.Column("branch", sa.Integer(), nullable=False),
        sa.Column("type", sa.String(), nullable=False),
        *_numbers("wind_speed_m_per_s", "frequency_hz", nullable=False),
        *_numbers("second_frequency_hz"),
        *_numbers("uncertainty_m_per_s", nullable=False),
    )


def _create_orbits() -> None:
    shapes = [sa.Column(name, sa.JSON(), nullable=False) for name in ("vertical", "horizontal", "torsional")]
    _create_result_table("orbits", sa.Column("cycle", sa.Integer(), nullable=False), *shapes, labelled=False)


def _create_result_table(name: str, *columns: sa.Column[Any], labelled: bool = True) -> None:
    model = [sa.Column("model", sa.String(), nullable=False), sa.Column("loops", sa.Integer(), nullable=False)]
    point = ["results.job_id", "results.point"]
    op.create_table(
        name,
        sa.Column("job_id", sa.Uuid(), nullable=False),
        sa.Column("point", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("row_number", sa.Integer(), autoincrement=False, nullable=False),
        *(model if labelled else ()),
        *columns,
        sa.PrimaryKeyConstraint("job_id", "point", "row_number", name=f"pk_{name}"),
        sa.ForeignKeyConstraint(["job_id", "point"], point, name=f"fk_{name}_results", ondelete="CASCADE"),
    )


def _words(name: str, *words: str, nullable: bool = False) -> sa.Column[str]:
    kind = sa.Enum(*words, name=name, native_enum=False, create_constraint=True, length=32)
    return sa.Column(name, kind, nullable=nullable)


def _numbers(*names: str, nullable: bool = True) -> list[sa.Column[float]]:
    return [sa.Column(name, sa.Double(), nullable=nullable) for name in names]


def _belongs_to_job(table: str) -> sa.ForeignKeyConstraint:
    return sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=f"fk_{table}_jobs", ondelete="CASCADE")


def _index(table: str, *columns: str) -> None:
    op.create_index(f"ix_{table}_{'_'.join(columns)}", table, list(columns))
