"""The SQL tables: jobs, batches, results, keys, audit, workers, clock and more. One schema for both databases."""

from app.tables.access import ApiKey, AuditAction, AuditEvent, EndedSession
from app.tables.base import ENDED, Base, FailureKind, JobEventKind, JobStatus, UtcDateTime
from app.tables.batches import Batch, BatchItem
from app.tables.counter_increments import CounterIncrement
from app.tables.idempotency import IdempotencyKey
from app.tables.jobs import Job, JobEvent, JobTag
from app.tables.owned import OwnAerodynamics, OwnConductor
from app.tables.results import PointRow
from app.tables.steady_clock import SteadyClock
from app.tables.webhooks import DeliveryEvent, DeliveryState, WebhookDelivery
from app.tables.workers import Worker

__all__ = [
    "ENDED",
    "ApiKey",
    "AuditAction",
    "AuditEvent",
    "Base",
    "Batch",
    "BatchItem",
    "CounterIncrement",
    "DeliveryEvent",
    "DeliveryState",
    "EndedSession",
    "FailureKind",
    "IdempotencyKey",
    "Job",
    "JobEvent",
    "JobEventKind",
    "JobStatus",
    "JobTag",
    "OwnAerodynamics",
    "OwnConductor",
    "PointRow",
    "SteadyClock",
    "UtcDateTime",
    "WebhookDelivery",
    "Worker",
]
