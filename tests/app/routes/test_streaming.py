"""Clients that stop reading an answer, beside others, and readers of results that turn out to be damaged."""

import contextlib
import json
import socket
from collections.abc import Iterator
from uuid import UUID

import httpx
import pytest
from sqlalchemy import insert, select, update
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.storage import database
from app.tables import BatchItem, PointRow
from tests.app import service
from tests.app.lines import SHORT
from tests.documents import short_request

POINTS = 800
CONNECTIONS = 3  # of the database
STALLED = 2 * CONNECTIONS


@contextlib.contextmanager
def stalled_readers(client: httpx.Client, target: str) -> Iterator[list[socket.socket]]:
    """Ask for an answer many times over and read nothing but its beginning."""
    with contextlib.ExitStack() as stack:
        connections = [stack.enter_context(socket.socket()) for _ in range(STALLED)]
        for connection in connections:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.settimeout(60.0)
            connection.connect((client.base_url.host, client.base_url.port))
            connection.sendall(f"GET {target} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode())
        for connection in connections:
            assert connection.recv(12) == b"HTTP/1.1 200"
        yield connections


def enlarge(sessions: sessionmaker[Session], job_id: UUID) -> None:
    """Give a job the results of its point many times over, so that no socket holds all of them."""
    with sessions.begin() as session:
        table = PointRow.__table__
        row = dict(session.execute(select(table).where(table.c.job_id == job_id)).mappings().one())
        session.execute(insert(PointRow), [{**row, "point": point} for point in range(1, POINTS)])


def test_readers_that_stop_hold_up_nobody(
    settings: Settings, sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database, "_POOL", {"pool_size": CONNECTIONS, "max_overflow": 0})
    with service.running(settings) as client:
        address = service.finished(client, settings)
        enlarge(sessions, UUID(address.rpartition("/")[2]))
        _check(client, address)


def _check(client: httpx.Client, address: str) -> None:
    whole = client.get(f"{address}/results").content
    with stalled_readers(client, f"{address}/results") as connections:
        assert client.get(address).status_code == 200
        assert client.get(f"{address}/results").content == whole
        rest = b"".join(iter(lambda: connections[-1].recv(1 << 20), b""))
    assert rest.endswith(b"\r\n0\r\n\r\n")


CODINGS = ("identity", "gzip", "zstd")
OF_JOB = ("", "/limit-cycles?format=json", "/limit-cycles?format=csv", "/limit-cycles?format=parquet")
OF_BATCH = ("?format=ndjson", "?table=limit-cycles&format=ndjson", "?table=limit-cycles&format=csv")


def test_results_that_are_damaged_further_on_never_look_whole(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    with service.running(settings) as client:
        address = service.finished(client, settings)
        enlarge(sessions, UUID(address.rpartition("/")[2]))
        assert_cut(client, sessions, [f"{address}/results{what}" for what in OF_JOB])


def test_a_batch_that_is_damaged_further_on_never_looks_whole(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    with service.running(settings) as client:
        body = {"lines": [short_request()["line"]], "analysis": SHORT}
        address = client.post("/v1/batches", json=body).headers["location"]
        service.work_off(client, settings, address)
        with sessions.begin() as session:
            for table, number in ((BatchItem, "number"), (PointRow, "point")):
                row = dict(session.execute(select(table.__table__)).mappings().one())
                session.execute(insert(table), [{**row, number: line} for line in range(2, POINTS)])
        assert_cut(client, sessions, [f"{address}/results{what}" for what in OF_BATCH])
        assert client.get(f"{address}/results?format=csv").status_code == 200  # the summary stands in other columns


def assert_cut(client: httpx.Client, sessions: sessionmaker[Session], addresses: list[str]) -> None:
    """Damage one of the last results: answers are refused, or end in an error, for every format and encoding."""
    asked = [(address, {"Accept-Encoding": coding}) for address in addresses for coding in CODINGS]
    for address, headers in asked:
        assert client.get(address, headers=headers).status_code == 200
    with sessions.begin() as session:
        row = session.scalars(select(PointRow).where(PointRow.point == POINTS - 10)).one()
        packed = bytearray(row.tables or b"")
        packed[len(packed) // 2] ^= 1
        session.execute(update(PointRow).where(PointRow.point == POINTS - 10).values(tables=bytes(packed)))
    assert {fate(client, address, headers) for address, headers in asked if "parquet" not in address} >= {"cut"}
    assert {fate(client, address, headers) for address, headers in asked} <= {"cut", "refused"}


def fate(client: httpx.Client, address: str, headers: dict[str, str]) -> str:
    """Tell what a reader of a damaged result sees."""
    with client.stream("GET", address, headers=headers) as answer:
        if answer.status_code == 410:  # nothing was sent before the damage was found
            assert json.loads(answer.read())["type"] == "/problems/damaged"
            return "refused"
        assert answer.status_code == 200
        with pytest.raises(httpx.RemoteProtocolError, match="incomplete chunked read"):
            answer.read()
        return "cut"
