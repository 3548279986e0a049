"""Receive batches: read bodies as streams, check lines one by one, and store them in blocks."""

from app.batches.intake.body_formats import (
    Incoming,
    gunzipped,
    read_csv,
    read_geojson,
    read_json,
    read_ndjson,
    read_rdf_xml,
    read_xlsx,
)
from app.batches.intake.places import Places
from app.batches.intake.receive import Examined, Receipt, examine, lines_a_chunk, receive
from app.schemas.faults import BodyTooLarge

__all__ = [
    "BodyTooLarge",
    "Examined",
    "Incoming",
    "Places",
    "Receipt",
    "examine",
    "gunzipped",
    "lines_a_chunk",
    "read_csv",
    "read_geojson",
    "read_json",
    "read_ndjson",
    "read_rdf_xml",
    "read_xlsx",
    "receive",
]
