"""Jobs keep the id and the trace of the request that made them.

Revision: 0006
"""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

_COLUMNS = {"request_id": 128, "trace_parent": 55}


def upgrade() -> None:
    for name, length in _COLUMNS.items():
        op.add_column("jobs", sa.Column(name, sa.String(length)))


def downgrade() -> None:
    for name in _COLUMNS:
        op.drop_column("jobs", name)
