"""What an owner keeps: conductors and aerodynamic tables."""

from datetime import datetime
from typing import Any
from uuid import UUID

from sqlalchemy import Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base


class OwnConductor(Base):
    """A bare conductor of an owner; `key` is its name without case and spaces, `figures` holds the row."""

    __tablename__ = "own_conductors"
    __table_args__ = (Index(None, "owner", "key", unique=True),)

    id: Mapped[UUID] = mapped_column(primary_key=True)
    created_at: Mapped[datetime]
    owner: Mapped[str] = mapped_column(String(64))
    key: Mapped[str] = mapped_column(String(200))
    name: Mapped[str] = mapped_column(Text)
    figures: Mapped[dict[str, Any]]


class OwnAerodynamics(Base):
    """A table of measured coefficients of an owner; `key` is its name without case and spaces, `document` the table."""

    __tablename__ = "own_aerodynamics"
    __table_args__ = (Index(None, "owner", "key", unique=True),)

    id: Mapped[UUID] = mapped_column(primary_key=True)
    created_at: Mapped[datetime]
    owner: Mapped[str] = mapped_column(String(64))
    key: Mapped[str] = mapped_column(String(200))
    name: Mapped[str] = mapped_column(Text)
    document: Mapped[dict[str, Any]]
