"""Expected hours of galloping a year of each result, indexed for rankings.

Results that were stored before have none: no line had a climate.

Revision: 0019
"""

import sqlalchemy as sa
from alembic import op

revision = "0019"
down_revision = "0018"
branch_labels = None
depends_on = None

_NAME = "galloping_hours_a_year"


def upgrade() -> None:
    op.add_column("results", sa.Column(_NAME, sa.Double(), nullable=True))
    op.create_index(f"ix_results_batch_id_{_NAME}_point", "results", ["batch_id", _NAME, "point"])


def downgrade() -> None:
    op.drop_index(f"ix_results_batch_id_{_NAME}_point", "results")
    op.drop_column("results", _NAME)
