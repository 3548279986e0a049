"""Results in SQL: one row for each point, stored when its job ends and unpacked into the rows of the result tables."""

import math
import threading
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any
from uuid import UUID

import orjson
import zstandard
from sqlalchemy import Row, Select, select
from sqlalchemy.orm import Session

from app.convert import TABLES, StaticState, columns_of
from app.storage.database import insert_rows
from app.storage.pages import in_pages
from app.tables import Job, PointRow

if TYPE_CHECKING:
    from app.convert import PointResult

STATIC = tuple(columns_of(StaticState))
RANKING_FIGURES = (
    "lowest_critical_wind_speed_m_per_s",
    "largest_vertical_m",
    "largest_height_m",
    "largest_width_m",
    "galloping_hours_a_year",
)
UNKNOWN_MOTIONS = "unknown_motions"
VERDICT = tuple(columns_of(TABLES["verdict"].row))
NO_TABLES = orjson.dumps({name: [] for name in TABLES})
_POINTS_A_FETCH = 100
_THREAD = threading.local()
_LEVEL = 1  # higher levels take longer and do not shrink rows of numbers


class CorruptResult(Exception):
    """Raised when a stored result is not what was stored."""


def rows_of(points_found: Sequence["PointResult"]) -> list[dict[str, Any]]:
    """Return points as the rows that `store` inserts."""
    compressor = _packer()
    return [_as_columns(point, compressor) for point in points_found]


def store(session: Session, job_id: UUID, rows: Sequence[dict[str, Any]], batch_id: UUID | None = None) -> None:
    """Insert the rows of points of a job, or of lines of a batch's chunk, in one statement.

    Raises
    ------
    sqlalchemy.exc.SQLAlchemyError
        If a point is stored already.
    """
    insert_rows(session, PointRow, [{"job_id": job_id, "batch_id": batch_id, **row} for row in rows])


def ranking_columns(row: Any) -> dict[str, float | bool | None]:
    """Return the ranking figures of a stored point as they are shown, where infinite ones are unknown."""
    figures = {name: getattr(row, name) for name in RANKING_FIGURES}
    unknown = any(value is not None and math.isinf(value) for value in figures.values())
    shown = {name: None if value is not None and math.isinf(value) else value for name, value in figures.items()}
    return {**shown, UNKNOWN_MOTIONS: unknown}


def packed(text: bytes) -> bytes:
    """Return a text as it is stored: compressed, with a checksum."""
    return _packer().compress(text)


def _packer() -> zstandard.ZstdCompressor:
    return zstandard.ZstdCompressor(level=_LEVEL, write_checksum=True)


def unpacked(packed: bytes | None) -> bytes:
    """Return the JSON text of a packed column; for a point that failed, that of tables without rows.

    Raises
    ------
    CorruptResult
        If it is not what was stored, as its checksum tells.
    """
    if packed is None:
        return NO_TABLES
    try:
        return _unpacker().decompress(packed)
    except zstandard.ZstdError as error:
        raise CorruptResult(str(error)) from error


def _unpacker() -> zstandard.ZstdDecompressor:
    """Return this thread's decompressor; creating one costs as much as decompressing a text."""
    if not hasattr(_THREAD, "unpacker"):
        _THREAD.unpacker = zstandard.ZstdDecompressor()
    unpacker: zstandard.ZstdDecompressor = _THREAD.unpacker
    return unpacker


def tables_of(packed: bytes | None) -> dict[str, list[dict[str, Any]]]:
    """Return the rows in a packed column by table name."""
    found: dict[str, list[dict[str, Any]]] = orjson.loads(unpacked(packed))
    return found


def rows(session: Session, job_id: UUID, table: str) -> Iterator[dict[str, Any]]:
    """Stream the rows of one table in the order of the points; each row begins with the values of the study's axes."""
    for found in _pages(session, job_id, select(PointRow.point, PointRow.axes, PointRow.tables)):
        for row in tables_of(found.tables).get(table, ()):
            yield {**found.axes, **row}


def _pages(session: Session, job_id: UUID, columns: Select[*tuple[Any, ...]]) -> Iterator[Row[Any]]:
    of_job, job = columns.where(PointRow.job_id == job_id), select(Job.id).where(Job.id == job_id)
    return in_pages(session, of_job, PointRow.point, _POINTS_A_FETCH, job)


def tables_of_point(session: Session, job_id: UUID, point: int) -> dict[str, list[dict[str, Any]]] | None:
    """Return the rows of all tables of one point, None if the job has no such point."""
    statement = select(PointRow.tables).where(PointRow.job_id == job_id, PointRow.point == point)
    found = session.execute(statement).one_or_none()
    return None if found is None else tables_of(found.tables)


def points(session: Session, job_id: UUID) -> Iterator[dict[str, Any]]:
    """Stream the points: number, axes, static state, Den Hartog coefficient, warnings, engine version, failure."""
    static = [getattr(PointRow, name) for name in STATIC]
    hartog = PointRow.den_hartog_coefficient, PointRow.den_hartog_unstable
    outcome = PointRow.warnings, PointRow.engine_version, PointRow.failure
    for row in _pages(session, job_id, select(PointRow.point, PointRow.axes, *static, *hartog, *outcome)):
        solved = row.horizontal_tension_n is not None
        found = {"coefficient": row.den_hartog_coefficient, "unstable": row.den_hartog_unstable}
        yield {
            "point": row.point,
            "axes": row.axes,
            "static": {name: getattr(row, name) for name in STATIC} if solved else None,
            "den_hartog": found if row.den_hartog_coefficient is not None else None,
            "warnings": row.warnings,
            "engine_version": row.engine_version,
            "failure": row.failure,
        }


def orbits(session: Session, job_id: UUID) -> Iterator[dict[str, Any]]:
    """Stream the orbits: point, cycle (row number among the point's limit cycles), and Fourier coefficients."""
    columns = select(PointRow.point, PointRow.orbits).where(PointRow.orbits.is_not(None))
    for found in _pages(session, job_id, columns):
        for orbit in orjson.loads(unpacked(found.orbits)):
            yield {"point": found.point, **orbit}


def _as_columns(point: "PointResult", compressor: zstandard.ZstdCompressor) -> dict[str, Any]:
    failed = point.failure is not None
    return {
        "point": point.point,
        "axes": point.axes,
        **{name: point.static.get(name) for name in STATIC},
        "den_hartog_coefficient": point.den_hartog.get("coefficient"),
        "den_hartog_unstable": point.den_hartog.get("unstable"),
        "warnings": point.warnings,
        "engine_version": point.engine_version,
        "failure": point.failure,
        **{name: point.ranking_figures.get(name) for name in RANKING_FIGURES},
        "tables": None if failed else compressor.compress(point.tables_json),
        "orbits": None if failed else compressor.compress(point.orbits_json),
        "input_hash": point.input_hash,
        "verdict": point.verdict,
    }
