"""An index of the waiting jobs of each owner, by which owners take turns.

Revision: 0025
"""

import sqlalchemy as sa
from alembic import op

revision = "0025"
down_revision = "0024"
branch_labels = None
depends_on = None

_NAME, _COLUMNS = "ix_jobs_waiting", ["status", "owner", "batch_id", "created_at"]
_WAITS = sa.text("status = 'accepted'")


def upgrade() -> None:
    op.create_index(_NAME, "jobs", _COLUMNS, postgresql_where=_WAITS, sqlite_where=_WAITS)


def downgrade() -> None:
    op.drop_index(_NAME, "jobs")
