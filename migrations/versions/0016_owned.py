"""Conductors and aerodynamic tables that an owner keeps.

Revision: 0016
"""

import sqlalchemy as sa
from alembic import op

from app.tables import UtcDateTime

revision = "0016"
down_revision = "0015"
branch_labels = None
depends_on = None

_CONTENTS = {"own_conductors": "figures", "own_aerodynamics": "document"}


def upgrade() -> None:
    for table, content in _CONTENTS.items():
        op.create_table(
            table,
            sa.Column("id", sa.Uuid(), nullable=False),
            sa.Column("created_at", UtcDateTime(), nullable=False),
            sa.Column("owner", sa.String(64), nullable=False),
            sa.Column("key", sa.String(200), nullable=False),
            sa.Column("name", sa.Text(), nullable=False),
            sa.Column(content, sa.JSON(none_as_null=True), nullable=False),
            sa.PrimaryKeyConstraint("id", name=f"pk_{table}"),
        )
        op.create_index(f"ix_{table}_owner_key", table, ["owner", "key"], unique=True)


def downgrade() -> None:
    for table in _CONTENTS:
        op.drop_table(table)
