"""The verdict of each result in a column of its own, so that summaries need not unpack the tables.

Results that were stored before have it in their tables only.

Revision: 0018
"""

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("results", sa.Column("verdict", sa.JSON(none_as_null=True)))


def downgrade() -> None:
    op.drop_column("results", "verdict")
