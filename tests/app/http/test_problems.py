import json
import socket
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import httpx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.http import strict_routes
from app.http.problems import MEDIA_TYPE, ProblemKind, problem_document
from app.reference.source_lines import example
from app.routes import jobs
from app.schemas.faults import Fault
from tests.app import service
from tests.app.lines import FULL_LINE, changed
from tests.documents import short_request

JSON_HEADERS = {"Content-Type": "application/json"}


def problem(answer: httpx.Response, status: int) -> dict[str, Any]:
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == MEDIA_TYPE
    document: dict[str, Any] = answer.json()
    assert document["status"] == status
    assert "Traceback" not in answer.text
    return document


def post(client: httpx.Client, body: bytes | Iterator[bytes]) -> httpx.Response:
    return client.post("/v1/jobs", content=body, headers=JSON_HEADERS)


def numbers_of_jobs(client: httpx.Client) -> int:
    return len(client.get("/v1/jobs?limit=500").json()["jobs"])


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nothing", 404),
        ("GET", "/v1/jobs/not-an-id", 404),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e", 404),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/results", 404),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/results/nothing", 404),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/plots/orbit.gif", 404),
        ("DELETE", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e", 404),
        ("PUT", "/v1/jobs", 405),
        ("POST", "/health/live", 405),
        ("GET", "/problems/nothing", 404),
    ],
)
def test_every_wrong_address_is_a_problem(shared_client: httpx.Client, method: str, path: str, status: int) -> None:
    document = problem(shared_client.request(method, path), status)
    assert document["instance"] == path
    assert set(document) == {"type", "title", "status", "detail", "instance", "errors"}


def test_a_wrong_method_names_the_right_ones(shared_client: httpx.Client) -> None:
    assert shared_client.put("/health/live").headers["allow"] == "GET, HEAD"
    assert shared_client.put("/v1/jobs").headers["allow"] == "GET, HEAD, POST"
    assert (
        shared_client.post("/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e").headers["allow"]
        == "DELETE, GET, HEAD, PATCH"
    )


def test_the_type_of_a_problem_leads_to_its_page(shared_client: httpx.Client) -> None:
    document = shared_client.get("/v1/nothing").json()
    page = shared_client.get(document["type"])
    assert page.status_code == 200
    assert page.json()["title"] == document["title"]
    assert page.json()["status"] == 404


@pytest.mark.parametrize(
    ("path", "value", "pointer"),
    [
        ("span.length_m", -125.88, "/line/span/length_m"),
        ("span.length_m", 0, "/line/span/length_m"),
        ("span.length_m", float("nan"), "/line/span/length_m"),
        ("span.length_m", float("inf"), "/line/span/length_m"),
        ("span.length_m", 1e9, "/line/span/length_m"),
        ("span.length_m", 10**4000, "/line/span/length_m"),
        ("span.sag_m", 1.5, "/line/span"),
        ("ice.segments", [{"from_m": 0, "to_m": 9}, {"from_m": 8, "to_m": 20}], "/line/ice/segments/1"),
        ("devices.0.position_m", 126.0, "/line/devices/0/position_m"),
        ("conductor.colour", "red", "/line/conductor/colour"),
        ("span.length_m", "125.88", "/line/span/length_m"),
    ],
)
def test_bad_input_is_422_with_the_field(shared_client: httpx.Client, path: str, value: Any, pointer: str) -> None:
    body = json.dumps({"line": changed(path, value)}).encode()
    document = problem(post(shared_client, body), 422)
    assert [fault["pointer"] for fault in document["errors"]] == [pointer]
    assert all(fault["code"] and fault["detail"] for fault in document["errors"])


