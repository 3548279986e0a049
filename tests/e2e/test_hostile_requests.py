"""What an attacker sends: heads that two parsers read differently, ways out of folders, names that break headers."""

import socket
from collections.abc import Iterator

import httpx
import pytest

from tests.app import service
from tests.app.pages.reading import BROWSER, send
from tests.documents import short_request

HOST = "Host: 127.0.0.1\r\n"
POST = f"POST /v1/jobs HTTP/1.1\r\n{HOST}Content-Type: application/json\r\n"
GET = f"GET /v1/jobs HTTP/1.1\r\n{HOST}"
AMBIGUOUS = {
    "two lengths": f"{POST}Content-Length: 2\r\nContent-Length: 40\r\n\r\n{{}}{GET}\r\n",
    "a length beside chunks": f"{POST}Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n{GET}\r\n",
    "an unknown encoding": f"{POST}Transfer-Encoding: xchunked\r\n\r\n0\r\n\r\n",
    "a signed length": f"{POST}Content-Length: +2\r\n\r\n{{}}",
    "a chunk beyond all numbers": f"{POST}Transfer-Encoding: chunked\r\n\r\nffffffffffffffff1\r\n{{}}",
    "a blank before a colon": f"{POST}Content-Length : 2\r\n\r\n{{}}",
    "two hosts": f"{GET}Host: evil.example\r\n\r\n",
    "two hosts, the own one last": f"GET /v1/jobs HTTP/1.1\r\nHost: evil.example\r\n{HOST}\r\n",
    "a folded field": f"{GET}X: a\r\n b\r\n\r\n",
    "a zero in a field": f"{GET}X: a\0b\r\n\r\n",
    "lines without carriage return": GET.replace("\r", "") + "\n",
}
WAYS_OUT = (
    "/pages/assets/../../../../etc/passwd",
    "/pages/assets/own/%2e%2e/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
    "/pages/assets/own/..%2f..%2f..%2f..%2fetc%2fpasswd",
    "/pages/assets/own/..%5c..%5csettings.py",
    "/pages/assets/own/..%252f..%252fmain.py",
    "/pages/assets/own/%00",
    "/pages/assets/own//etc/passwd",
)


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with service.running(service.sqlite_settings(tmp_path_factory.mktemp("hostile"))) as client:
        yield client


def exchanged(client: httpx.Client, text: str) -> bytes:
    """Send bytes as they are, and return all that comes until the server closes the connection."""
    found = b""
    with socket.create_connection((client.base_url.host, client.base_url.port or 80), timeout=30.0) as connection:
        connection.sendall(text.encode("latin-1"))
        while piece := connection.recv(65_536):
            found += piece
    return found


@pytest.mark.parametrize("name", AMBIGUOUS)
def test_heads_that_can_be_read_in_two_ways_are_refused_once(client: httpx.Client, name: str) -> None:
    answer = exchanged(client, AMBIGUOUS[name])
    assert answer.startswith(b"HTTP/1.1 400 ")
    assert answer.count(b"HTTP/1.1 ") == 1  # nothing behind it is taken for a request


def test_requests_in_a_row_are_answered_in_their_order(client: httpx.Client) -> None:
    last = f"GET /problems/not-found HTTP/1.1\r\n{HOST}Connection: close\r\n\r\n"
    answer = exchanged(client, f"GET /health/live HTTP/1.1\r\n{HOST}\r\n{GET}\r\n{last}")
    assert answer.count(b"HTTP/1.1 200 ") == 3
    assert answer.index(b'"status":"ok"') < answer.index(b'"jobs"') < answer.index(b'"slug"')


@pytest.mark.parametrize("path", WAYS_OUT)
def test_no_path_leads_out_of_the_folder_of_files(client: httpx.Client, path: str) -> None:
    answer = exchanged(client, f"GET {path} HTTP/1.1\r\n{HOST}Connection: close\r\n\r\n")
    assert answer.startswith(b"HTTP/1.1 404 ")
    assert b"root:" not in answer


@pytest.mark.parametrize("path", ["//v1/jobs", "/docs/../v1/jobs", "/health/%2e%2e/v1/jobs", "/v1/./jobs", "/V1/jobs"])
def test_no_spelling_of_a_path_passes_the_gate(client: httpx.Client, path: str) -> None:
    answer = exchanged(client, f"GET {path} HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n")
    assert answer[9:12] in {b"401", b"404"}


def test_names_and_ids_add_no_header_and_no_markup(client: httpx.Client) -> None:
    line = short_request()["line"]
    broken = {**short_request(), "line": {**line, "name": "a\r\nSet-Cookie: x=y"}}
    assert client.post("/v1/jobs", json=broken).status_code == 422
    document = {**short_request(), "line": {**line, "name": 'a"; filename=../../é<script>alert(1)</script>'}}
    job = client.post("/v1/jobs", json=document).raise_for_status().json()["id"]
    for path in (f"/pages/jobs/{job}", "/pages/jobs", "/"):
        answer = client.get(path, headers=BROWSER)
        assert answer.status_code == 200
        assert "<script>alert" not in answer.text, path
    told = client.get("/health/live", headers={"X-Request-ID": "a<b>;\tc"}).headers["x-request-id"]
    assert "<" not in told


@pytest.mark.parametrize("back", ["//evil.example", "/\\evil.example", "https://evil.example", "/\tevil", "a:b"])
def test_forms_lead_nowhere_else(client: httpx.Client, back: str) -> None:
    page = client.get("/pages/sign-in", params={"back": back}, headers=BROWSER)
    assert 'name="back" value="/"' in page.text
    answer = send(client, "/pages/preferences", {"theme": "dark", "back": back})
    assert (answer.status_code, answer.headers["location"]) == (303, "/")


def test_cookies_are_for_this_site_only(client: httpx.Client) -> None:
    kept = send(client, "/pages/preferences", {"theme": "dark"})
    (cookie,) = kept.headers.get_list("set-cookie")
    assert "samesite=lax" in cookie.lower() and "httponly" in cookie.lower()
