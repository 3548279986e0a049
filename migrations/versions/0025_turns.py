"""An index of the waiting jobs of each owner, by which owners take turns.

Revision: 0025
"""

from alembic import op

revision = "0025"
down_revision = "0024"
branch_labels = None
depends_on = None

_NAME, _COLUMNS = "ix_jobs_status_owner_batch_id_created_at", ["status", "owner", "batch_id", "created_at"]


def upgrade() -> None:
    op.create_index(_NAME, "jobs", _COLUMNS)


def downgrade() -> None:
    op.drop_index(_NAME, "jobs")
