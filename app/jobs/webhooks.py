"""Webhooks: signed messages (Standard Webhooks) when jobs and batches end, and their log. The caller commits."""

import base64
import hashlib
import hmac
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum
from typing import Any
from uuid import UUID

import httpx
from sqlalchemy import and_, or_, select
from sqlalchemy.orm import Session
from standardwebhooks import Webhook
from uuid_utils.compat import uuid7

from app.jobs import batch_progress
from app.runtime.settings import Settings
from app.runtime.signing import signing_key
from app.storage import counters
from app.storage.counters import CounterName
from app.storage.database import database_time
from app.storage.steady_clock import steady_time
from app.tables import ENDED, Batch, DeliveryEvent, DeliveryState, Job, JobStatus, WebhookDelivery

_ROWS_A_QUERY = 200
_GROWTH = 5.0
_GONE = 410
GIVEN_UP = "given_up"
_NEVER_SENT = {DeliveryState.WAITING.value, DeliveryState.NOT_NEEDED.value}


class Outcome(StrEnum):
    """The outcome of an attempt: the receiver accepts, refuses, or does not answer."""

    DELIVERED = "delivered"
    REFUSED = "refused"
    NO_ANSWER = "no_answer"


@dataclass(frozen=True, slots=True)
class Attempt:
    """One attempt to send a message: the status of the answer, or why there is none."""

    status_code: int | None
    error: str | None = None

    @property
    def arrived(self) -> bool:
        """Tell whether the receiver accepted the message."""
        return self.outcome is Outcome.DELIVERED

    @property
    def outcome(self) -> "Outcome":
        """Return the outcome of the attempt."""
        if self.status_code is None:
            return Outcome.NO_ANSWER
        return Outcome.DELIVERED if 200 <= self.status_code < 300 else Outcome.REFUSED


@dataclass(frozen=True, slots=True)
class Subscription:
    """An address and the event that it is told."""

    url: str
    event: DeliveryEvent = DeliveryEvent.ENDED


@dataclass(frozen=True, slots=True)
class Message:
    """A message to send, and its receiver; without a payload, the sender composes it from its job and event."""

    id: UUID
    owner: str
    url: str
    receiver: str
    payload: str | None
    attempt: int
    event: DeliveryEvent = DeliveryEvent.ENDED
    job_id: UUID | None = None


class Share:
    """Counts messages in progress, in total, by owner and by receiver, and limits them."""

    def __init__(self, most: int, an_owner: int, a_receiver: int) -> None:
        """Take the limits."""
        self._most, self._an_owner, self._a_receiver = most, an_owner, a_receiver
        self._owners: Counter[str] = Counter()
        self._receivers: Counter[str] = Counter()

    @property
    def room(self) -> int:
        """Return how many more messages may be in progress."""
        return self._most - self._owners.total()

    def full(self) -> tuple[list[str], list[str]]:
        """Return the owners and the receivers that have reached their limit."""
        owners = [owner for owner, count in self._owners.items() if count >= self._an_owner]
        return owners, [receiver for receiver, count in self._receivers.items() if count >= self._a_receiver]

    def add(self, owner: str, receiver: str) -> bool:
        """Count a message and return True, or return False if its owner or its receiver has reached the limit."""
        if self._owners[owner] >= self._an_owner or self._receivers[receiver] >= self._a_receiver:
            return False
        self._owners[owner] += 1
        self._receivers[receiver] += 1
        return True

    def copy(self) -> "Share":
        """Return a copy with the same counts."""
        other = Share(self._most, self._an_owner, self._a_receiver)
        other._owners.update(self._owners)
        other._receivers.update(self._receivers)
        return other

    def remove(self, owner: str, receiver: str) -> None:
        """Stop counting a message."""
        self._owners[owner] -= 1
        self._receivers[receiver] -= 1


def secret(settings: Settings, owner: str) -> str:
    """Return the secret of an owner's webhooks, derived from the operator's `signing_secret`.

    Raises
    ------
    OSError
        If the operator's secret can be neither read nor written.
    """
    key = hmac.digest(signing_key(settings), b"webhooks\0" + owner.encode(), hashlib.sha256)
    return "whsec_" + base64.b64encode(key).decode()


def signed_headers(settings: Settings, message: Message, payload: str, moment: datetime) -> dict[str, str]:
    """Return the headers by which a receiver verifies a message and its sender."""
    name = f"msg_{message.id.hex}"
    return {
        "Content-Type": "application/json",
        "User-Agent": "galloping-webhooks",
        "webhook-id": name,
        "webhook-timestamp": str(int(moment.timestamp())),
        "webhook-signature": Webhook(secret(settings, message.owner)).sign(name, moment, payload),
    }


def register(
    session: Session, owner: str, wanted: Subscription, *, job_id: UUID | None = None, batch_id: UUID | None = None
) -> None:
    """Store a webhook to send when its event comes to a job, or when a batch ends."""
    place = httpx.URL(wanted.url)
    session.add(
        WebhookDelivery(
            id=uuid7(),
            owner=owner,
            job_id=job_id,
            batch_id=batch_id,
            event=wanted.event.value,
            url=wanted.url,
            receiver=f"{place.host}:{place.port or 443}",
            created_at=database_time(session),
            state=DeliveryState.WAITING.value,
            attempts=0,
            log=[],
        )
    )


def of(session: Session, *, job_id: UUID | None = None, batch_id: UUID | None = None) -> list[WebhookDelivery]:
    """Return the deliveries of a job or a batch."""
    which = WebhookDelivery.job_id == job_id if job_id is not None else WebhookDelivery.batch_id == batch_id
    return list(session.scalars(select(WebhookDelivery).where(which).order_by(WebhookDelivery.id)))


