"""Results of a batch's lines are found by their input, and chunks tell how many lines were not computed again.

Results that were stored before are not found.

Revision: 0014
"""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("jobs", sa.Column("reused_lines", sa.Integer()))
    op.add_column("results", sa.Column("input_hash", sa.String(64)))
    op.create_index("ix_results_input_hash", "results", ["input_hash"])


def downgrade() -> None:
    op.drop_index("ix_results_input_hash")
    op.drop_column("results", "input_hash")
    op.drop_column("jobs", "reused_lines")
