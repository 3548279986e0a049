"""Revision 26 counts what was stored before it, as it is counted since."""

from alembic import command
from sqlalchemy import Engine, inspect, select
from sqlalchemy.orm import Session, sessionmaker

from app.jobs.owner_quotas import standing
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.storage.database import make_engine
from app.storage.migration import alembic_config
from app.tables import Batch, Job, JobStatus
from tests.batch_rows import add_batch, run
from tests.documents import add_job, short_request


def sizes(engine: Engine) -> dict[str, list[tuple[object, ...]]]:
    with Session(engine) as session:
        ended = select(Job.id, Job.request_bytes, Job.result_bytes).where(Job.status == JobStatus.SUCCESSFUL)
        waiting = select(Job.id, Job.request_bytes).where(Job.status == JobStatus.ACCEPTED)
        kinds = {"ended": ended, "waiting": waiting, "batches": select(Batch.id, Batch.request_bytes)}
        return {name: sorted(map(tuple, session.execute(wanted))) for name, wanted in kinds.items()}


def test_rows_of_before_count_as_those_of_after(settings: Settings, sessions: sessionmaker[Session]) -> None:
    add_job(sessions, short_request())
    _, chunks = add_batch(sessions, 3, 2)
    run(sessions, chunks[0], failing=frozenset({2}))
    engine = make_engine(settings)
    before = sizes(engine)
    assert len(before["ended"]) == 1 and len(before["waiting"]) == 2
    with engine.begin() as connection:
        command.downgrade(alembic_config(connection), "0025")
        assert "request_bytes" not in {column["name"] for column in inspect(connection).get_columns("jobs")}
    with engine.begin() as connection:
        command.upgrade(alembic_config(connection), "head")
    assert sizes(engine) == before
    with sessions() as session:
        assert standing(session, LOCAL.owner).expected == 0, "what waits counts from its end on"
    engine.dispose()
