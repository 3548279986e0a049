"""The event that a webhook tells: an end, or of a job its beginning, its results or its failure.

Revision: 0024
"""

import sqlalchemy as sa
from alembic import op

revision = "0024"
down_revision = "0023"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("webhook_deliveries") as table:
        table.add_column(sa.Column("event", sa.String(16), nullable=False, server_default="ended"))
    with op.batch_alter_table("webhook_deliveries") as table:
        table.alter_column("event", server_default=None)


def downgrade() -> None:
    # What earlier versions cannot send would be sent empty.
    op.execute("DELETE FROM webhook_deliveries WHERE event <> 'ended'")
    op.drop_column("webhook_deliveries", "event")
