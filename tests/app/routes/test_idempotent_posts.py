"""POSTs under an Idempotency-Key, over HTTP."""

import gzip
import json
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any
from uuid import UUID

import httpx
import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.jobs.leases import Failure
from app.reference.source_lines import example
from app.routes.reference_documentation import FIT_REQUESTS
from app.runtime.settings import Settings
from app.tables import FailureKind, IdempotencyKey
from tests.app import service
from tests.app.lines import SHORT
from tests.documents import short_request
from tests.servers import wait_until

TWIN = example("c11-twin")
KEY = {"Idempotency-Key": "order-17"}
LINES = [{"analysis": SHORT}, {**TWIN, "reference": "a"}, {**TWIN, "reference": "b"}]
NDJSON = "".join(json.dumps(item) + "\n" for item in LINES).encode()
NDJSON_TYPE = {"Content-Type": "application/x-ndjson"}


def jobs_made(client: httpx.Client) -> int:
    return len(client.get("/v1/jobs?limit=500").json()["jobs"])


def batches_made(client: httpx.Client) -> int:
    return len(client.get("/v1/batches").json()["batches"])


def assert_same(again: httpx.Response, first: httpx.Response) -> None:
    assert (again.status_code, again.content) == (first.status_code, first.content)
    for name in ("location", "retry-after", "content-type"):
        assert again.headers.get(name) == first.headers.get(name)
    assert "idempotency-replayed" not in first.headers
    assert again.headers["idempotency-replayed"] == "true"


def slug(answer: httpx.Response) -> str:
    return str(answer.json()["type"]).rpartition("/")[2]


def test_the_same_post_again_gets_the_first_answer(client: httpx.Client) -> None:
    first = client.post("/v1/jobs", json=short_request(), headers=KEY)
    assert first.status_code == 202
    client.delete(first.headers["location"])
    again = client.post("/v1/jobs", json=dict(reversed(short_request().items())), headers=KEY)
    assert_same(again, first)
    assert jobs_made(client) == 1
    other = client.post("/v1/jobs", json=short_request(), headers={"Idempotency-Key": "order-18"})
    assert other.json()["id"] != first.json()["id"]


def test_another_request_under_the_key_is_refused(client: httpx.Client) -> None:
    client.post("/v1/jobs", json=short_request(), headers=KEY)
    other = {"line": short_request()["line"]}
    answer = client.post("/v1/jobs", json=other, headers=KEY)
    assert (answer.status_code, slug(answer)) == (422, "idempotency-key-reused")
    answer = client.post("/v1/batches", content=NDJSON, headers={**KEY, **NDJSON_TYPE})
    assert (answer.status_code, slug(answer)) == (422, "idempotency-key-reused")
    assert (jobs_made(client), batches_made(client)) == (1, 0)


def test_fifty_equal_posts_at_once_make_one_job(client: httpx.Client) -> None:
    barrier = threading.Barrier(50)

    def post(_: int) -> httpx.Response:
        barrier.wait()
        return client.post("/v1/jobs", json=short_request(), headers=KEY)

    with ThreadPoolExecutor(50) as pool:
        answers = list(pool.map(post, range(50)))
    assert {answer.status_code for answer in answers} == {202}
    assert len({answer.content for answer in answers}) == 1
    assert sum("idempotency-replayed" not in answer.headers for answer in answers) == 1
    assert jobs_made(client) == 1


def test_a_fault_leaves_the_key_free(client: httpx.Client) -> None:
    assert client.post("/v1/jobs", json={"line": {}}, headers=KEY).status_code == 422
    assert client.post("/v1/batches", content=b'{"analysis": {}}\n{}\n', headers={**KEY, **NDJSON_TYPE}).is_error
    assert client.post("/v1/jobs", json=short_request(), headers=KEY).status_code == 202


@pytest.mark.parametrize("key", [b"", b"a" * 256, "caf\u00e9".encode(), b"a\tb"])
def test_keys_of_other_characters_are_refused(shared_client: httpx.Client, key: bytes) -> None:
    answer = shared_client.post("/v1/jobs", json=short_request(), headers={b"Idempotency-Key": key})
    assert (answer.status_code, slug(answer)) == (400, "invalid-parameter")


