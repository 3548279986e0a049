"""Keys in use: who is let through to what, on SQLite with its folder and on PostgreSQL with Redis."""

import asyncio
import socket
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import UUID, uuid4

import httpx
import pytest
from sqlalchemy import select, text
from sqlalchemy.orm import Session, sessionmaker

from app.main import create_app
from app.routes.own_documentation import OWN_TABLE_REQUESTS, SHEET
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from app.tables import AuditAction, AuditEvent, Job
from tests.app import service
from tests.documents import short_request
from tests.in_process import run_job

CACHE_SECONDS = 0.3
PARAMETERS = {"table": "frequencies", "picture": "amplitude", "extension": "svg", "slug": "not-found"}
OPEN = {"/health/live", "/health/ready", "/problems/{slug}"}


@dataclass(frozen=True)
class Guarded:
    """A running service that asks for keys."""

    client: httpx.Client
    settings: Settings
    sessions: sessionmaker[Session]

    def key(self, owner: str, *scopes: Scope, expires_at: datetime | None = None) -> dict[str, str]:
        """Make a key and return the header that shows it."""
        with self.sessions.begin() as session:
            _, key = keys.create(session, owner, scopes or tuple(Scope), None, expires_at)
        return {"Authorization": f"Bearer {key}"}


@pytest.fixture
def guarded(deployment: Settings, deployed: sessionmaker[Session]) -> Iterator[Guarded]:
    """Give a service with one key, whose owner has nothing."""
    settings = deployment.model_copy(update={"key_cache_seconds": CACHE_SECONDS})
    with service.running(settings) as client:
        found = Guarded(client, settings, deployed)
        found.key("nobody")
        yield found


