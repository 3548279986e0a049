"""Coordinates of a batch's lines as GeoJSON, and what was computed from them.

Lines that were stored before have neither.

Revision: 0021
"""

import sqlalchemy as sa
from alembic import op

revision = "0021"
down_revision = "0020"
branch_labels = None
depends_on = None

_NAMES = ("geometry", "computed")


def upgrade() -> None:
    for name in _NAMES:
        op.add_column("batch_items", sa.Column(name, sa.JSON(none_as_null=True)))


def downgrade() -> None:
    for name in _NAMES:
        op.drop_column("batch_items", name)