def send_again(session: Session, deliveries: Sequence[WebhookDelivery]) -> None:
    """Queue messages that were due for another round of attempts; keep their log."""
    for delivery in deliveries:
        if delivery.state not in _NEVER_SENT:
            delivery.state, delivery.attempts = DeliveryState.PENDING.value, 0
            delivery.next_attempt_at = steady_time(session)


def enlist(session: Session, root_path: str = "") -> int:
    """Queue the messages whose events have come, with links under a prefix; return how many are decided."""
    waiting = select(WebhookDelivery).where(WebhookDelivery.state == DeliveryState.WAITING.value)
    started = and_(WebhookDelivery.event == DeliveryEvent.STARTED.value, Job.status != JobStatus.ACCEPTED)
    has_come = or_(Job.status.in_(ENDED), started)
    due = waiting.join(Job, Job.id == WebhookDelivery.job_id).where(has_come).limit(_ROWS_A_QUERY)
    found = list(session.scalars(due.with_for_update(of=WebhookDelivery, skip_locked=True)))
    for delivery in found:
        job = session.get_one(Job, delivery.job_id)
        if delivery.event == DeliveryEvent.ENDED.value:
            _write(session, delivery, "job", _of_job(job, root_path))
        elif _never_comes(DeliveryEvent(delivery.event), job):
            delivery.state = DeliveryState.NOT_NEEDED.value
        else:
            _queue(session, delivery)
    received = waiting.join(Batch, Batch.id == WebhookDelivery.batch_id).where(Batch.received_at.is_not(None))
    for delivery in session.scalars(received.with_for_update(of=WebhookDelivery, skip_locked=True)).all():
        assert delivery.batch_id is not None
        counts = batch_progress.counts(session, [delivery.batch_id])[delivery.batch_id]
        if counts.status in ENDED:
            lines = {"successful": counts.successful, "failed": counts.failed, "dismissed": counts.dismissed}
            href = f"{root_path}/v1/batches/{delivery.batch_id}"
            data = {"id": str(delivery.batch_id), "status": counts.status.value, "lines": lines, "href": href}
            _write(session, delivery, "batch", data)
            found.append(delivery)
    return len(found)


def take_due(session: Session, share: Share, lease_seconds: float) -> list[Message]:
    """Take due messages, oldest first, within the limits that `share` sets together with those in progress.

    When the lease ends, other processes take the messages whose outcome was not recorded.
    """
    now, taken, count = steady_time(session), [], share.copy()
    while count.room > 0 and (found := _oldest_due(session, now, count)):
        for delivery in found:
            if count.add(delivery.owner, delivery.receiver):
                taken.append(delivery)
                delivery.attempts += 1
                delivery.next_attempt_at = now + timedelta(seconds=lease_seconds)
    return [
        Message(d.id, d.owner, d.url, d.receiver, d.payload, d.attempts, DeliveryEvent(d.event), d.job_id)
        for d in taken
    ]


def _oldest_due(session: Session, now: datetime, share: Share) -> Sequence[WebhookDelivery]:
    """Return the oldest due messages, skipping owners and receivers that have reached their limit."""
    owners, receivers = share.full()
    due = WebhookDelivery.state == DeliveryState.PENDING.value, WebhookDelivery.next_attempt_at <= now
    free = WebhookDelivery.owner.not_in(owners), WebhookDelivery.receiver.not_in(receivers)
    oldest = select(WebhookDelivery).where(*due, *free).order_by(WebhookDelivery.next_attempt_at).limit(share.room)
    return session.scalars(oldest.with_for_update(skip_locked=True)).all()


def note(session: Session, settings: Settings, message: Message, attempt: Attempt) -> None:
    """Log an attempt, count it, and schedule the next one if there is one."""
    counters.add(session, CounterName.WEBHOOKS, attempt.outcome.value)
    delivery = session.get(WebhookDelivery, message.id, with_for_update=True)
    if delivery is None:  # removed with its job
        return
    now = database_time(session)
    entry = {"at": now.isoformat(), "status_code": attempt.status_code, "error": attempt.error}
    delivery.log = [*delivery.log, entry]
    if attempt.arrived:
        delivery.state = DeliveryState.DELIVERED.value
    elif attempt.status_code == _GONE or message.attempt >= settings.webhook_attempts:
        delivery.state = DeliveryState.FAILED.value
        counters.add(session, CounterName.WEBHOOKS, GIVEN_UP)
    else:
        pause = settings.webhook_retry_seconds * _GROWTH ** (message.attempt - 1)
        delivery.next_attempt_at = steady_time(session) + timedelta(seconds=pause)


def _write(session: Session, delivery: WebhookDelivery, kind: str, data: dict[str, Any]) -> None:
    message = {"type": f"{kind}.{data['status']}", "timestamp": database_time(session).isoformat(), "data": data}
    delivery.payload = json.dumps(message, separators=(",", ":"))
    _queue(session, delivery)


def _never_comes(event: DeliveryEvent, job: Job) -> bool:
    if job.status not in ENDED:
        return False
    if event is DeliveryEvent.STARTED:
        return job.started_at is None
    return (event is DeliveryEvent.SUCCEEDED) != (job.status is JobStatus.SUCCESSFUL)


def _queue(session: Session, delivery: WebhookDelivery) -> None:
    delivery.state, delivery.next_attempt_at = DeliveryState.PENDING.value, steady_time(session)


def _of_job(job: Job, root_path: str) -> dict[str, Any]:
    failure = {"kind": job.failure_kind.value, "detail": job.failure_detail} if job.failure_kind else None
    labels = {"name": job.name, "asset_id": job.asset_id}
    href = f"{root_path}/v1/jobs/{job.id}"
    return {"id": str(job.id), "status": job.status.value, **labels, "failure": failure, "href": href}
