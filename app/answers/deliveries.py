"""The log of webhooks."""

from datetime import datetime
from typing import Literal

from app.schemas.fields import Answer, described, example_of


class DeliveryAttempt(Answer):
    """One attempt to send a message."""

    at: datetime = described("Time of the attempt", "2026-11-22T10:00:05+00:00")
    status_code: int | None = described("Status of the receiver's answer; null without one [1]", 500)
    error: str | None = described("Why there was no answer", "no answer within 10 s")


class Delivery(Answer):
    """One message to one receiver."""

    id: str = described("Its `webhook-id`", "msg_0199a3c45b7e7c1a9d2e3f4a5b6c7d8e")
    url: str = described("Address of the receiver", "https://assets.example.com/galloping")
    event: Literal["ended", "started", "succeeded", "failed"] = described("What it tells of the job or batch", "ended")
    state: Literal["waiting", "pending", "delivered", "failed", "not_needed"] = described(
        "State; waiting until its event comes, not_needed if the job ended otherwise", "pending"
    )
    created_at: datetime = described("When the job or batch was submitted", "2026-11-22T10:00:00+00:00")
    next_attempt_at: datetime | None = described(
        "Time of the next attempt; null if there is none", "2026-11-22T10:00:10+00:00"
    )
    attempts: list[DeliveryAttempt] = described("Attempts so far", [example_of(DeliveryAttempt)])


class DeliveryLog(Answer):
    """The messages about a job or a batch."""

    deliveries: list[Delivery] = described("The messages", [example_of(Delivery)])


class WebhookSecret(Answer):
    """The secret that signs an owner's webhooks."""

    secret: str = described("Secret in the format of Standard Webhooks", "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD")
