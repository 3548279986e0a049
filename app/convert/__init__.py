"""The border to the engine: JSON documents in, plain rows out. Units change here and nowhere else."""

from app.convert.check import check, read, request_faults, with_further_faults
from app.convert.run import TABLES, Advance, PointResult, run
from engine import ENGINE_VERSION

__all__ = [
    "ENGINE_VERSION",
    "TABLES",
    "Advance",
    "PointResult",
    "check",
    "read",
    "request_faults",
    "run",
    "with_further_faults",
]