def test_all_faults_come_at_once(shared_client: httpx.Client) -> None:
    line = changed("span.length_m", -1.0, changed("devices.2.to_m", 20.0, changed("tags", {"a": 1})))
    document = problem(shared_client.post("/v1/jobs", json={"line": line, "webhook": "https://x.org"}), 422)
    found = {fault["pointer"] for fault in document["errors"]}
    assert found == {"/line/span/length_m", "/line/devices/2/to_m", "/line/tags/a", "/webhook"}


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{",
        b"null",
        b"[]",
        b'"text"',
        b"\xff\xfe\x00",
        b'{"line": "\xc3("}',
        b"[" * 500_000,
        b'{"line":' * 100_000,
        b'{"line": ' + b"9" * 100_000 + b"}",
        b'{"line": {"span": {"length_m": 1, "length_m": 2}}}',
    ],
)
def test_what_is_no_document_is_422(shared_client: httpx.Client, body: bytes) -> None:
    assert problem(post(shared_client, body), 422)["errors"]


def test_a_document_with_very_many_faults_gets_a_bounded_answer(shared_client: httpx.Client) -> None:
    devices = [{"type": "spacer", "position_m": 1.0, **{f"x{i}": 1 for i in range(60)}} for _ in range(20)]
    body = json.dumps({"line": {**example("c11-twin"), "devices": devices}}).encode()
    answer = post(shared_client, body)
    assert len(problem(answer, 422)["errors"]) == 1000
    assert "more than 1000 faults. Only the first 1000 faults are listed." in answer.json()["detail"]


@pytest.mark.parametrize(
    ("body", "detail"),
    [
        (json.dumps({f"x{i}": 0 for i in range(1001)}), "an object has 1001 names, the first of them 'x0'"),
        (json.dumps([{"x": 0}] * 50_001), "some 50001 names; a document may have at most 50000"),
        ('["' + "\\n" * 500_001 + '"]', "some 500001 escapes; a document may have at most 500000"),
        ("[" + "1," * 200_000 + "1]", "some 200001 values; a document may have at most 200000"),
    ],
)
def test_a_document_whose_names_or_values_alone_would_cost_is_one_fault(
    shared_client: httpx.Client, body: str, detail: str
) -> None:
    (fault,) = problem(post(shared_client, body.encode()), 422)["errors"]
    assert (fault["code"], fault["pointer"]) == ("too_many", "")
    assert detail in fault["detail"]