def operations(document: Mapping[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            yield method.upper(), path, operation


def filled(path: str, ids: Mapping[str, str]) -> str:
    """Put values in the place of a path's parameters; a parameter that is not known here fails the test."""
    return path.format(**{**PARAMETERS, **ids}) if "{" in path else path


def told(answer: httpx.Response, ids: Mapping[str, str]) -> str:
    """Return an answer's body with marks in the place of the ids."""
    said = answer.text
    for name, value in ids.items():
        said = said.replace(value, name)
    return said


def owned(guarded: Guarded, header: dict[str, str]) -> dict[str, str]:
    """Make a finished job, a finished batch, one line of which failed, and own rows, and return their ids."""
    client = guarded.client
    job = client.post("/v1/jobs", json=short_request(), headers=header).raise_for_status().json()["id"]
    run_job(guarded.settings, UUID(job))
    lines = [short_request()["line"], {"span": 1}]
    document = {"lines": lines, "analysis": short_request()["analysis"]}
    batch = client.post("/v1/batches", json=document, headers=header).raise_for_status().json()["id"]
    with guarded.sessions() as session:
        (chunk,) = session.scalars(select(Job.id).where(Job.batch_id == UUID(batch)))
    run_job(guarded.settings, chunk)
    sheet = {**header, "Content-Type": "text/csv"}
    rows = client.post("/v1/conductors/own", content=SHEET.encode(), headers=sheet).raise_for_status().json()
    (table,) = (request["value"] for request in OWN_TABLE_REQUESTS.values())
    kept = client.post("/v1/aerodynamics/own", json=table, headers=header).raise_for_status().json()["id"]
    return {"job_id": job, "batch_id": batch, "conductor_id": rows["conductors"][0]["id"], "table_id": kept}


def test_another_owners_ids_are_as_unknown_as_any_on_every_route(guarded: Guarded) -> None:
    mine, stranger = guarded.key("acme"), guarded.key("other")
    ids = owned(guarded, mine)
    nothing = {name: str(uuid4()) for name in ids}
    document = guarded.client.get("/openapi.json").json()
    addresses = [f"/v1/jobs/{ids['job_id']}", f"/v1/batches/{ids['batch_id']}"]
    before = [guarded.client.get(address, headers=mine).json() for address in addresses]
    tried = 0
    for method, path, _ in operations(document):
        if not any(f"{{{name}}}" in path for name in ids):
            continue
        body = {"tags": {"taken": "yes"}} if method == "PATCH" else None
        theirs = guarded.client.request(method, filled(path, ids), headers=stranger, json=body)
        unknown = guarded.client.request(method, filled(path, nothing), headers=stranger, json=body)
        assert (theirs.status_code, unknown.status_code) == (404, 404), f"{method} {path}"
        assert told(theirs, ids) == told(unknown, nothing), f"{method} {path}"
        tried += 1
    assert tried >= 12
    assert guarded.client.get("/v1/conductors/own", headers=mine).json()["conductors"]
    assert guarded.client.get("/v1/aerodynamics/own", headers=mine).json()["tables"]
    assert [guarded.client.get(address, headers=mine).json() for address in addresses] == before


def test_lists_hold_the_owners_own_only(guarded: Guarded) -> None:
    mine, stranger = guarded.key("acme"), guarded.key("other")
    ids = owned(guarded, mine)
    theirs = service.submit_as(guarded.client, stranger)
    document = guarded.client.get("/openapi.json").json()
    lists = [path for method, path, _ in operations(document) if method == "GET" and "{" not in path]
    of_owners = {"/v1/jobs", "/v1/batches", "/v1/conductors/own", "/v1/aerodynamics/own"}
    assert of_owners < set(lists)
    for path in lists:
        said = {name: guarded.client.get(path, headers=header).text for name, header in (("a", mine), ("b", stranger))}
        assert not any(value in said["b"] for value in ids.values()), path
        if path in of_owners:
            assert any(value in said["a"] for value in ids.values()), path
    listed = guarded.client.get("/v1/jobs", headers=stranger).json()["jobs"]
    assert [job["id"] for job in listed] == [theirs]
    assert guarded.client.get("/v1/jobs", params={"batch_id": ids["batch_id"]}, headers=stranger).json()["jobs"] == []
    assert len(guarded.client.get("/v1/jobs", params={"batch_id": ids["batch_id"]}, headers=mine).json()["jobs"]) == 1


def test_two_keys_of_an_owner_see_the_same(guarded: Guarded) -> None:
    job = service.submit_as(guarded.client, guarded.key("acme"))
    assert guarded.client.get(f"/v1/jobs/{job}", headers=guarded.key("acme", Scope.READ)).status_code == 200


def test_every_route_but_the_open_ones_asks_for_a_key_and_says_so(guarded: Guarded) -> None:
    document = guarded.client.get("/openapi.json").json()
    ids = {name: str(uuid4()) for name in ("job_id", "batch_id", "conductor_id", "table_id")}
    for method, path, operation in operations(document):
        answer = guarded.client.request(method, filled(path, ids))
        if path in OPEN:
            assert answer.status_code == 200, path
            continue
        assert answer.status_code == 401, path
        assert answer.headers["www-authenticate"].startswith("Bearer realm="), path
        assert answer.headers["content-type"] == "application/problem+json"
        assert operation["security"] == [{"key": []}]
        assert {"401", "403", "429"} <= set(operation["responses"])
    assert guarded.client.get("/v1/nothing").status_code == 401
    assert guarded.client.get("/openapi.json").status_code == 200
    assert guarded.client.get("/docs").status_code == 200


def test_what_is_no_good_key_is_refused(guarded: Guarded) -> None:
    unknown = f"Bearer galloping_{'0' * 48}"
    for shown in ("Bearer", "Basic YTpi", "galloping_x", unknown, "Bearer é", "bearer x y"):
        answer = guarded.client.get("/v1/jobs", headers={b"Authorization": shown.encode("latin-1")})
        assert answer.status_code == 401, shown
        assert answer.json()["type"] == "/problems/unauthenticated"
    key = guarded.key("acme")["Authorization"].removeprefix("Bearer ")
    assert guarded.client.get("/v1/jobs", headers={"Authorization": f"bEARER  {key}"}).status_code == 200


def test_scopes_are_those_of_the_methods(guarded: Guarded) -> None:
    everything = guarded.key("acme")
    allowed = {scope: guarded.key("acme", scope) for scope in Scope}

    def statuses(method: str, path: str, **request: Any) -> dict[Scope, int]:
        return {
            scope: guarded.client.request(method, path, headers=header, **request).status_code
            for scope, header in allowed.items()
        }

    job = service.submit_as(guarded.client, everything)
    read = {Scope.READ: 200, Scope.SUBMIT: 403, Scope.CANCEL: 403}
    assert statuses("GET", f"/v1/jobs/{job}") == read
    assert statuses("HEAD", f"/v1/jobs/{job}") == read
    submit = {Scope.READ: 403, Scope.SUBMIT: 202, Scope.CANCEL: 403}
    assert statuses("POST", "/v1/jobs", json=short_request()) == submit
    cancel = {Scope.READ: 403, Scope.SUBMIT: 403, Scope.CANCEL: 200}
    assert statuses("DELETE", f"/v1/jobs/{job}") == cancel
    assert statuses("POST", f"/v1/jobs/{job}/cancel") == cancel
    refused = guarded.client.delete(f"/v1/jobs/{job}", headers=allowed[Scope.READ])
    assert 'error="insufficient_scope", scope="cancel"' in refused.headers["www-authenticate"]


def test_a_revoked_key_ends_within_the_stated_time_and_its_use_is_on_record(guarded: Guarded) -> None:
    header = guarded.key("acme")
    assert guarded.client.get("/v1/jobs", headers=header).status_code == 200
    with guarded.sessions.begin() as session:
        revoked = keys.revoke(session, header["Authorization"].removeprefix("Bearer "))
        session.execute(text("UPDATE api_keys SET used_at = NULL"))
    time.sleep(CACHE_SECONDS)
    answers = [guarded.client.get("/v1/jobs", headers=header).status_code for _ in range(3)]
    assert answers == [401, 401, 401]
    with guarded.sessions() as session:
        found = session.scalars(select(AuditEvent).where(AuditEvent.action == AuditAction.KEY_REFUSED)).all()
    assert [(event.owner, event.key_id) for event in found] == [("acme", revoked.id)]  # once, however often it is tried


def test_an_expired_key_is_refused(guarded: Guarded) -> None:
    past, future = (datetime.now(UTC) + timedelta(hours=hours) for hours in (-1, 1))
    assert guarded.client.get("/v1/jobs", headers=guarded.key("acme", expires_at=past)).status_code == 401
    assert guarded.client.get("/v1/jobs", headers=guarded.key("acme", expires_at=future)).status_code == 200


def test_changes_are_on_record_with_owner_and_key(guarded: Guarded) -> None:
    header = guarded.key("acme")
    ids = owned(guarded, header)
    waiting = service.submit_as(guarded.client, header)
    for address in (f"/v1/jobs/{waiting}", f"/v1/jobs/{waiting}", f"/v1/batches/{ids['batch_id']}"):
        assert guarded.client.delete(address, headers=header).is_success
    with guarded.sessions() as session:
        (key,) = keys.listed(session, "acme")
        found = session.scalars(select(AuditEvent).where(AuditEvent.owner == "acme").order_by(AuditEvent.id)).all()
    assert [(event.action.value, str(event.subject)) for event in found] == [
        ("job_submitted", ids["job_id"]),
        ("batch_submitted", ids["batch_id"]),
        ("job_submitted", waiting),
        ("job_cancelled", waiting),
        ("job_removed", waiting),
        ("batch_removed", ids["batch_id"]),
    ]
    assert {event.key_id for event in found} == {key.id}


def test_quotas_are_told_and_kept_with_reads_apart_from_changes(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, changes_per_minute=3, reads_per_minute=5)
    with guarding(settings) as (client, header):
        wait_for_a_whole_window()
        posts = [client.post("/v1/jobs", json=short_request(), headers=header) for _ in range(4)]
        assert [answer.status_code for answer in posts] == [202, 202, 202, 429]
        assert [answer.headers["ratelimit"].split(";")[:2] for answer in posts] == [
            ['"changes"', f"r={left}"] for left in (2, 1, 0, 0)
        ]
        assert posts[0].headers["ratelimit-policy"] == '"changes";q=3;w=60'
        reset = int(posts[-1].headers["ratelimit"].rpartition("t=")[2])
        assert 0 < reset <= 60
        assert posts[-1].headers["retry-after"] == str(reset)
        assert posts[-1].json()["type"] == "/problems/too-many-requests"
        read = client.get("/v1/jobs", headers=header)
        assert (read.status_code, read.headers["ratelimit-policy"]) == (200, '"reads";q=5;w=60')


def test_processes_share_quotas_through_redis_and_owners_do_not(redis_address: str, tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, changes_per_minute=5, broker_url=redis_address)
    with guarding(settings) as (first, header), service.running(settings) as second:
        wait_for_a_whole_window()
        statuses = [
            client.post("/v1/jobs", json=short_request(), headers=header).status_code for client in (first, second) * 3
        ]
        assert statuses == [202] * 5 + [429]
        with sessions_of(settings) as sessions, sessions.begin() as session:
            _, other = keys.create(session, "other", tuple(Scope), None, None)
        answer = second.post("/v1/jobs", json=short_request(), headers={"Authorization": f"Bearer {other}"})
        assert answer.status_code == 202


def test_whoever_tries_many_keys_is_slowed_down_but_good_keys_go_on(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path, strangers_per_minute=3, key_cache_seconds=CACHE_SECONDS)
    with guarding(settings) as (client, header):
        wait_for_a_whole_window()
        tries = [client.get("/v1/jobs", headers={"Authorization": f"Bearer {n}"}).status_code for n in range(5)]
        assert tries == [401, 401, 401, 429, 429]
        # This process has not seen the key before, and after a while it looks for it again.
        for _ in range(2):
            assert client.get("/v1/jobs", headers=header).status_code == 200
            time.sleep(1.5 * CACHE_SECONDS)
        assert client.get("/v1/jobs", headers={"Authorization": "Bearer 9"}).status_code == 429


def test_without_keys_only_this_machine_is_served(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path)
    migrate(settings)

    def status(server: str = "127.0.0.1", client: str = "127.0.0.1", **headers: str) -> int:
        return asyncio.run(asked(settings, server, client, headers)).status_code

    assert status() == 200
    assert status("[::1]", "::1") == 200
    assert status(host="localhost:8000") == 200
    assert status("10.0.0.5") == 401
    assert status(client="10.0.0.6") == 401
    assert status(host="galloping.example") == 401  # a name that leads here is another site's
    assert status(host="[") == 401
    assert status(**{"X-Forwarded-For": "10.0.0.7"}) == 401
    assert status(Forwarded="for=10.0.0.7") == 401
    for name in ("Via", "X-Forwarded-Host", "X-Forwarded-Proto", "X-Real-IP"):
        assert status(**{name: "10.0.0.7"}) == 401, name


def test_without_keys_a_proxy_that_speaks_http_1_0_is_not_this_machine(tmp_path: Path) -> None:
    answers = []
    with service.running(service.sqlite_settings(tmp_path)) as client:
        for version in ("1.1", "1.0"):
            with socket.create_connection((client.base_url.host, client.base_url.port or 80), timeout=20.0) as proxy:
                head = f"GET /v1/jobs HTTP/{version}\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n"
                proxy.sendall(head.encode())
                answers.append(proxy.recv(12)[-3:])
    assert answers == [b"200", b"401"]


def test_security_headers_are_on_every_answer(tmp_path: Path) -> None:
    settings = service.sqlite_settings(
        tmp_path, max_body_bytes=1000, strangers_per_minute=1, key_cache_seconds=CACHE_SECONDS
    )
    with service.running(settings) as client:
        answers = [
            client.get("/health/live"),
            client.get("/docs"),
            client.post("/v1/jobs", json={}),
            client.post("/v1/jobs", content=b"x" * 1001, headers={"Content-Type": "application/json"}),
            client.put("/v1/jobs"),
            client.get("/v1/jobs/1"),
        ]
        with sessions_of(settings) as sessions, sessions.begin() as session:
            _, key = keys.create(session, "acme", [Scope.READ, Scope.SUBMIT], None, None)
        time.sleep(CACHE_SECONDS)
        answers += [client.get("/v1/jobs")]
        header = {"Authorization": f"Bearer {key}"}
        answers += [client.get("/v1/jobs", headers=header), client.delete("/v1/jobs", headers=header)]
        answers += [client.get("/v1/jobs", headers={"Authorization": "Bearer x"}) for _ in range(2)]
    answers.append(asyncio.run(broken(settings)))
    assert [a.status_code for a in answers] == [200, 200, 422, 413, 405, 404, 401, 200, 403, 401, 429, 500]
    for answer in answers:
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["x-frame-options"] == "DENY"
        assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
        assert answer.headers["referrer-policy"] == "no-referrer"
        assert "no-store" in answer.headers["cache-control"]


async def asked(settings: Settings, server: str, client: str, headers: dict[str, str]) -> httpx.Response:
    """Ask the application as if over a connection between these addresses."""
    transport = httpx.ASGITransport(create_app(settings), client=(client, 1))
    async with httpx.AsyncClient(transport=transport, base_url=f"http://{server}:8000") as session:
        return await session.get("/v1/jobs", headers=headers)


async def broken(settings: Settings) -> httpx.Response:
    """Ask an application for what it is broken at."""
    application = create_app(settings)

    @application.get("/problems/defect/of/a/route")
    def defect() -> None:
        raise ZeroDivisionError

    transport = httpx.ASGITransport(application, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as session:
        return await session.get("/problems/defect/of/a/route")


@contextmanager
def sessions_of(settings: Settings) -> Iterator[sessionmaker[Session]]:
    engine = make_engine(settings)
    yield session_factory(engine)
    engine.dispose()


@contextmanager
def guarding(settings: Settings) -> Iterator[tuple[httpx.Client, dict[str, str]]]:
    """Give a client of a service with one key, and the header that shows it."""
    with service.running(settings) as client, sessions_of(settings) as sessions:
        with sessions.begin() as session:
            _, key = keys.create(session, "acme", tuple(Scope), None, None)
        yield client, {"Authorization": f"Bearer {key}"}


def wait_for_a_whole_window() -> None:
    """Wait until the minute of the quotas does not end within the next requests."""
    left = 60.0 - time.time() % 60.0
    if left < 10.0:
        time.sleep(left)
