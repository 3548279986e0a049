"""What jobs and batches take on disk, for quotas, with an index that sums it by owner.

Results of jobs that wait or run while this is applied count from their end on.

Revision: 0026
"""

import sqlalchemy as sa
from alembic import op

revision = "0026"
down_revision = "0025"
branch_labels = None
depends_on = None

_ROW_BYTES = 2000
_INDEX, _INDEXED = "ix_jobs_owner_request_bytes_result_bytes", ["owner", "request_bytes", "result_bytes"]
_COLUMNS = (("jobs", "request_bytes"), ("jobs", "result_bytes"), ("batches", "request_bytes"))
_OF_LINE = ("document", "known", "geometry", "computed", "faults")


def upgrade() -> None:
    for table, name in _COLUMNS:
        op.add_column(table, sa.Column(name, sa.BigInteger(), nullable=False, server_default="0"))
    op.execute(f"UPDATE jobs SET request_bytes = {_ROW_BYTES} + {_octets('document')}, result_bytes = ({_of_points()})")
    op.execute(f"UPDATE batches SET request_bytes = {_ROW_BYTES} + {_octets('analysis')} + ({_of_lines()})")
    op.create_index(_INDEX, "jobs", _INDEXED)


def downgrade() -> None:
    op.drop_index(_INDEX, "jobs")
    for table, name in _COLUMNS:
        op.drop_column(table, name)


def _octets(column: str) -> str:
    """Return the SQL for the bytes of a JSON column's text."""
    on_server = op.get_bind().dialect.name == "postgresql"
    return f"octet_length(CAST({column} AS TEXT))" if on_server else f"length(CAST({column} AS BLOB))"


def _of_points() -> str:
    packed = " + ".join(f"coalesce(length({column}), 0)" for column in ("tables", "orbits"))
    return f"SELECT coalesce(sum({_ROW_BYTES} + {packed}), 0) FROM results WHERE results.job_id = jobs.id"


def _of_lines() -> str:
    texts = " + ".join(f"coalesce({_octets(f'batch_items.{column}')}, 0)" for column in _OF_LINE)
    return f"SELECT coalesce(sum({texts}), 0) FROM batch_items WHERE batch_items.batch_id = batches.id"
