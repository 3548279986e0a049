"""Read many rows in pages, so that whoever takes them slowly holds no connection of the database."""

from collections.abc import Iterator
from typing import Any

from sqlalchemy import Row, Select
from sqlalchemy.orm import InstrumentedAttribute, Session


class Removed(Exception):
    """Raised when rows were removed while they were read; what was read before is not all of them."""


def in_pages(
    session: Session,
    statement: Select[*tuple[Any, ...]],
    key: InstrumentedAttribute[int],
    size: int,
    belonging_to: Select[*tuple[Any, ...]],
) -> Iterator[Row[Any]]:
    """Yield the rows of a statement in the order of a key that it selects, each page by a query of its own.

    A session that only reads gives its connection back before the first row of a page is yielded.

    Parameters
    ----------
    session : Session
    statement : Select
        Without order and limit.
    key : InstrumentedAttribute
        Column of different whole numbers.
    size : int
        Rows of a page.
    belonging_to : Select
        Finds what the rows belong to, with which they are removed.

    Raises
    ------
    Removed
        If that is gone when the last page is read.
    """
    following, whole = statement.order_by(key).limit(size), True
    while True:
        page = session.execute(following).all()
        if len(page) < size and not (page and whole) and session.execute(belonging_to).first() is None:
            raise Removed("the rows were removed while they were read")
        _give_back(session)
        yield from page
        if len(page) < size:
            return
        last = getattr(page[-1], key.key)
        following, whole = statement.where(key > last).order_by(key).limit(size), False


def _give_back(session: Session) -> None:
    """End the transaction of a session that only reads, and so its use of a connection."""
    if session.get_bind().get_execution_options().get("read_only"):
        session.commit()
