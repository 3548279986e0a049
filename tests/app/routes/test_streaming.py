"""Clients that stop reading an answer, beside others."""

import contextlib
import socket
from collections.abc import Iterator
from uuid import UUID

import httpx
import pytest
from sqlalchemy import insert, select
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.storage import database
from app.tables import PointRow
from tests.app import service

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
