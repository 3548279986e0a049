"""What an owner keeps by name, in SQL: put rows in place of those with the same name, list and remove them."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any, TypeVar
from uuid import UUID

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session
from uuid_utils.compat import uuid7

from app.convert import OwnRows
from app.reference.catalogue_row import CatalogueRow, name_key
from app.reference.text_forms import written_forms
from app.storage.database import database_time
from app.tables import OwnAerodynamics, OwnConductor

Kept = TypeVar("Kept", OwnConductor, OwnAerodynamics)

MOST_KEPT = 5000
"""Most rows of one kind that an owner may keep."""


class TooMany(ValueError):
    """Raised when an owner would keep more than `MOST_KEPT` rows of one kind."""


def put_conductors(session: Session, owner: str, rows: Sequence[CatalogueRow]) -> list[OwnConductor]:
    """Store conductors in place of the owner's rows with the same names.

    Raises
    ------
    TooMany
        If the owner would keep too many.
    """
    figures = {row.name: asdict(row) for row in rows}
    return _put(session, OwnConductor, owner, {name: {"figures": found} for name, found in figures.items()})


def put_aerodynamics(session: Session, owner: str, name: str, document: Mapping[str, Any]) -> OwnAerodynamics:
    """Store a table of coefficients in place of the owner's table with the same name.

    Raises
    ------
    TooMany
        If the owner would keep too many.
    """
    (row,) = _put(session, OwnAerodynamics, owner, {name: {"document": dict(document)}})
    return row


def _put(session: Session, table: type[Kept], owner: str, contents: Mapping[str, Mapping[str, Any]]) -> list[Kept]:
    keys = [name_key(name) for name in contents]
    stored = frozenset().union(*map(written_forms, keys))
    session.execute(delete(table).where(table.owner == owner, table.key.in_(stored)))
    kept = session.scalar(select(func.count(table.id)).where(table.owner == owner)) or 0
    if kept + len(keys) > MOST_KEPT:
        raise TooMany(f"an owner keeps at most {MOST_KEPT} of them, and has {kept} beside these")
    now = database_time(session)
    rows = [
        table(id=uuid7(), created_at=now, owner=owner, key=key, name=name, **content)
        for key, (name, content) in zip(keys, contents.items(), strict=True)
    ]
    session.add_all(rows)
    session.flush()
    return rows


def kept(session: Session, table: type[Kept], owner: str) -> Sequence[Kept]:
    """Return what an owner keeps of one kind, by name."""
    return session.scalars(select(table).where(table.owner == owner).order_by(table.key)).all()


def remove(session: Session, table: type[Kept], owner: str, row_id: UUID) -> bool:
    """Remove a row of an owner, and tell whether there was one."""
    found = session.scalars(delete(table).where(table.owner == owner, table.id == row_id).returning(table.id)).first()
    return found is not None


def conductor_rows(session: Session, owner: str) -> list[CatalogueRow]:
    """Return the owner's conductors as rows of the catalogue."""
    return [catalogue_row(row) for row in kept(session, OwnConductor, owner)]


def own_rows(session: Session, owner: str) -> OwnRows:
    """Return what lines of an owner may name."""
    tables = {row.name: row.document for row in kept(session, OwnAerodynamics, owner)}
    return OwnRows(conductor_rows(session, owner), tables)


def catalogue_row(row: OwnConductor) -> CatalogueRow:
    """Return a stored conductor as a row of the catalogue."""
    return CatalogueRow(**row.figures)
