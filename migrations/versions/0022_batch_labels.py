"""Name and tags of batches. Batches that were stored before have neither.

Revision: 0022
"""

import sqlalchemy as sa
from alembic import op

revision = "0022"
down_revision = "0021"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("batches", sa.Column("name", sa.Text()))
    op.add_column("batches", sa.Column("tags", sa.JSON(none_as_null=True)))


def downgrade() -> None:
    for name in ("name", "tags"):
        op.drop_column("batches", name)
