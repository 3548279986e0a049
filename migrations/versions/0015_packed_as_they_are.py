"""PostgreSQL does not try to compress what is compressed already.

Revision: 0015
"""

from alembic import op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None

_PACKED = ("tables", "orbits")


def upgrade() -> None:
    _store("EXTERNAL")


def downgrade() -> None:
    _store("EXTENDED")


def _store(way: str) -> None:
    """Change how values are stored from now on; those that are there stay as they are and are read as before."""
    if op.get_bind().dialect.name == "postgresql":
        changes = ", ".join(f"ALTER COLUMN {name} SET STORAGE {way}" for name in _PACKED)
        op.execute(f"ALTER TABLE results {changes}")
