"""The tables: jobs with tags and events, batches of lines, and result rows. One schema for both databases."""

from app.tables.base import Base, FailureKind, JobEventKind, JobStatus, UtcDateTime
from app.tables.batches import Batch, BatchItem
from app.tables.jobs import Job, JobEvent, JobTag
from app.tables.results import (
    BifurcationRow,
    CriticalWindSpeedRow,
    FrequencyRow,
    LimitCycleRow,
    OrbitRow,
    PointRow,
)

__all__ = [
    "Base",
    "Batch",
    "BatchItem",
    "BifurcationRow",
    "CriticalWindSpeedRow",
    "FailureKind",
    "FrequencyRow",
    "Job",
    "JobEvent",
    "JobEventKind",
    "JobStatus",
    "JobTag",
    "LimitCycleRow",
    "OrbitRow",
    "PointRow",
    "UtcDateTime",
]