def test_a_large_document_is_read_and_checked_beside_the_event_loop(
    shared_client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    threads: list[str] = []

    def noted(function: Callable[..., Any]) -> Callable[..., Any]:
        def called(*given: Any) -> Any:
            threads.append(threading.current_thread().name)
            return function(*given)

        return called

    for name in ("parse_json", "validation_problem"):
        monkeypatch.setattr(strict_routes, name, noted(getattr(strict_routes, name)))
    body = json.dumps({"line": {**example("c11-twin"), "devices": [{"type": "nothing"}] * 5000}}).encode()
    problem(post(shared_client, body), 422)
    assert len(threads) == 2
    assert all(name.startswith("AnyIO worker thread") for name in threads), threads


@pytest.mark.parametrize(
    "media_type", [None, "text/plain", "application/xml", "multipart/form-data", "application/jsonx"]
)
def test_another_media_type_is_415(shared_client: httpx.Client, media_type: str | None) -> None:
    headers = {"Content-Type": media_type} if media_type else {}
    answer = shared_client.post("/v1/jobs", content=json.dumps(short_request()), headers=headers)
    problem(answer, 415)
    assert answer.headers["accept-post"] == "application/json"


def test_json_with_a_charset_is_json(shared_client: httpx.Client) -> None:
    headers = {"Content-Type": "application/json; charset=utf-8"}
    assert shared_client.post("/v1/jobs", content=json.dumps(short_request()), headers=headers).status_code == 202


def test_a_body_of_50_mb_is_413(shared_client: httpx.Client) -> None:
    problem(post(shared_client, b" " * 50_000_000), 413)


def test_a_body_of_50_mb_in_pieces_is_413(shared_client: httpx.Client) -> None:
    problem(post(shared_client, (b" " * 65_536 for _ in range(800))), 413)


def test_a_body_announced_too_large_is_413_without_a_byte_of_it(shared_client: httpx.Client) -> None:
    url = shared_client.base_url
    head = f"POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: {10**15}\r\n\r\n"
    with socket.create_connection((url.host, url.port or 80), timeout=10.0) as connection:
        connection.sendall(head.encode())
        assert connection.recv(64).startswith(b"HTTP/1.1 413 ")


def test_a_body_just_within_the_limit_is_taken(shared_client: httpx.Client) -> None:
    body = json.dumps(short_request()).encode()
    assert post(shared_client, body + b" " * (2_000_000 - len(body))).status_code == 202
    problem(post(shared_client, body + b" " * (2_000_001 - len(body))), 413)


def test_a_refused_document_makes_no_job(own_client: httpx.Client) -> None:
    own_client.post("/v1/jobs", json={"line": changed("span.length_m", -1.0)})
    own_client.post("/v1/jobs", json={"line": FULL_LINE, "analysis": {"closure": "published"}})
    assert numbers_of_jobs(own_client) == 0


@pytest.mark.parametrize(
    ("query", "name"),
    [
        ("limit=0", "limit"),
        ("limit=501", "limit"),
        ("limit=many", "limit"),
        ("status=done", "status"),
        ("created_after=yesterday", "created_after"),
        ("created_after=2026-01-01T00:00:00", "created_after"),
        ("created_after=0001-01-01T00:00:00%2B23:59", "created_after"),
        ("created_after=9999-12-31T23:59:59-23:59", "created_after"),
        ("tag=region", "tag"),
        ("tag=region:", "tag"),
        ("tag=a:b&tag=a:c", "tag"),
        ("asset_id=a%00b", "asset_id"),
        ("asset_id=", "asset_id"),
        ("cursor=AAAA", "cursor"),
        ("cursor=%C3%A4", "cursor"),
        ("stats=running", "stats"),
    ],
)
def test_a_wrong_query_parameter_is_400_and_named(shared_client: httpx.Client, query: str, name: str) -> None:
    (fault, *_) = problem(shared_client.get(f"/v1/jobs?{query}"), 400)["errors"]
    assert fault["pointer"].split("/")[:3] == ["", "query", name]


def test_a_database_that_does_not_answer_is_503(tmp_path: Path) -> None:
    own = service.sqlite_settings(tmp_path)
    with service.running(own) as client:
        for file in tmp_path.glob("galloping.sqlite3*"):
            file.unlink()
        (tmp_path / "galloping.sqlite3").mkdir()
        answer = client.get("/v1/jobs")
        problem(answer, 503)
        assert answer.headers["retry-after"] == "5"
        assert "sqlite" not in answer.text.lower()


def test_a_defect_is_500_without_its_traceback(own_client: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "signing_key", lambda _: int("signing-secret"))  # a defect that nobody foresaw
    document = problem(own_client.get("/v1/jobs"), 500)
    assert "signing-secret" not in json.dumps(document)


def test_the_document_of_a_problem_lists_a_thousand_faults_at_most() -> None:
    faults = [Fault("/a", "b", "c")] * 1001
    document = problem_document(ProblemKind.INVALID_DOCUMENT, "So it is.", "/x", faults)
    assert len(document["errors"]) == 1000
    assert document["detail"] == "So it is. Only the first 1000 faults are listed."
    assert document["type"] == "/problems/invalid-document"


@settings(max_examples=60)
@given(st.binary(max_size=200))
def test_no_bytes_are_more_than_a_fault_of_the_client(shared_client: httpx.Client, body: bytes) -> None:
    problem(post(shared_client, body), 422)


@settings(max_examples=60)
@given(st.text(max_size=40), st.text(max_size=40))
def test_no_query_is_more_than_a_fault_of_the_client(shared_client: httpx.Client, name: str, value: str) -> None:
    assert shared_client.get("/v1/jobs", params={"asset_id": value, "cursor": name}).status_code in {200, 400}


@settings(max_examples=60)
@given(st.text(min_size=1, max_size=40).map(lambda text: quote(text, safe="")))
def test_no_path_is_more_than_a_fault_of_the_client(shared_client: httpx.Client, path: str) -> None:
    for address in (f"/v1/jobs/{path}", f"/v1/jobs/{path}/results/{path}", f"/v1/jobs/{path}/plots/{path}.svg"):
        assert shared_client.get(address).status_code in {200, 404, 405}
