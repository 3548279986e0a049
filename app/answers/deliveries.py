"""The log of webhooks."""

from datetime import datetime
from typing import Literal

from app.schemas.fields import Answer, example_of, told


class DeliveryAttempt(Answer):
    """One attempt to send a message."""

    at: datetime = told("When", "2026-11-22T10:00:05+00:00")
    status_code: int | None = told("Status of the receiver's answer; null without one [1]", 500)
    error: str | None = told("Why there was no answer", "no answer within 10 s")


class Delivery(Answer):
    """One message to one receiver."""

    id: str = told("Its `webhook-id`", "msg_0199a3c45b7e7c1a9d2e3f4a5b6c7d8e")
    url: str = told("Where it goes", "https://assets.example.com/galloping")
    state: Literal["waiting", "pending", "delivered", "failed"] = told("waiting for the end of its subject", "pending")
    created_at: datetime = told("When it was asked for", "2026-11-22T10:00:00+00:00")
    next_attempt_at: datetime | None = told("When it is sent next; null if it is not", "2026-11-22T10:00:10+00:00")
    attempts: list[DeliveryAttempt] = told("What came of it so far", [example_of(DeliveryAttempt)])


class DeliveryLog(Answer):
    """The messages about a job or a batch."""

    deliveries: list[Delivery] = told("The messages", [example_of(Delivery)])


class WebhookSecret(Answer):
    """What signs an owner's webhooks."""

    secret: str = told("Secret of Standard Webhooks", "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD")
