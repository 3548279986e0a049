"""Results of a batch's lines carry their batch, and height and width of the motion, indexed for rankings.

Lines that were stored before have neither height nor width, and the largest amplitude of all motions instead of those
that last.

Revision: 0010
"""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

_ADDED = ("largest_height_m", "largest_width_m")
_RANKED = ("lowest_critical_wind_speed_m_per_s", "largest_vertical_m", *_ADDED)


def upgrade() -> None:
    op.add_column("results", sa.Column("batch_id", sa.Uuid(), nullable=True))
    for name in _ADDED:
        op.add_column("results", sa.Column(name, sa.Double(), nullable=True))
    jobs = sa.table("jobs", sa.column("id", sa.Uuid()), sa.column("batch_id", sa.Uuid()))
    results = sa.table("results", sa.column("job_id", sa.Uuid()), sa.column("batch_id", sa.Uuid()))
    of_job = sa.select(jobs.c.batch_id).where(jobs.c.id == results.c.job_id).scalar_subquery()
    op.execute(results.update().values(batch_id=of_job))
    for name in _RANKED:
        op.create_index(f"ix_results_batch_id_{name}_point", "results", ["batch_id", name, "point"])


def downgrade() -> None:
    for name in _RANKED:
        op.drop_index(f"ix_results_batch_id_{name}_point", "results")
    for name in ("batch_id", *_ADDED):
        op.drop_column("results", name)
