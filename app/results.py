"""Result rows in SQL: stored with the end of a job, read as the flat rows of the contract."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from json import dumps
from typing import TYPE_CHECKING, Any, Literal, cast
from uuid import UUID

import psycopg
from psycopg.sql import SQL, Identifier
from sqlalchemy import JSON, ColumnElement, insert, select
from sqlalchemy import Table as SqlTable
from sqlalchemy.exc import DBAPIError, IntegrityError
from sqlalchemy.orm import Session

from app.tables import (
    Base,
    BifurcationRow,
    CriticalWindSpeedRow,
    FrequencyRow,
    LimitCycleRow,
    OrbitRow,
    PointRow,
)

if TYPE_CHECKING:
    from app.convert import PointResult

Table = Literal["frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations"]

_Fact = type[FrequencyRow | CriticalWindSpeedRow | LimitCycleRow | BifurcationRow]
_FACTS: Mapping[str, _Fact] = {
    "frequencies": FrequencyRow,
    "critical_wind_speeds": CriticalWindSpeedRow,
    "limit_cycles": LimitCycleRow,
    "bifurcations": BifurcationRow,
}
_ROW_TYPES: Mapping[str, _Fact | type[OrbitRow]] = {**_FACTS, "orbits": OrbitRow}
_PLACE = frozenset({"job_id", "point", "row_number"})
TABLES: tuple[Table, ...] = ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations")
STATIC = ("horizontal_tension_n", "catenary_parameter_m", "sag_m", "longitudinal_stiffness_n_per_m")
_ROWS_A_FETCH = 1000


def store(session: Session, job_id: UUID, points_found: Sequence["PointResult"]) -> None:
    """Add everything that was found at these points of a job, with one statement a table.

    Raises
    ------
    KeyError
        If a point has a table that there is not.
    ValueError
        If a row has a column that there is not, or lacks one.
    sqlalchemy.exc.SQLAlchemyError
        If a value is missing, or a point is stored already.
    """
    if not points_found:
        return
    _insert(session, PointRow, [{"job_id": job_id, **_point_columns(point)} for point in points_found])
    records: dict[str, list[dict[str, object]]] = {}
    for point in points_found:
        for name, rows_of_table in {**point.tables, "orbits": point.orbits}.items():
            _refuse_other_columns(name, rows_of_table)
            place: dict[str, object] = {"job_id": job_id, "point": point.point}
            numbered = ({**place, "row_number": number, **row} for number, row in enumerate(rows_of_table))
            records.setdefault(name, []).extend(numbered)
    for name, found in records.items():
        if found:
            _insert(session, _ROW_TYPES[name], found)


def row_type(table: Table) -> _Fact:
    """Return the class that stands for a table."""
    return _FACTS[table]


def columns(table: Table) -> list[str]:
    """Return the names of a table's columns in the order of the contract, without the study's axes."""
    return _columns(table)


def axes(session: Session, job_id: UUID) -> list[str]:
    """Return the parameters that the job's study varies, which are the first columns of every row; none without one."""
    found = session.execute(select(PointRow.axes).where(PointRow.job_id == job_id).limit(1)).scalar_one_or_none()
    return list(found or ())


def rows(session: Session, job_id: UUID, table: Table) -> Iterator[dict[str, object]]:
    """Stream the rows of one table in the order of the points; the values of the study's axes come first in each."""
    found = _ROW_TYPES[table]
    wanted: list[ColumnElement[Any]] = [found.__table__.columns[name] for name in columns(table)]
    statement = (
        select(PointRow.axes, *wanted)
        .join(found, (found.job_id == PointRow.job_id) & (found.point == PointRow.point))
        .where(PointRow.job_id == job_id)
        .order_by(found.point, found.row_number)
        .execution_options(yield_per=_ROWS_A_FETCH)
    )
    names = columns(table)
    for point_axes, *values in session.execute(statement):
        yield {**point_axes, **dict(zip(names, values, strict=True))}


def points(session: Session, job_id: UUID) -> Iterator[dict[str, object]]:
    """Stream the points: number, axes, static state, Den Hartog's coefficient, warnings, engine version, failure."""
    statement = select(PointRow).where(PointRow.job_id == job_id).order_by(PointRow.point)
    for row in session.scalars(statement.execution_options(yield_per=_ROWS_A_FETCH)):
        solved = row.horizontal_tension_n is not None
        hartog = {"coefficient": row.den_hartog_coefficient, "unstable": row.den_hartog_unstable}
        yield {
            "point": row.point,
            "axes": row.axes,
            "static": {name: getattr(row, name) for name in STATIC} if solved else None,
            "den_hartog": hartog if row.den_hartog_coefficient is not None else None,
            "warnings": row.warnings,
            "engine_version": row.engine_version,
            "failure": row.failure,
        }


def orbits(session: Session, job_id: UUID) -> Iterator[dict[str, object]]:
    """Stream the orbits: point, cycle (number of the row among the point's limit cycles), and Fourier coefficients."""
    statement = select(OrbitRow).where(OrbitRow.job_id == job_id).order_by(OrbitRow.point, OrbitRow.row_number)
    for row in session.scalars(statement.execution_options(yield_per=_ROWS_A_FETCH)):
        shapes = {"vertical": row.vertical, "horizontal": row.horizontal, "torsional": row.torsional}
        yield {"point": row.point, "cycle": row.cycle, **shapes}


def _insert(session: Session, kind: type[Base], records: Sequence[Mapping[str, object]]) -> None:
    """Insert many rows into the bare table: by COPY on PostgreSQL, at a third of the time of an INSERT."""
    table = cast(SqlTable, kind.__table__)
    if session.get_bind().dialect.name != "postgresql":
        session.execute(insert(table), records)
        return
    names = list(records[0])
    as_json = {column.name for column in table.columns if isinstance(column.type, JSON)}
    copied = SQL("COPY {} ({}) FROM STDIN").format(Identifier(table.name), SQL(", ").join(map(Identifier, names)))
    cursor: Any = session.connection().connection.cursor()
    with _as_sqlalchemy_errors(), cursor, cursor.copy(copied) as copy:
        for record in records:
            copy.write_row([dumps(record[name]) if name in as_json else record[name] for name in names])


@contextmanager
def _as_sqlalchemy_errors() -> Iterator[None]:
    """Let callers see one family of errors, whichever way the rows go."""
    try:
        yield
    except psycopg.IntegrityError as error:
        raise IntegrityError(None, None, error) from error
    except psycopg.Error as error:
        raise DBAPIError(None, None, error) from error


def _columns(table: str) -> list[str]:
    return [column.name for column in _ROW_TYPES[table].__table__.columns if column.name not in _PLACE]


def _refuse_other_columns(table: str, rows_of_table: Sequence[Mapping[str, object]]) -> None:
    """Compare names, since an insert of many rows drops what it does not know without a word."""
    known = set(_columns(table))
    for row in rows_of_table:
        if row.keys() != known:
            raise ValueError(f"{table} has other columns than a row that was found: {sorted(known ^ row.keys())}")


def _point_columns(point: "PointResult") -> dict[str, object]:
    return {
        "point": point.point,
        "axes": point.axes,
        **{name: point.static.get(name) for name in STATIC},
        "den_hartog_coefficient": point.den_hartog.get("coefficient"),
        "den_hartog_unstable": point.den_hartog.get("unstable"),
        "warnings": point.warnings,
        "engine_version": point.engine_version,
        "failure": point.failure,
    }
