"""Results tell the static twist of the sections; it is unknown for what was computed without it.

Revision: 0005
"""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("results", sa.Column("twist_rad", sa.Double(), nullable=True))


def downgrade() -> None:
    op.drop_column("results", "twist_rad")
