"""What the results of a batch cost in memory as they are sent, on either database."""

import tracemalloc
from collections.abc import Iterator
from dataclasses import replace
from uuid import UUID

import httpx
import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.jobs import leases
from app.runtime.settings import Settings
from tests.app import service
from tests.batch_rows import add_batch, claim
from tests.documents import point_result

WARNING = "x" * 2_000  # so that what is told of a line is as long as of a usual one
FEW, MANY = 1_000, 4_000


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service on either kind of database."""
    with service.running(settings) as running:
        yield running


def finished(sessions: sessionmaker[Session], lines: int) -> str:
    """Make a batch whose every line has a result, and return its address."""
    batch_id, chunks = add_batch(sessions, *[250] * (lines // 250))
    for chunk in chunks:
        work_off(sessions, batch_id, chunk)
    return f"/v1/batches/{batch_id}"


def work_off(sessions: sessionmaker[Session], batch_id: UUID, chunk: UUID) -> None:
    held = claim(sessions, chunk)
    with sessions.begin() as session:
        _, lines = batch_records.lines_of_chunk(session, chunk, batch_id)
        points = [replace(point_result(line.number), warnings=[f"{line.number}{WARNING}"]) for line in lines]
        assert leases.finish(session, held, points)


def peak(client: httpx.Client, address: str) -> tuple[int, int]:
    """Read an answer piece by piece; return how long it was, and the most memory that server and client held."""
    length = 0
    tracemalloc.start()
    try:
        with client.stream("GET", address, headers={"Accept-Encoding": "identity"}) as answer:
            answer.raise_for_status()
            for piece in answer.iter_raw():
                length += len(piece)
        return length, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("query", ["format=ndjson", "format=ndjson&table=frequencies", "format=csv&table=frequencies"])
def test_memory_does_not_grow_with_the_batch(client: httpx.Client, sessions: sessionmaker[Session], query: str) -> None:
    addresses = [f"{finished(sessions, lines)}/results?{query}" for lines in (FEW, MANY)]
    peak(client, addresses[0])  # what is loaded and kept at the first time
    (short, least), (long, most) = (peak(client, address) for address in addresses)
    assert long > 3.9 * short
    assert most < 1.2 * least
