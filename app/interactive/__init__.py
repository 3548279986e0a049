"""What a person waits for: previews of lines, and work in processes beside the queue, bounded and never stored."""

from app.interactive.busy import Busy
from app.interactive.previews import Previews, TakesTooLong
from app.interactive.workshop import Workshop

__all__ = ["Busy", "Previews", "TakesTooLong", "Workshop"]
