"""Results as one row a point: the rows of five tables become JSON packed by Zstandard, with two peaks as columns.

Revision: 0004
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import orjson
import sqlalchemy as sa
import zstandard
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

_POINTS_A_STEP = 200
_MODEL = (sa.Column("model", sa.String(), nullable=False), sa.Column("loops", sa.Integer(), nullable=False))
_FACTS = ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations")
_SHAPES = ("vertical", "horizontal", "torsional")


def upgrade() -> None:
    for name, kind in _columns().items():
        op.add_column("results", sa.Column(name, kind))
    for place in _places():
        _pack(place)
    for name in (*_FACTS, "orbits"):
        op.drop_table(name)


def downgrade() -> None:
    _create_tables()
    for place in _places():
        _unpack(place)
    for name in _columns():
        op.drop_column("results", name)


def _columns() -> dict[str, sa.types.TypeEngine[Any]]:
    peaks: dict[str, sa.types.TypeEngine[Any]] = dict.fromkeys(
        ("lowest_critical_wind_speed_m_per_s", "largest_vertical_m"), sa.Double()
    )
    return {**peaks, **dict.fromkeys(("tables", "orbits"), sa.LargeBinary())}


def _results() -> sa.TableClause:
    packed = [sa.column(name, kind) for name, kind in _columns().items()]
    return sa.table(
        "results", sa.column("job_id", sa.Uuid()), sa.column("point", sa.Integer()), sa.column("failure"), *packed
    )


def _places() -> Iterator[Sequence[sa.Row[Any, Any, Any]]]:
    """Yield the keys of all points, some at a time."""
    table = _results()
    key = sa.tuple_(table.c.job_id, table.c.point)
    statement = sa.select(table.c.job_id, table.c.point, table.c.failure).order_by(table.c.job_id, table.c.point)
    page = op.get_bind().execute(statement.limit(_POINTS_A_STEP)).all()
    while page:
        yield page
        following = statement.where(key > sa.tuple_(sa.literal(page[-1].job_id, sa.Uuid()), page[-1].point))
        page = op.get_bind().execute(following.limit(_POINTS_A_STEP)).all()


def _pack(places: Iterable[sa.Row[Any, Any, Any]]) -> None:
    table = _results()
    for place in places:
        if place.failure is not None:
            continue
        found = {name: _rows_of(name, place) for name in _FACTS}
        winds = (row["wind_speed_m_per_s"] for row in found["critical_wind_speeds"])
        amplitudes = (row["vertical_m"] for row in found["limit_cycles"] if row["vertical_m"] is not None)
        values = {
            "lowest_critical_wind_speed_m_per_s": min(winds, default=None),
            "largest_vertical_m": max(amplitudes, default=None),
            "tables": zstandard.compress(orjson.dumps(found)),
            "orbits": zstandard.compress(orjson.dumps(_rows_of("orbits", place))),
        }
        here = table.c.job_id == place.job_id, table.c.point == place.point
        op.get_bind().execute(table.update().where(*here).values(values))


def _unpack(places: Iterable[sa.Row[Any, Any, Any]]) -> None:
    table = _results()
    for place in places:
        here = table.c.job_id == place.job_id, table.c.point == place.point
        packed, orbits = op.get_bind().execute(sa.select(table.c.tables, table.c.orbits).where(*here)).one()
        if packed is None:
            continue
        found = {**orjson.loads(zstandard.decompress(packed)), "orbits": orjson.loads(zstandard.decompress(orbits))}
        for name in (*_FACTS, "orbits"):
            _insert(name, place, found[name])


def _rows_of(name: str, place: sa.Row[Any, Any, Any]) -> list[dict[str, Any]]:
    table = _table(name)
    here = table.c.job_id == place.job_id, table.c.point == place.point
    wanted = [table.c[column.name] for column in _LAYOUTS[name]]
    found = op.get_bind().execute(sa.select(*wanted).where(*here).order_by(table.c.row_number))
    names = [str(column.name) for column in _LAYOUTS[name]]  # SQLAlchemy's own kind of text is no key of JSON
    return [dict(zip(names, row, strict=True)) for row in found]


def _insert(name: str, place: sa.Row[Any, Any, Any], rows: Sequence[dict[str, Any]]) -> None:
    names = [column.name for column in _LAYOUTS[name]]
    key = {"job_id": place.job_id, "point": place.point}
    records = [{**key, "row_number": i, **{n: row.get(n) for n in names}} for i, row in enumerate(rows)]
    if records:
        op.get_bind().execute(_table(name).insert(), records)


def _table(name: str) -> sa.TableClause:
    key = sa.column("job_id", sa.Uuid()), sa.column("point", sa.Integer()), sa.column("row_number", sa.Integer())
    return sa.table(name, *key, *(sa.column(column.name, column.type) for column in _LAYOUTS[name]))


def _create_tables() -> None:
    for name in (*_FACTS, "orbits"):
        op.create_table(
            name,
            sa.Column("job_id", sa.Uuid(), nullable=False),
            sa.Column("point", sa.Integer(), autoincrement=False, nullable=False),
            sa.Column("row_number", sa.Integer(), autoincrement=False, nullable=False),
            *(column._copy() for column in _LAYOUTS[name]),
            sa.PrimaryKeyConstraint("job_id", "point", "row_number", name=f"pk_{name}"),
            sa.ForeignKeyConstraint(
                ["job_id", "point"],
                ["results.job_id", "results.point"],
                name=f"fk_{name}_results",
                ondelete="CASCADE",
            ),
        )


def _word(name: str) -> sa.Column[str]:
    return sa.Column(name, sa.String(), nullable=False)


def _whole(name: str, *, nullable: bool = False) -> sa.Column[int]:
    return sa.Column(name, sa.Integer(), nullable=nullable)


def _numbers(*names: str, nullable: bool = True) -> tuple[sa.Column[float], ...]:
    return tuple(sa.Column(name, sa.Double(), nullable=nullable) for name in names)


_LAYOUTS: dict[str, tuple[sa.Column[Any], ...]] = {
    "frequencies": (*_MODEL, *_numbers("vertical_hz", "horizontal_hz", "torsional_hz"), _word("outcome")),
    "critical_wind_speeds": (
        *_MODEL,
        *_numbers("wind_speed_m_per_s", nullable=False),
        *map(_word, ("crossing", "type", "direction")),
        *_numbers("frequency_hz", nullable=False),
        _whole("unstable_pairs_after"),
    ),
    "limit_cycles": (
        *_MODEL,
        *_numbers("wind_speed_m_per_s", nullable=False),
        _whole("branch", nullable=True),
        *map(_word, ("kind", "stability")),
        *_numbers("frequency_hz", "second_frequency_hz"),
        *_numbers("observed_at_m", nullable=False),
        *_numbers("vertical_m", "horizontal_m", "torsional_rad"),
        *_numbers("vertical_min_m", "horizontal_min_m", "torsional_min_rad"),
        *_numbers("vertical_ratio", "horizontal_ratio", "reduced_wind_speed"),
        _word("outcome"),
    ),
    "bifurcations": (
        *_MODEL,
        _whole("branch"),
        _word("type"),
        *_numbers("wind_speed_m_per_s", "frequency_hz", nullable=False),
        *_numbers("second_frequency_hz"),
        *_numbers("uncertainty_m_per_s", nullable=False),
    ),
    "orbits": (_whole("cycle"), *(sa.Column(name, sa.JSON(), nullable=False) for name in _SHAPES)),
}