def test_a_batch_is_taken_in_once_however_it_is_packed(client: httpx.Client) -> None:
    headers = {**KEY, **NDJSON_TYPE}
    first = client.post("/v1/batches", content=NDJSON, headers=headers)
    assert first.status_code == 202
    assert_same(client.post("/v1/batches", content=NDJSON, headers=headers), first)
    packed = {**headers, "Content-Encoding": "gzip"}
    assert_same(client.post("/v1/batches", content=gzip.compress(NDJSON), headers=packed), first)
    assert batches_made(client) == 1
    for query, body in (("", NDJSON + NDJSON.splitlines()[1]), ("?atomic=true", NDJSON)):
        answer = client.post(f"/v1/batches{query}", content=body, headers=headers)
        assert (answer.status_code, slug(answer)) == (422, "idempotency-key-reused")
    assert batches_made(client) == 1


def test_a_batch_that_still_comes_in_holds_its_key(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    headers, go_on = {**KEY, **NDJSON_TYPE}, threading.Event()

    def slowly() -> Iterator[bytes]:
        yield NDJSON[:100]
        go_on.wait(30.0)
        yield NDJSON[100:]

    def held() -> bool:
        with sessions() as session:
            return bool(session.scalars(select(IdempotencyKey.key)).all())

    with ThreadPoolExecutor(1) as pool:
        first = pool.submit(client.post, "/v1/batches", content=slowly(), headers=headers)
        wait_until(held, what="the key being held")
        refused = client.post("/v1/batches", content=NDJSON, headers=headers)
        go_on.set()
        assert first.result().status_code == 202
    assert (refused.status_code, slug(refused)) == (409, "request-in-flight")
    assert int(refused.headers["retry-after"]) >= 1
    assert batches_made(client) == 1
    assert_same(client.post("/v1/batches", content=NDJSON, headers=headers), first.result())


def test_a_slow_sender_keeps_the_key_for_many_leases(settings: Settings) -> None:
    headers, go_on = {**KEY, **NDJSON_TYPE}, threading.Event()

    def slowly() -> Iterator[bytes]:
        yield NDJSON[:100]
        go_on.wait(30.0)
        yield NDJSON[100:]

    with (
        service.running(settings.model_copy(update={"key_lease_seconds": 0.5})) as client,
        ThreadPoolExecutor(1) as pool,
    ):
        first = pool.submit(client.post, "/v1/batches", content=slowly(), headers=headers)
        for _ in range(4):
            time.sleep(0.5)
            assert client.post("/v1/batches", content=NDJSON, headers=headers).status_code == 409
        go_on.set()
        assert first.result().status_code == 202
        assert batches_made(client) == 1


def test_failed_lines_are_resubmitted_once(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    address = client.post("/v1/batches", content=NDJSON, headers=NDJSON_TYPE).headers["location"]

    def chunks() -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = client.get("/v1/jobs", params={"batch_id": address[-36:]}).json()["jobs"]
        return found

    with sessions.begin() as session:
        held = leases.claim(session, UUID(chunks()[0]["id"]), "test", 30.0)
        assert held is not None
        leases.fail(session, held, Failure(FailureKind.TIME_LIMIT, "too long"))
    first = client.post(f"{address}/resubmit", headers=KEY)
    assert first.status_code == 202
    assert first.json()["lines"]["accepted"] == 2
    assert_same(client.post(f"{address}/resubmit", headers=KEY), first)
    assert len(chunks()) == 2


def test_a_fit_is_answered_again(client: httpx.Client) -> None:
    body = next(iter(FIT_REQUESTS.values()))["value"]
    first = client.post("/v1/aerodynamics/fit", json=body, headers=KEY)
    assert first.status_code == 200
    assert_same(client.post("/v1/aerodynamics/fit", json=body, headers=KEY), first)
    answer = client.post("/v1/jobs", json=short_request(), headers=KEY)
    assert (answer.status_code, slug(answer)) == (422, "idempotency-key-reused")
