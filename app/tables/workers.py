"""Running workers."""

from datetime import datetime

from sqlalchemy import String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class Worker(Base):
    """A worker under the name in its leases, with the time of its last report."""

    __tablename__ = "workers"

    name: Mapped[str] = mapped_column(Text, primary_key=True)
    started_at: Mapped[datetime]
    seen_at: Mapped[datetime]
    processes: Mapped[int]
    version: Mapped[str] = mapped_column(String(64))
