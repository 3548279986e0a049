from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.coalescing.grouped_calls import committed_together
from app.jobs import idempotency, submissions, webhooks
from app.jobs.idempotency import Answer, KeyTaken, new_key
from app.jobs.job_records import Submission
from app.jobs.submissions import Keyed, Order
from app.jobs.webhooks import Subscription
from app.security.caller import LOCAL
from app.tables import AuditEvent, IdempotencyKey, Job, JobEvent
from tests.documents import STRANGER, history, short_request


def keyed(value: str, said: str = "f") -> Keyed:
    return Keyed(new_key(LOCAL.owner, value), said, lambda job: Answer(202, {}, str(job.id)))


def order(document: dict[str, Any] | None = None, **how: Any) -> Order:
    return Order(Submission(LOCAL, document or short_request()), **how)


def accepted(sessions: sessionmaker[Session], *orders: Order) -> list[Any]:
    return list(committed_together(sessions, submissions.accept, orders))


def count(sessions: sessionmaker[Session], table: type[Any]) -> int:
    with sessions() as session:
        return session.scalar(select(func.count()).select_from(table)) or 0


def test_of_equal_keys_in_a_group_the_first_gets_a_job(sessions: sessionmaker[Session]) -> None:
    asked = [keyed("k", "first"), keyed("other"), keyed("k", "second")]
    first, other, second = accepted(sessions, *(order(keyed=item) for item in asked))
    assert isinstance(first, Job) and isinstance(other, Job) and isinstance(second, KeyTaken)
    assert (count(sessions, Job), count(sessions, JobEvent), count(sessions, AuditEvent)) == (2, 2, 2)
    with sessions() as session:
        assert idempotency.find(session, asked[2].key) == ("first", Answer(202, {}, str(first.id)))


def test_a_key_that_is_in_use_costs_the_others_of_its_group_nothing(sessions: sessionmaker[Session]) -> None:
    (first,) = accepted(sessions, order(keyed=keyed("k")))
    with sessions() as session:
        kept = idempotency.find(session, new_key(LOCAL.owner, "k"))
    before, again, after = accepted(sessions, order(), order(keyed=keyed("k")), order(keyed=keyed("new")))
    assert isinstance(before, Job) and isinstance(again, KeyTaken) and isinstance(after, Job)
    assert count(sessions, Job) == 3
    assert count(sessions, IdempotencyKey) == 2
    with sessions() as session:
        assert idempotency.find(session, new_key(LOCAL.owner, "k")) == kept
        assert kept == ("f", Answer(202, {}, str(first.id)))


def test_a_document_that_cannot_be_kept_is_refused_alone(sessions: sessionmaker[Session]) -> None:
    hopeless = {"line": {"a": float("nan")}}
    first, refused, last = accepted(sessions, order(), order(hopeless, keyed=keyed("k")), order())
    assert isinstance(first, Job) and isinstance(refused, ValueError) and isinstance(last, Job)
    assert count(sessions, Job) == 2
    assert count(sessions, IdempotencyKey) == 0


def test_every_order_keeps_its_caller_and_whom_to_tell(sessions: sessionmaker[Session]) -> None:
    told = order(subscriptions=(Subscription("https://a.example/hook"),))
    mine, theirs = accepted(sessions, told, Order(Submission(STRANGER, short_request(), "n", "L1", {"a": "b"})))
    assert (mine.owner, theirs.owner) == (LOCAL.owner, STRANGER.owner)
    with sessions() as session:
        (delivery,) = webhooks.of(session, job_id=mine.id)
        assert (delivery.owner, delivery.url) == (LOCAL.owner, "https://a.example/hook")
        assert webhooks.of(session, job_id=theirs.id) == []
        stored = session.get_one(Job, theirs.id)
        assert (stored.name, stored.asset_id, stored.tags[0].value) == ("n", "L1", "b")
        recorded = {row.subject: row.owner for row in session.execute(select(AuditEvent.subject, AuditEvent.owner))}
    assert recorded == {mine.id: LOCAL.owner, theirs.id: STRANGER.owner}
    assert history(sessions, theirs.id) == [("accepted", 0)]
