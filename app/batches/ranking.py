"""Rank the lines of a batch by one figure, a page at a time, along that figure's index."""

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from sqlalchemy import Row, and_, select, tuple_
from sqlalchemy.orm import Session

from app.http import paging
from app.storage.stored_results import RANKING_FIGURES
from app.tables import BatchItem, PointRow

_PLACE = struct.Struct(">dqq")


@dataclass(frozen=True, slots=True)
class Order:
    """The figure to rank by, one of `RANKING_FIGURES`, and whether the largest comes first."""

    figure: str
    descending: bool


@dataclass(frozen=True, slots=True)
class Place:
    """The end of a page: the figure, the number and the rank of its last line."""

    value: float
    number: int
    rank: int


def page(session: Session, batch_id: UUID, order: Order, after: Place | None, limit: int) -> Sequence[Row[Any]]:
    """Return number, reference, asset_id and `RANKING_FIGURES` of the lines after a place, in order.

    Lines without the figure are left out.
    """
    figure = getattr(PointRow, order.figure)
    key = tuple_(figure, PointRow.point)
    of_line = (
        BatchItem.batch_id == PointRow.batch_id,
        BatchItem.number == PointRow.point,
        BatchItem.chunk_id == PointRow.job_id,
    )
    statement = (
        select(
            BatchItem.number, BatchItem.reference, BatchItem.asset_id, *(getattr(PointRow, p) for p in RANKING_FIGURES)
        )
        .select_from(PointRow)
        .join(BatchItem, and_(*of_line))
        .where(PointRow.batch_id == batch_id, figure.is_not(None))
        .limit(limit)
    )
    if after is not None:
        last = tuple_(after.value, after.number)
        statement = statement.where(key < last if order.descending else key > last)
    ends = (figure.desc(), PointRow.point.desc()) if order.descending else (figure, PointRow.point)
    return session.execute(statement.order_by(*ends)).all()


def encode(key: bytes, batch_id: UUID, order: Order, place: Place) -> str:
    """Return the cursor of a place, valid for this batch and order only."""
    return paging.seal(_own(key, batch_id, order), _PLACE.pack(place.value, place.number, place.rank))


def decode(key: bytes, batch_id: UUID, order: Order, cursor: str) -> Place:
    """Return the place in a cursor.

    Raises
    ------
    app.http.paging.BadCursor
        If `encode` did not create it with this key, batch and order.
    """
    return Place(*_PLACE.unpack(paging.unseal(_own(key, batch_id, order), cursor)))


def _own(key: bytes, batch_id: UUID, order: Order) -> bytes:
    return b":".join((key, b"ranking", batch_id.bytes, order.figure.encode()))
