"""What the routes of batches share: finding a batch, its status document and its links."""

from typing import Any
from uuid import UUID

from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records, line_results
from app.http.prefix import LinkedJSON
from app.http.problems import ProblemError, ProblemKind
from app.jobs import batch_progress
from app.jobs.batch_progress import Counts
from app.routes.dependencies import PREFIX, RETRY_SECONDS
from app.routes.job_status import seconds_between
from app.security.caller import Caller
from app.tables import ENDED, Batch

BATCHES = f"{PREFIX}/batches"

_ERRORS_SHOWN = 50


def find_batch(session: Session, caller: Caller, batch_id: UUID) -> Batch:
    """Return a batch of the caller's owner.

    Raises
    ------
    ProblemError
        404 if the owner has no batch of that id, even if another owner has.
    """
    batch = batch_records.get(session, caller.owner, batch_id)
    if batch is None:
        raise ProblemError(ProblemKind.NOT_FOUND, f"There is no batch {batch_id}.")
    return batch


def require_results(readers: sessionmaker[Session], caller: Caller, batch_id: UUID, *, partial: bool) -> str | None:
    """Check that a batch has results to show: all of them or, with `partial`, those so far.

    Return a fingerprint of the results of a finished batch, None if the batch has not ended.

    Raises
    ------
    ProblemError
        404 if the owner has no such batch, 409 if it has not ended.
    """
    with readers() as session:
        find_batch(session, caller, batch_id)
        counts = batch_progress.counts(session, [batch_id])[batch_id]
        if counts.status in ENDED:
            return batch_records.outcome(session, batch_id)
    if partial:
        return None
    raise ProblemError(
        ProblemKind.NOT_READY,
        f"The batch is {counts.status.value}, {counts.progress:.0%} done; ?partial=true returns the results so far.",
        links=[{"rel": "status", "href": batch_address(batch_id)}],
        headers={"Retry-After": RETRY_SECONDS},
    )


def batch_address(batch_id: UUID) -> str:
    """Return the address of a batch's status."""
    return f"{BATCHES}/{batch_id}"


def batch_summary(batch: Batch, counts: Counts) -> dict[str, Any]:
    """Return the state of a batch for a list."""
    return {
        "id": str(batch.id),
        "status": counts.status.value,
        "progress": counts.progress,
        "name": batch.name,
        "tags": batch.tags or {},
        "lines": line_counts(counts, batch.rejected_lines),
        "created_at": batch.created_at.isoformat(),
        "started_at": counts.started_at.isoformat() if counts.started_at else None,
        "finished_at": counts.finished_at.isoformat() if counts.finished_at else None,
        "duration_seconds": seconds_between(counts.started_at, counts.finished_at),
        "links": _links(batch, counts),
    }


def line_counts(counts: Counts, rejected: int) -> dict[str, int]:
    """Return the number of lines of a batch in each state."""
    return {
        "total": counts.lines + rejected,
        "accepted": counts.accepted,
        "running": counts.running,
        "successful": counts.successful,
        "failed": counts.failed,
        "dismissed": counts.dismissed,
        "rejected": rejected,
        "reused": counts.reused,
    }


def batch_document(session: Session, batch: Batch, counts: Counts) -> dict[str, Any]:
    """Return the status document of a batch, with the faults of the first rejected lines and notes."""
    shown = list(line_results.errors(session, batch.id, _ERRORS_SHOWN)) if batch.rejected_lines else []
    return {**batch_summary(batch, counts), "errors": shown[:_ERRORS_SHOWN], "notes": batch.notes or []}


def accepted_batch(session: Session, caller: Caller, batch_id: UUID) -> LinkedJSON:
    """Return the answer to a request that submitted or resubmitted a batch."""
    batch = find_batch(session, caller, batch_id)
    document = batch_document(session, batch, batch_progress.counts(session, [batch_id])[batch_id])
    return LinkedJSON(document, 202, headers={"Location": batch_address(batch_id), "Retry-After": RETRY_SECONDS})


def _links(batch: Batch, counts: Counts) -> list[dict[str, str]]:
    address = batch_address(batch.id)
    links = [{"rel": "self", "href": address}, {"rel": "chunks", "href": f"{PREFIX}/jobs?batch_id={batch.id}"}]
    if batch.rejected_lines:
        links.append({"rel": "errors", "href": f"{address}/errors"})
    if counts.status in ENDED:
        links.append({"rel": "results", "href": f"{address}/results"})
    return links
