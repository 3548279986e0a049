"""What was said of a batch's lines in engineers' forms, so that their results can say what is assumed.

Lines that were stored before keep the explicit form only.

Revision: 0020
"""

import sqlalchemy as sa
from alembic import op

revision = "0020"
down_revision = "0019"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("batch_items", sa.Column("known", sa.JSON(none_as_null=True)))


def downgrade() -> None:
    op.drop_column("batch_items", "known")
