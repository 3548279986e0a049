"""Requests under way end when their key does, as a real server shows."""

import asyncio
import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import httpx
import pytest
from anyio import from_thread, to_thread
from sqlalchemy import select
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session, sessionmaker
from starlette.types import Message, Receive

from app.http.problems import ProblemError, ProblemKind
from app.runtime.settings import Settings
from app.security import keys, sessions
from app.security.caller import Scope
from app.security.under_way import while_admitted
from app.storage.database import make_engine, session_factory
from app.tables import Batch, IdempotencyKey
from tests.app import service
from tests.documents import short_request

CACHE_SECONDS = 0.3
SOON_SECONDS = 5.0  # what a busy machine may add to twice the above


@dataclass(frozen=True)
class Served:
    client: httpx.Client
    settings: Settings
    sessions: sessionmaker[Session]

    def key(self, expires_at: datetime | None = None) -> dict[str, str]:
        with self.sessions.begin() as session:
            _, key = keys.create(session, "acme", tuple(Scope), None, expires_at)
        return {"Authorization": f"Bearer {key}"}

    def revoke(self, header: dict[str, str]) -> None:
        with self.sessions.begin() as session:
            keys.revoke(session, header["Authorization"].removeprefix("Bearer "))


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    settings = service.sqlite_settings(
        tmp_path_factory.mktemp("served"), key_cache_seconds=CACHE_SECONDS, longest_wait_seconds=30.0
    )
    with service.running(settings) as client:
        engine = make_engine(settings)
        found = Served(client, settings, session_factory(engine))
        found.key()  # from now on the service asks for keys
        yield found
        engine.dispose()


@contextmanager
def ends_soon() -> Iterator[None]:
    begin = time.monotonic()
    yield
    assert time.monotonic() - begin < SOON_SECONDS


def test_event_stream_ends_with_its_key_and_others_go_on(served: Served) -> None:
    header, other = served.key(), served.key()
    job = service.submit_as(served.client, header)
    with (
        served.client.stream("GET", f"/v1/jobs/{job}/events", headers=other) as going_on,
        served.client.stream("GET", f"/v1/jobs/{job}/events", headers=header) as stream,
    ):
        events, others = stream.iter_lines(), going_on.iter_lines()
        assert next(events) and next(others)
        served.revoke(header)
        with ends_soon(), pytest.raises(httpx.RemoteProtocolError):
            list(events)
        time.sleep(3.0 * CACHE_SECONDS)
        served.client.post(f"/v1/jobs/{job}/cancel", headers=other).raise_for_status()
        assert "event: dismissed" in list(others)
    assert served.client.get(f"/v1/jobs/{job}/events", headers=header).status_code == 401


def test_event_stream_ends_with_a_key_that_expires(served: Served) -> None:
    header = served.key(datetime.now(UTC) + timedelta(seconds=1.0))
    job = service.submit_as(served.client, header)
    stream = served.client.stream("GET", f"/v1/jobs/{job}/events", headers=header)
    with ends_soon(), pytest.raises(httpx.RemoteProtocolError), stream as answer:
        list(answer.iter_lines())


def test_event_stream_of_a_page_ends_with_the_key_of_its_session(served: Served) -> None:
    header = served.key()
    digest = keys.digest_of(header["Authorization"].removeprefix("Bearer "))
    cookie = {"Cookie": f"{sessions.COOKIE}={sessions.issue(served.settings, digest)}"}
    job = service.submit_as(served.client, header)
    with served.client.stream("GET", f"/v1/jobs/{job}/events", headers=cookie) as stream:
        events = stream.iter_lines()
        assert next(events)
        served.revoke(header)
        with ends_soon(), pytest.raises(httpx.RemoteProtocolError):
            list(events)


