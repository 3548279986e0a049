"""How the body of a batch was read, in sentences.

Revision: 0017
"""

import sqlalchemy as sa
from alembic import op

revision = "0017"
down_revision = "0016"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("batches", sa.Column("notes", sa.JSON(none_as_null=True)))


def downgrade() -> None:
    op.drop_column("batches", "notes")
