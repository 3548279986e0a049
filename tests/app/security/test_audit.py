from datetime import timedelta
from uuid import uuid4

from sqlalchemy.orm import Session, sessionmaker

from app.security import audit
from app.security.caller import Caller
from app.storage.database import database_time
from app.tables import AuditAction

ACME, OTHER = Caller("acme", frozenset(), uuid4()), Caller("other", frozenset())


def test_the_newest_events_come_first_and_may_be_of_one_owner_or_since_a_moment(
    sessions: sessionmaker[Session],
) -> None:
    job = uuid4()
    with sessions.begin() as session:
        now = database_time(session)
        audit.record(session, OTHER, AuditAction.KEY_CREATED, detail="first", at=now - timedelta(hours=2))
    with sessions.begin() as session:
        audit.record(session, ACME, AuditAction.JOB_SUBMITTED, job, at=now - timedelta(hours=1))
    with sessions.begin() as session:
        audit.record(session, ACME, AuditAction.JOB_REMOVED, job)
    with sessions() as session:
        events = audit.latest(session, None, None, 10)
        assert [(e.owner, e.key_id, e.action, e.subject, e.detail) for e in events] == [
            ("acme", ACME.key_id, AuditAction.JOB_REMOVED, job, None),
            ("acme", ACME.key_id, AuditAction.JOB_SUBMITTED, job, None),
            ("other", None, AuditAction.KEY_CREATED, None, "first"),
        ]
        assert abs(events[0].at - now) < timedelta(seconds=60)
        assert [event.id for event in audit.latest(session, None, None, 1)] == [events[0].id]
        assert [event.id for event in audit.latest(session, "other", None, 10)] == [events[2].id]
        since = now - timedelta(minutes=90)
        assert [event.id for event in audit.latest(session, None, since, 10)] == [event.id for event in events[:2]]


def test_the_record_is_exported_in_order_between_two_moments(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        now = database_time(session)
    for hours, caller in ((3, ACME), (2, OTHER), (1, ACME)):
        with sessions.begin() as session:
            audit.record(session, caller, AuditAction.SIGNED_IN, detail=str(hours), at=now - timedelta(hours=hours))

    def told(owner: str | None, since: int | None, until: int | None) -> list[str | None]:
        span = [None if hours is None else now - timedelta(hours=hours) for hours in (since, until)]
        with sessions() as session:
            return [event.detail for event in audit.between(session, owner, *span)]

    assert told(None, None, None) == ["3", "2", "1"]
    assert told(None, 2, None) == ["2", "1"]
    assert told(None, 3, 1) == ["3", "2"]
    assert told("acme", None, None) == ["3", "1"]
