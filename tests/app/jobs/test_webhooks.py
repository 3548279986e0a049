"""Which messages are taken to be sent; `tests/worker/test_courier.py` sends them."""

from collections import Counter
from datetime import timedelta

import pytest
from sqlalchemy import update
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import webhooks
from app.jobs.webhooks import Message, Share, Subscription
from app.runtime.settings import Settings
from app.storage import steady_clock
from app.storage.database import database_time
from app.tables import DeliveryState, WebhookDelivery
from tests.documents import add_job
from tests.servers import wait_until
from worker.sweep import ClockKeeper


def add_due(sessions: sessionmaker[Session], owner: str, host: str, count: int) -> None:
    """Add messages that are due, later ones after earlier ones."""
    job_id = add_job(sessions)
    with sessions.begin() as session:
        for _ in range(count):
            webhooks.register(session, owner, Subscription(f"https://{host}/hook"), job_id=job_id)
        session.flush()
        now, waiting = database_time(session), WebhookDelivery.state == DeliveryState.WAITING.value
        due = {"state": DeliveryState.PENDING.value, "payload": "{}", "next_attempt_at": now}
        session.execute(update(WebhookDelivery).where(waiting).values(due))


def taken(sessions: sessionmaker[Session], share: Share) -> list[Message]:
    with sessions.begin() as session:
        return webhooks.take_due(session, share, 60.0)


def test_no_owner_and_no_receiver_has_more_than_a_share(sessions: sessionmaker[Session]) -> None:
    for number in range(20):
        add_due(sessions, "greedy", f"a{number}.example", 5)
    add_due(sessions, "modest", "b.example", 3)
    found = taken(sessions, Share(10, 6, 2))
    assert Counter(message.owner for message in found) == {"greedy": 6, "modest": 2}
    assert max(Counter(message.receiver for message in found).values()) == 2


def test_what_is_under_way_counts(sessions: sessionmaker[Session]) -> None:
    add_due(sessions, "greedy", "a.example", 9)
    add_due(sessions, "modest", "b.example", 1)
    share = Share(5, 3, 3)
    for _ in range(2):
        assert share.add("greedy", "other.example:443")
    assert Counter(message.owner for message in taken(sessions, share)) == {"greedy": 1, "modest": 1}
    assert share.room == 3  # whoever sends counts, once the lease is committed
    for _ in range(2):
        share.remove("greedy", "other.example:443")
    assert len(taken(sessions, share)) == 3


def test_a_message_is_taken_again_after_the_lease_only(sessions: sessionmaker[Session]) -> None:
    add_due(sessions, "a", "a.example", 1)
    share = Share(5, 5, 5)
    (first,) = taken(sessions, share)
    assert taken(sessions, share) == []
    with sessions.begin() as session:
        over = WebhookDelivery.next_attempt_at <= database_time(session) + timedelta(seconds=61)
        session.execute(update(WebhookDelivery).where(over).values(next_attempt_at=database_time(session)))
    (second,) = taken(sessions, share)
    assert (second.id, second.attempt) == (first.id, 2)


def test_a_message_is_due_though_the_clock_was_set_back(
    sessions: sessionmaker[Session], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    ClockKeeper(sessions, settings).look()
    add_due(sessions, "a", "a.example", 1)
    monkeypatch.setattr(steady_clock, "database_time", lambda session: database_time(session) - timedelta(hours=1))
    ClockKeeper(sessions, settings).look()
    wait_until(lambda: taken(sessions, Share(5, 5, 5)), 10.0, "the message")
