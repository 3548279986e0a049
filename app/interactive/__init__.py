"""Results at once, for a person who moves a slider: computed beside the queue, bounded, and never stored."""

from app.interactive.previews import Busy, Previews, TakesTooLong

__all__ = ["Busy", "Previews", "TakesTooLong"]
