"""Remedies against galloping: from their document to the engine, their faults, and their comparison."""

from app.convert.remedies.comparison import compared, remedies, remedies_faults

__all__ = ["compared", "remedies", "remedies_faults"]
