"""Batches and their lines; a chunk of a batch is a job that counts its lines.

Revision: 0002
"""

import sqlalchemy as sa
from alembic import op

from app.tables import UtcDateTime

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    # Columns are added in place: SQLite would make the table anew for a constraint, and dropping it empties others.
    op.add_column("jobs", sa.Column("lines", sa.Integer()))
    op.add_column("jobs", sa.Column("failed_lines", sa.Integer()))
    _create_batches()
    _create_batch_items()


def downgrade() -> None:
    op.execute("DELETE FROM jobs WHERE lines IS NOT NULL")
    op.drop_table("batch_items")
    op.drop_table("batches")
    op.drop_column("jobs", "failed_lines")
    op.drop_column("jobs", "lines")


def _create_batches() -> None:
    op.create_table(
        "batches",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("created_at", UtcDateTime(), nullable=False),
        sa.Column("received_at", UtcDateTime()),
        sa.Column("analysis", sa.JSON(), nullable=False),
        sa.Column("rejected_lines", sa.Integer(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_batches"),
    )
    op.create_index("ix_batches_created_at_id", "batches", ["created_at", "id"])


def _create_batch_items() -> None:
    op.create_table(
        "batch_items",
        sa.Column("batch_id", sa.Uuid(), nullable=False),
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("chunk_id", sa.Uuid()),
        sa.Column("reference", sa.Text()),
        sa.Column("asset_id", sa.Text()),
        sa.Column("document", sa.JSON()),
        sa.Column("faults", sa.JSON()),
        sa.CheckConstraint("(faults IS NULL) = (chunk_id IS NOT NULL)", name="faults_or_chunk"),
        sa.CheckConstraint("(faults IS NULL) = (document IS NOT NULL)", name="faults_or_document"),
        sa.PrimaryKeyConstraint("batch_id", "number", name="pk_batch_items"),
        sa.ForeignKeyConstraint(["batch_id"], ["batches.id"], name="fk_batch_items_batches", ondelete="CASCADE"),
    )
    op.create_index("ix_batch_items_chunk_id", "batch_items", ["chunk_id"])
