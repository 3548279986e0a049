from collections.abc import Callable
from typing import Any
from uuid import UUID

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.jobs.watched_states import batches_seen, jobs_seen
from app.security.caller import LOCAL, Owned
from app.tables import JobEventKind, JobStatus
from tests.batch_rows import add_batch
from tests.documents import STRANGER, add_job
from tests.statements import counted


def test_events_come_with_the_state_and_are_read_again_only_after_a_change(sessions: sessionmaker[Session]) -> None:
    key = Owned(LOCAL.owner, add_job(sessions))
    first = jobs_seen(sessions, {key: None})
    with counted() as statements:
        assert jobs_seen(sessions, first) == first
    assert len(statements) == 1
    with sessions.begin() as session:
        leases.claim(session, key.id, "here", 60.0)
    second = jobs_seen(sessions, first)
    assert second[key].status is JobStatus.RUNNING
    assert [event.kind for event in second[key].events] == [JobEventKind.ACCEPTED, JobEventKind.RUNNING]


def _batch(sessions: sessionmaker[Session]) -> UUID:
    return add_batch(sessions, 1)[0]


@pytest.mark.parametrize(("seen", "make", "table"), [(jobs_seen, add_job, "jobs"), (batches_seen, _batch, "batches")])
def test_watching_names_the_owner_in_the_query(
    sessions: sessionmaker[Session], seen: Callable[..., Any], make: Callable[..., UUID], table: str
) -> None:
    subject = make(sessions)
    mine, theirs = Owned(LOCAL.owner, subject), Owned(STRANGER.owner, subject)
    with counted() as statements:
        assert set(seen(sessions, {mine: None, theirs: None})) == {mine}
        assert seen(sessions, {theirs: None}) == {}
    assert sum(f"({table}.owner, {table}.id) IN" in text for text in statements) == 2
