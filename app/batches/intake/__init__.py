"""Batches as they come in: bodies taken apart as a stream, lines checked one by one and stored block by block."""

from app.batches.intake.body_formats import BodyTooLarge, Incoming, gunzipped, read_csv, read_json, read_ndjson
from app.batches.intake.receive import Receipt, lines_a_chunk, receive

__all__ = [
    "BodyTooLarge",
    "Incoming",
    "Receipt",
    "gunzipped",
    "lines_a_chunk",
    "read_csv",
    "read_json",
    "read_ndjson",
    "receive",
]
