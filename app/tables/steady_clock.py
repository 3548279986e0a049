"""The clock by which leases end."""

from datetime import datetime

from sqlalchemy import CheckConstraint
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class SteadyClock(Base):
    """The one row of the clock: its last reading by a sweeper, and how far it is ahead of the database's clock."""

    __tablename__ = "steady_clock"
    __table_args__ = (CheckConstraint("id = 1", name="one_row"),)

    id: Mapped[int] = mapped_column(primary_key=True)
    reading: Mapped[datetime]
    ahead_seconds: Mapped[float]
