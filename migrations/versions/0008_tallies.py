"""Totals of what has happened, for the metrics; what ended before is counted in.

Revision: 0008
"""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None

_ENDED = """
INSERT INTO tallies (name, label, count, seconds)
SELECT CASE WHEN batch_id IS NULL THEN 'jobs' ELSE 'chunks' END,
       CASE WHEN failure_kind IS NULL THEN status ELSE status || '/' || failure_kind END, COUNT(*), 0.0
FROM jobs WHERE status NOT IN ('accepted', 'running') GROUP BY 1, 2
"""


def upgrade() -> None:
    identity = sa.BigInteger().with_variant(sa.Integer, "sqlite")
    op.create_table(
        "tallies",
        sa.Column("id", identity, autoincrement=True, nullable=False),
        sa.Column("name", sa.String(32), nullable=False),
        sa.Column("label", sa.String(64), nullable=False),
        sa.Column("count", sa.BigInteger(), nullable=False),
        sa.Column("seconds", sa.Double(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_tallies"),
    )
    op.execute(_ENDED)


def downgrade() -> None:
    op.drop_table("tallies")
