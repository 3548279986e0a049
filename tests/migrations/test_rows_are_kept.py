"""Every revision, down and up, on a database with rows of all kinds: what both sides have a column for stays.

The first revision is left out: it knows no batches, and the way down to it removes their chunks.
"""

from collections.abc import Iterator
from typing import Any
from uuid import uuid4

import pytest
from alembic import command
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, MetaData, select
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import idempotency, leases, webhooks
from app.jobs.idempotency import Answer, Kept, new_key
from app.jobs.leases import Failure
from app.jobs.webhooks import Subscription
from app.operation import workers
from app.owned import records
from app.reference import conductors
from app.runtime.settings import Settings
from app.security import keys
from app.security import sessions as browser_sessions
from app.security.caller import LOCAL, Scope
from app.storage import counters
from app.storage.database import make_engine
from app.storage.migration import alembic_config
from app.tables import Base, FailureKind
from tests.batch_rows import add_batch, claim, run
from tests.documents import add_job, create_job, point_result

Rows = dict[str, list[dict[str, Any]]]


@pytest.fixture
def engine(settings: Settings, sessions: sessionmaker[Session]) -> Iterator[Engine]:
    """Give a migrated database with rows in every table."""
    fill(sessions, settings)
    made = make_engine(settings)
    yield made
    made.dispose()


def fill(sessions: sessionmaker[Session], settings: Settings) -> None:
    _waiting, running, ended, failed = (add_job(sessions) for _ in range(4))
    with sessions.begin() as session:
        held = [leases.claim(session, job_id, "here", 60.0) for job_id in (running, ended, failed)]
        assert held[1] is not None and held[2] is not None
        points = [point_result(0), point_result(1, failure="It overflowed.")]
        assert leases.finish(session, held[1], points)
        assert leases.fail(session, held[2], Failure(FailureKind.TIME_LIMIT, "too long"))
        tagged = create_job(session, LOCAL, {"line": {}}, name="n", asset_id="a", tags={"b": "c"})
        webhooks.register(session, LOCAL.owner, Subscription("https://a.example/hook"), job_id=tagged.id)
        keys.create(session, "acme", tuple(Scope), "SCADA", None)
        browser_sessions.end(session, uuid4())
        idempotency.keep(session, [Kept(new_key("acme", "k"), "f", Answer(202, {"a": "b"}, "{}"))])
        workers.report(session, settings, "here")
        records.put_conductors(session, LOCAL.owner, conductors.named("Drake"))
        records.put_aerodynamics(session, LOCAL.owner, "crescent", {"coefficients": [0.0]})
    batch_id, (first, second, _open) = add_batch(sessions, 2, 2, 1, rejected=1)
    run(sessions, first)
    run(sessions, second, failing=frozenset({3}))
    claim(sessions, _open)
    with sessions.begin() as session:
        webhooks.register(session, LOCAL.owner, Subscription("https://a.example/hook"), batch_id=batch_id)
        counters.fold(session)


def rows(connection: Connection) -> Rows:
    found = MetaData()
    found.reflect(connection)
    tables = {name: table for name, table in found.tables.items() if name != "alembic_version"}
    return {
        name: sorted((dict(row) for row in connection.execute(select(table)).mappings()), key=repr)
        for name, table in tables.items()
    }


def in_common(one: Rows, other: Rows) -> tuple[Rows, Rows]:
    """Return the rows of the tables that both have, with the columns that both have."""
    kept: tuple[Rows, Rows] = ({}, {})
    for name in one.keys() & other.keys():
        if one[name] and other[name]:
            columns = one[name][0].keys() & other[name][0].keys()
            for side, rows_of in zip(kept, (one[name], other[name]), strict=True):
                side[name] = sorted(({c: row[c] for c in sorted(columns)} for row in rows_of), key=repr)
        else:
            kept[0][name], kept[1][name] = one[name], other[name]
    return kept


def test_every_table_has_rows(engine: Engine) -> None:
    with engine.connect() as connection:
        found = rows(connection)
    assert found.keys() == Base.metadata.tables.keys()
    assert [name for name, rows_of in found.items() if not rows_of] == []


def test_no_revision_loses_rows(engine: Engine) -> None:
    with engine.connect() as connection:
        config = alembic_config(connection)
        newest = before = rows(connection)
    head, *down = [script.revision for script in ScriptDirectory.from_config(config).walk_revisions()][:-1]
    ways = [(command.downgrade, revision) for revision in down]
    ways += [(command.upgrade, revision) for revision in (*down[-2::-1], head)]
    for move, revision in ways:
        with engine.begin() as connection:
            move(alembic_config(connection), revision)
            after = rows(connection)
        kept, left = in_common(before, after)
        assert left == kept, f"{move.__name__} to {revision}"
        before = after
    for name in ("jobs", "job_tags", "job_events", "batches", "batch_items", "results"):
        assert len(before[name]) == len(newest[name]) > 0
