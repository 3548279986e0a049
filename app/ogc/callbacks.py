"""What a subscriber to a job of OGC API - Processes is sent. The sender of webhooks composes it when it sends."""

import json
from uuid import UUID

from sqlalchemy.orm import Session

from app.ogc import documents
from app.ogc.links import BASE
from app.storage.pages import Removed
from app.tables import DeliveryEvent, Job

LARGEST = 4 << 20  # characters of results that are sent; larger ones are sent by reference


def body(session: Session, job_id: UUID, event: DeliveryEvent, prefix: str) -> str | None:
    """Return the results of a job if the event is its success, else its status; None if the job was removed.

    Raises
    ------
    CorruptResult
        If the stored results are not what was stored.
    """
    job = session.get(Job, job_id)
    if job is None:
        return None
    if event is not DeliveryEvent.SUCCEEDED:
        return json.dumps(documents.status_info(job, prefix), separators=(",", ":"))
    try:
        return _results(session, job, prefix)
    except Removed:
        return None


def _results(session: Session, job: Job, prefix: str) -> str:
    pieces, size = [], 0
    for piece in documents.results(session, job, raw=False):
        pieces.append(piece)
        size += len(piece)
        if size > LARGEST:
            address = f"{prefix}{BASE}/jobs/{job.id}/results"
            return json.dumps({"result": {"href": address, "type": "application/json"}}, separators=(",", ":"))
    return "".join(pieces)
