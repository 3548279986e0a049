"""Jobs and batches belong to an owner; what there is already belongs to the caller of a service without keys.

Revision: 0003
"""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

_TABLES = ("jobs", "batches")


def upgrade() -> None:
    for table in _TABLES:
        # SQLite adds a column in place, without emptying the tables that refer to this one, only if it has a default.
        op.add_column(table, sa.Column("owner", sa.String(64), nullable=False, server_default="local"))
        if op.get_bind().dialect.name == "postgresql":
            op.alter_column(table, "owner", server_default=None)
        op.drop_index(f"ix_{table}_created_at_id")
        op.create_index(f"ix_{table}_owner_created_at_id", table, ["owner", "created_at", "id"])
    op.drop_index("ix_jobs_asset_id_created_at")
    op.create_index("ix_jobs_owner_asset_id_created_at", "jobs", ["owner", "asset_id", "created_at"])


def downgrade() -> None:
    op.drop_index("ix_jobs_owner_asset_id_created_at")
    op.create_index("ix_jobs_asset_id_created_at", "jobs", ["asset_id", "created_at"])
    for table in _TABLES:
        op.drop_index(f"ix_{table}_owner_created_at_id")
        op.create_index(f"ix_{table}_created_at_id", table, ["created_at", "id"])
        op.drop_column(table, "owner")
