"""How many bytes requests and results take, as quotas count them: texts and packed columns, and a number for each row.

Everything is computed from stored rows, so that no count drifts from what is there.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import orjson
from sqlalchemy import ColumnElement, LargeBinary, Text, cast, func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from app.tables import BatchItem, PointRow

ROW_BYTES = 2000
"""What a job, a batch or a point takes beside its texts and packed columns: other columns, events, index entries."""

_OF_LINE = (BatchItem.document, BatchItem.known, BatchItem.geometry, BatchItem.computed, BatchItem.faults)


def of_request(document: Mapping[str, Any]) -> int:
    """Return the bytes of a job, or of a batch without its lines, from its document."""
    return len(orjson.dumps(document)) + ROW_BYTES


def of_points(rows: Sequence[Mapping[str, Any]]) -> int:
    """Return the bytes of points from their columns, stored or to be stored."""
    return sum(ROW_BYTES + len(row["tables"] or b"") + len(row["orbits"] or b"") for row in rows)


def of_stored_points(*wanted: ColumnElement[bool]) -> Any:
    """Return the bytes of the points that meet conditions, as a subquery."""
    packed = (func.coalesce(func.length(column), 0) for column in (PointRow.tables, PointRow.orbits))
    return select(func.coalesce(func.sum(sum(packed, start=ROW_BYTES)), 0)).where(*wanted).scalar_subquery()


def of_lines(session: Session, *wanted: ColumnElement[bool]) -> Any:
    """Return the bytes of the lines of batches that meet conditions, as a subquery."""
    on_server = session.get_bind().dialect.name == "postgresql"
    texts = (func.coalesce(_octets(column, on_server), 0) for column in _OF_LINE)
    return select(func.coalesce(func.sum(sum(texts, start=0)), 0)).where(*wanted).scalar_subquery()


def _octets(column: InstrumentedAttribute[Any], on_server: bool) -> ColumnElement[int]:
    """Return the bytes of a JSON column's text; older SQLite has no function for that."""
    return func.octet_length(cast(column, Text)) if on_server else func.length(cast(column, LargeBinary))
