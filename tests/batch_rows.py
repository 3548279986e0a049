"""Batches in the database for tests that need no service: made, claimed, and ended."""

from typing import Any
from uuid import UUID

from sqlalchemy.orm import Session, sessionmaker
from uuid_utils.compat import uuid7

from app.batches import batch_records
from app.batches.batch_records import Chunk
from app.jobs import leases
from app.security.caller import LOCAL
from tests.documents import point_result

ANALYSIS: dict[str, Any] = {"loops": [1]}


def add_batch(sessions: sessionmaker[Session], *sizes: int, rejected: int = 0) -> tuple[UUID, list[UUID]]:
    """Make an accepted batch with chunks of these sizes, whose line number n has the document {"n": n}."""
    chunks = [Chunk(uuid7(), part, size) for part, size in enumerate(sizes, 1)]
    owners = [chunk.id for chunk in chunks for _ in range(chunk.lines)]
    with sessions.begin() as session:
        batch_id = batch_records.begin(session, LOCAL, ANALYSIS)
        batch_records.add_items(session, [item(batch_id, n, owner) for n, owner in enumerate(owners, 1)])
        batch_records.accept(session, LOCAL, batch_id, chunks, rejected)
    return batch_id, [chunk.id for chunk in chunks]


def item(
    batch_id: UUID, number: int, chunk_id: UUID | None, faults: list[dict[str, str]] | None = None
) -> dict[str, Any]:
    return {
        "batch_id": batch_id,
        "number": number,
        "chunk_id": chunk_id,
        "reference": f"r{number}",
        "asset_id": None,
        "document": None if faults else {"n": number},
        "faults": faults,
    }


def claim(sessions: sessionmaker[Session], chunk_id: UUID, seconds: float = 60.0) -> leases.Claim:
    with sessions.begin() as session:
        held = leases.claim(session, chunk_id, "here", seconds)
    assert held is not None
    return held


def run(sessions: sessionmaker[Session], chunk_id: UUID, failing: frozenset[int] = frozenset()) -> None:
    """End a chunk with a result for each of its lines."""
    held = claim(sessions, chunk_id)
    assert held.batch_id is not None
    with sessions.begin() as session:
        _, lines = batch_records.lines_of_chunk(session, chunk_id, held.batch_id)
        points = [point_result(line.number, failure="Bad." if line.number in failing else None) for line in lines]
        assert leases.finish(session, held, points)
