"""Revision 0004 on rows of revision 0003, up and down."""

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any
from uuid import UUID, uuid4

import pytest
from alembic import command
from sqlalchemy import Connection, Engine, MetaData, select, text

from app import convert
from app.runtime.settings import Settings
from app.storage import stored_results
from app.storage.database import make_engine, session_factory
from app.storage.migration import alembic_config, migrate
from app.tables import PointRow

MODEL = {"model": "hybrid", "loops": 1}
CYCLE = {
    **MODEL,
    "wind_speed_m_per_s": 4.0,
    "branch": None,
    "kind": "equilibrium",
    "stability": "unstable",
    "frequency_hz": None,
    "second_frequency_hz": None,
    "observed_at_m": 62.94,
    **dict.fromkeys(("vertical_m", "horizontal_m", "torsional_rad"), 0.0),
    **dict.fromkeys(("vertical_min_m", "horizontal_min_m", "torsional_min_rad")),
    **dict.fromkeys(("vertical_ratio", "horizontal_ratio", "reduced_wind_speed"), 0.1),
    "outcome": "converged",
}
CROSSING = {"crossing": "onset", "type": "oscillation", "direction": "vertical", "unstable_pairs_after": 1}
TABLES: dict[str, list[dict[str, Any]]] = {
    "frequencies": [
        {**MODEL, "vertical_hz": 0.1 + 0.2, "horizontal_hz": None, "torsional_hz": 2.0, "outcome": "converged"}
    ],
    "critical_wind_speeds": [
        {**MODEL, "wind_speed_m_per_s": wind, **CROSSING, "frequency_hz": 0.48} for wind in (7.5, 2.403, 9.0)
    ],
    "limit_cycles": [CYCLE, {**CYCLE, "kind": "periodic", "branch": 0, "vertical_m": 1.25}],
    "bifurcations": [],
    "orbits": [{"cycle": 1, "vertical": [0.0, 1e-300, -1.5], "horizontal": [1.0], "torsional": [2.0]}],
}


@pytest.fixture
def engine(settings: Settings) -> Iterator[Engine]:
    made = make_engine(settings)
    yield made
    made.dispose()


def before(connection: Connection) -> MetaData:
    """Bring the database to 0003 and return its tables."""
    command.upgrade(alembic_config(connection), "0003")
    found = MetaData()
    found.reflect(connection)
    return found


def fill(connection: Connection, tables: MetaData, job_id: UUID) -> None:
    """Store a job with one point that has rows and one that failed."""
    key = job_id.hex if connection.dialect.name == "sqlite" else job_id
    state = {"status": "successful", "progress": 1.0, "step": "", "attempt": 1, "cancel_requested": False}
    job = {
        "id": key,
        "created_at": datetime(2026, 1, 1, tzinfo=UTC),
        "owner": "local",
        **state,
        "document": {"line": {}},
        "input_hash": "0" * 64,
    }
    connection.execute(tables.tables["jobs"].insert(), job)
    common: dict[str, Any] = {"job_id": key, "axes": {}, "warnings": ["w"], "engine_version": "0.1.0"}
    points = [{**common, "point": 0, "failure": None}, {**common, "point": 1, "failure": "It overflowed."}]
    connection.execute(tables.tables["results"].insert(), points)
    for name, rows in TABLES.items():
        for number, row in enumerate(rows):
            place = {"job_id": key, "point": 0, "row_number": number}
            connection.execute(tables.tables[name].insert(), {**place, **row})


def rows(connection: Connection, tables: MetaData) -> dict[str, list[tuple[Any, ...]]]:
    """Return everything in the tables of the results."""
    names = [*TABLES, "results"]
    return {
        name: [tuple(row) for row in connection.execute(select(table).order_by(*table.primary_key.columns))]
        for name, table in ((name, tables.tables[name]) for name in names)
    }


def test_rows_are_the_same_after_packing_and_unpacking(settings: Settings, engine: Engine) -> None:
    job_id = uuid4()
    with engine.begin() as connection:
        tables = before(connection)
        fill(connection, tables, job_id)
        there = rows(connection, tables)
    migrate(settings)
    with session_factory(engine)() as session:
        for name in convert.TABLES:
            assert list(stored_results.rows(session, job_id, name)) == TABLES.get(name, [])
        assert list(stored_results.orbits(session, job_id)) == [{"point": 0, **TABLES["orbits"][0]}]
        assert [point["failure"] for point in stored_results.points(session, job_id)] == [None, "It overflowed."]
        found = session.execute(select(*(getattr(PointRow, name) for name in stored_results.RANKING_FIGURES))).all()
    assert sorted(map(tuple, found), key=str) == [(2.403, 1.25, None, None, None), (None,) * 5]
    with engine.begin() as connection:
        command.downgrade(alembic_config(connection), "0003")
        again = MetaData()
        again.reflect(connection)
        assert rows(connection, again) == there


def test_many_points_are_taken_page_by_page(settings: Settings, engine: Engine) -> None:
    with engine.begin() as connection:
        tables = before(connection)
        for _ in range(110):
            fill(connection, tables, uuid4())
    migrate(settings)
    with engine.begin() as connection:
        table = PointRow.__table__
        packed = connection.execute(select(table.c.failure, table.c.tables)).all()
    assert len(packed) == 220
    assert all((found is None) == (failure is not None) for failure, found in packed)


def test_postgres_stores_what_is_packed_as_it_is(settings: Settings, engine: Engine) -> None:
    migrate(settings)
    if engine.dialect.name == "postgresql":
        assert storage(engine) == {"tables": "e", "orbits": "e"}
        with engine.begin() as connection:
            command.downgrade(alembic_config(connection), "0014")
        assert storage(engine) == {"tables": "x", "orbits": "x"}


def storage(engine: Engine) -> dict[str, str]:
    """Return how the packed columns are stored: e as they are, x compressed if that helps."""
    statement = """
        SELECT attname, attstorage::text AS attstorage FROM pg_attribute
        WHERE attrelid = 'results'::regclass AND attname IN ('tables', 'orbits')
    """
    with engine.connect() as connection:
        return {row.attname: row.attstorage for row in connection.execute(text(statement))}
