"""Jobs that were answered with the results of another say so, and what can be reused is found by its input.

Revision: 0012
"""

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("jobs", sa.Column("reused_from", sa.Uuid()))
    op.create_index("ix_jobs_owner_input_hash", "jobs", ["owner", "input_hash"])


def downgrade() -> None:
    op.drop_index("ix_jobs_owner_input_hash")
    op.drop_column("jobs", "reused_from")