def test_long_wait_is_refused_when_its_key_ends(served: Served) -> None:
    header = served.key()
    job = service.submit_as(served.client, header)
    revoke_later = _later(lambda: served.revoke(header))
    with ends_soon():
        answer = served.client.get(f"/v1/jobs/{job}", headers={**header, "Prefer": "wait=30"})
    revoke_later.join()
    assert answer.status_code == 401
    assert answer.json()["detail"] == "The key is unknown, revoked or expired."


def test_upload_is_refused_when_its_key_ends_and_leaves_nothing(served: Served) -> None:
    header = served.key()
    sent: list[float] = []

    def body() -> Iterator[bytes]:
        yield json.dumps({"analysis": short_request()["analysis"]}).encode() + b"\n"
        line = json.dumps(short_request()["line"]).encode() + b"\n"
        for number in range(200):
            if number == 3:
                served.revoke(header)
            sent.append(time.monotonic())
            time.sleep(0.1)
            yield line

    media_type = {"Content-Type": "application/x-ndjson", "Idempotency-Key": "upload"}
    try:
        answer = served.client.post("/v1/batches", content=body(), headers={**header, **media_type})
        assert answer.status_code == 401
    except (httpx.WriteError, httpx.ReadError):  # the connection was closed while the client still sent
        pass
    assert sent[-1] - sent[3] < SOON_SECONDS
    with served.sessions() as session:
        assert session.scalars(select(Batch)).all() == []
        assert session.scalars(select(IdempotencyKey)).all() == []


def test_streamed_results_end_with_their_key(served: Served) -> None:
    header = served.key()
    lines = [{**short_request()["line"], "reference": "x" * 200} for _ in range(1)] + [{"span": 1}] * 20_000
    document = {"lines": lines, "analysis": short_request()["analysis"]}
    batch = served.client.post("/v1/batches", json=document, headers=header).raise_for_status().json()["id"]
    address = f"/v1/batches/{batch}/errors"
    with served.client.stream("GET", address, headers={**header, "Accept-Encoding": "identity"}) as stream:
        pieces = stream.iter_raw(1)
        assert next(pieces)
        served.revoke(header)
        time.sleep(4.0 * CACHE_SECONDS)  # the reader is slow, so that most of the answer is not yet sent
        with ends_soon(), pytest.raises(httpx.RemoteProtocolError):
            for _ in pieces:
                pass


def test_request_goes_on_while_nobody_can_tell_and_faults_are_passed_on() -> None:
    async def trial(error: Exception | None, seconds: float) -> ProblemError | None:
        async def check() -> None:
            if error is not None:
                raise error

        return await while_admitted(lambda _: asyncio.sleep(seconds), nothing, check, 0.01)

    down = OperationalError("", {}, Exception())
    unavailable, refused = ProblemError(ProblemKind.UNAVAILABLE, ""), ProblemError(ProblemKind.UNAUTHENTICATED, "")
    for error in (None, down, unavailable):
        assert asyncio.run(trial(error, 0.1)) is None
    assert asyncio.run(trial(refused, 60.0)) is refused

    async def broken(_: Receive) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        asyncio.run(while_admitted(broken, nothing, nothing, 0.01))


def test_thread_that_asks_for_more_after_the_end_learns_of_it() -> None:
    refused, ended = ProblemError(ProblemKind.UNAUTHENTICATED, ""), threading.Event()

    async def check() -> None:
        asyncio.get_running_loop().call_soon(ended.set)  # when the request has been cancelled
        raise refused

    async def silence() -> Message:
        await asyncio.sleep(60.0)
        return await nothing()

    async def serve(receive: Receive) -> None:
        async def more() -> Message:
            return await receive()

        def read() -> None:
            ended.wait(10.0)
            time.sleep(0.1)
            from_thread.run(more)

        await to_thread.run_sync(read)

    with ends_soon():
        assert asyncio.run(while_admitted(serve, silence, check, 0.01)) is refused


async def nothing() -> Message:
    return {}


def _later(act: Callable[[], None]) -> threading.Timer:
    timer = threading.Timer(0.5, act)
    timer.start()
    return timer
