"""A clock for leases that does not go back, and the moment of a claim by it.

A job that runs through this revision has no such moment: if its worker is lost, its attempts are limited, but not its
time.

Revision: 0023
"""

from datetime import UTC, datetime

import sqlalchemy as sa
from alembic import op

from app.tables import UtcDateTime

revision = "0023"
down_revision = "0022"
branch_labels = None
depends_on = None


def upgrade() -> None:
    clock = op.create_table(
        "steady_clock",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("reading", UtcDateTime(), nullable=False),
        sa.Column("ahead_seconds", sa.Double(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_steady_clock"),
        sa.CheckConstraint("id = 1", name="one_row"),
    )
    op.bulk_insert(clock, [{"id": 1, "reading": datetime.now(UTC), "ahead_seconds": 0.0}])
    op.add_column("jobs", sa.Column("claimed_at", UtcDateTime()))


def downgrade() -> None:
    op.drop_column("jobs", "claimed_at")
    op.drop_table("steady_clock")
