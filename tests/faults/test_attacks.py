"""What a stranger may send on purpose. Those that are tested beside the part that stands against them are not here.

docs/reliability.md has the whole list.
"""

import csv
import gzip
import io
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from sqlalchemy import event, inspect, select
from sqlalchemy.orm import Session

from app.http.problems import MEDIA_TYPE
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from app.tables import Base, Job
from tests.app import service
from tests.documents import short_request
from tests.in_process import run_job

NDJSON = {"Content-Type": "application/x-ndjson"}
ANALYSIS = short_request()["analysis"]
LINE = short_request()["line"]
SQL = [
    "'; DROP TABLE jobs; --",
    "' OR '1'='1",
    "%",
    "_",
    "\\",
    "1); DELETE FROM jobs WHERE (1=1",
    "$1 ? :name %s",
]
FORMULAS = ["=cmd|' /C calc'!A0", "+1+1", "-2+3", "@SUM(A1)", "\uff1d1+1"]
TRAVERSALS = [
    "../../etc/passwd",
    "..%2f..%2fetc%2fpasswd",
    "..\\..\\windows",
    "/etc/passwd",
    "file:///etc/passwd",
    "%00",
]


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Give settings of a service with small limits."""
    limits: dict[str, Any] = {
        "max_body_bytes": 2_000_000,
        "max_batch_bytes": 5_000_000,
        "max_batch_line_bytes": 100_000,
    }
    return service.sqlite_settings(tmp_path_factory.mktemp("attacks"), **limits)


@pytest.fixture(scope="module")
def client(own: Settings) -> Iterator[httpx.Client]:
    """Give a client of that service."""
    with service.running(own) as running:
        yield running


def batch(client: httpx.Client, *lines: Any) -> httpx.Response:
    return client.post("/v1/batches", json={"lines": list(lines), "analysis": ANALYSIS})


def ndjson(client: httpx.Client, body: bytes, **headers: str) -> httpx.Response:
    return client.post("/v1/batches", content=body, headers={**NDJSON, **headers})


def finished_batch(client: httpx.Client, own: Settings, *lines: Any) -> str:
    identity: str = batch(client, *lines).raise_for_status().json()["id"]
    engine = make_engine(own)
    with session_factory(engine)() as session:
        chunks = session.scalars(select(Job.id).where(Job.batch_id == UUID(identity))).all()
    engine.dispose()
    for chunk in chunks:
        run_job(own, chunk)
    return f"/v1/batches/{identity}"


def refused(answer: httpx.Response, status: int) -> dict[str, Any]:
    assert (answer.status_code, answer.headers["content-type"]) == (status, MEDIA_TYPE), answer.text[:500]
    document: dict[str, Any] = answer.json()
    return document


@pytest.mark.parametrize("text", SQL)
def test_sql_in_a_label_is_a_label(client: httpx.Client, own: Settings, text: str) -> None:
    line = {**LINE, "name": text, "asset_id": text, "tags": {"region": text}}
    job = service.submit(client, {"line": line, "analysis": ANALYSIS})
    assert (job["name"], job["asset_id"], job["tags"]) == (text, text, {"region": text})
    for query in ({"asset_id": text}, {"tag": f"region:{text}"}):
        found = client.get("/v1/jobs", params=query).raise_for_status().json()["jobs"]
        assert {other["asset_id"] for other in found} == {text}
    address = finished_batch(client, own, {**line, "reference": text})
    (row,) = map(json.loads, client.get(f"{address}/results?format=ndjson&table=summary").text.splitlines())
    assert (row["reference"], row["asset_id"]) == (text, text)
    engine = make_engine(own)
    assert set(inspect(engine).get_table_names()) >= set(Base.metadata.tables)
    engine.dispose()


@pytest.mark.parametrize("text", SQL)
def test_sql_in_a_query_finds_nothing_or_is_refused(client: httpx.Client, text: str) -> None:
    assert client.get("/v1/conductors", params={"search": text}).json()["conductors"] == []
    refused(client.get("/v1/jobs", params={"cursor": text}), 400)
    refused(client.get("/v1/batches", params={"cursor": text}), 400)
    refused(client.get("/v1/jobs", params={"batch_id": text}), 400)
    refused(client.get(f"/v1/jobs/{text.replace('%', '%25').replace('?', '%3F')}"), 404)


@pytest.mark.parametrize("field", ["name", "asset_id", "reference"])
@pytest.mark.parametrize("break_", ["\r\n", "\n", "\r", "\x00", "\x1b"])
def test_no_line_break_gets_into_what_could_be_a_header(client: httpx.Client, field: str, break_: str) -> None:
    document = refused(batch(client, {**LINE, field: f"x{break_}Set-Cookie: a=b"}), 422)
    assert [fault["pointer"] for fault in document["errors"]] == [f"/lines/0/{field}"]


def test_the_address_of_the_next_page_holds_no_other_address(client: httpx.Client) -> None:
    label = "x&cursor=y#z?limit=1"
    for _ in range(2):
        service.submit(client, {"line": {**LINE, "asset_id": label}, "analysis": ANALYSIS})
    page = client.get("/v1/jobs", params={"asset_id": label, "limit": 1}, headers={"X-Forwarded-Host": "evil.example"})
    if page.status_code == 401:  # a proxy's header closes a service without keys
        page = client.get("/v1/jobs", params={"asset_id": label, "limit": 1})
    following = page.raise_for_status().json()["next"]
    assert following.startswith("/v1/jobs?")
    assert [job["asset_id"] for job in client.get(following).json()["jobs"]] == [label]


def test_exports_of_a_batch_hold_no_formula(client: httpx.Client, own: Settings) -> None:
    lines = [{**LINE, "reference": text, "asset_id": text, "name": text} for text in FORMULAS]
    address = finished_batch(client, own, *lines)
    for table in ("summary", "limit-cycles", "critical-wind-speeds", "frequencies"):
        text = client.get(f"{address}/results", params={"format": "csv", "table": table}).raise_for_status().text
        rows = list(csv.DictReader(io.StringIO(text, newline="")))
        assert {row["reference"] for row in rows} == {f"'{formula}" for formula in FORMULAS}
        words = [cell for row in rows for cell in row.values() if not is_number(cell)]
        assert not [cell for cell in words if cell.startswith(tuple("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20"))]


@contextmanager
def asked_database(own: Settings, statements: list[tuple[str, Any]]) -> Iterator[Session]:
    """Give a session on a migrated database that is undone, and note what it asks."""
    migrate(own)
    engine = make_engine(own)

    def note(_: Any, __: Any, statement: str, parameters: Any, *___: Any) -> None:
        statements.append((statement, parameters))

    event.listen(engine, "before_cursor_execute", note)
    with session_factory(engine)() as session:
        yield session
    engine.dispose()


def is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize(
    "name", ["</text><script>alert(1)</script>", "&xxe;]]>", r"$\frac{$", "\u202e\ufeff\U0001f4a5"]
)
def test_a_name_is_only_text_in_a_picture(client: httpx.Client, own: Settings, name: str) -> None:
    address = service.finished(client, own, {"line": {**LINE, "name": name}, "analysis": ANALYSIS})
    for picture in ("amplitude", "orbit", "modes", "study"):
        drawn = client.get(f"{address}/plots/{picture}.svg")
        assert drawn.status_code == 200, picture
        assert "<script" not in drawn.text
        assert "script-src" not in drawn.headers["content-security-policy"]


@pytest.mark.parametrize("text", TRAVERSALS)
def test_no_address_leads_to_a_file(client: httpx.Client, own: Settings, text: str) -> None:
    secret = own.data_dir / "signing-secret"
    client.get("/v1/jobs?limit=1")  # makes the secret
    job = service.finished(client, own)
    for place in ("/", "/docs/", "/problems/", f"{job}/plots/", f"{job}/results/", "/v1/conductors/", "/v1/batches/"):
        for suffix in ("", ".svg"):
            answer = client.get(f"{place}{text}{suffix}")
            assert answer.status_code in {400, 404, 405}, answer.url
            assert "root:" not in answer.text
            assert secret.read_text() not in answer.text


def test_a_gzip_bomb_is_413(client: httpx.Client) -> None:
    bomb = gzip.compress(json.dumps({"analysis": ANALYSIS}).encode() + b"\n" + b" " * 200_000_000)
    assert len(bomb) < 250_000
    refused(ndjson(client, bomb, **{"Content-Encoding": "gzip"}), 413)
    lines = gzip.compress(json.dumps({"analysis": ANALYSIS}).encode() + b"\n" * 200_000_000)
    refused(ndjson(client, lines, **{"Content-Encoding": "gzip"}), 413)


def test_a_bomb_within_a_bomb_is_not_opened(client: httpx.Client) -> None:
    twice = gzip.compress(gzip.compress(b" " * 10_000_000))
    refused(ndjson(client, twice, **{"Content-Encoding": "gzip"}), 422)
    refused(ndjson(client, twice, **{"Content-Encoding": "gzip, gzip"}), 415)
    refused(ndjson(client, b"", **{"Content-Encoding": "br"}), 415)


@pytest.mark.parametrize(("encoding", "status"), [("gzip", 415), ("GZIP, gzip", 415), ("identity", 422)])
def test_a_compressed_job_is_no_document(client: httpx.Client, encoding: str, status: int) -> None:
    body = gzip.compress(json.dumps(short_request()).encode())
    headers = {"Content-Type": "application/json", "Content-Encoding": encoding}
    refused(client.post("/v1/jobs", content=body, headers=headers), status)


BAD_TEXTS = {
    "deep list": "[" * 40_000,
    "deep object": '{"a":' * 15_000,
    "deep and whole": "[" * 30_000 + "]" * 30_000,
    "huge number": '{"span": ' + "9" * 90_000 + "}",
    "huge exponent": '{"span": {"length_m": 1e999999}}',
    "NaN": '{"span": {"length_m": NaN}}',
    "infinity": '{"span": {"length_m": -Infinity}}',
    "a name twice": '{"span": 1, "span": 2}',
    "a hidden name twice": '{"span": 1, "sp\\u0061n": 2}',
    "half a surrogate": '{"name": "\\ud800"}',
    "prototype": '{"__proto__": {"x": 1}, "constructor": 1}',
    "many names": json.dumps({str(number): 0 for number in range(7000)}),
}


@pytest.mark.parametrize("text", BAD_TEXTS.values(), ids=BAD_TEXTS)
def test_a_line_made_to_hurt_is_rejected_and_the_others_run(client: httpx.Client, text: str) -> None:
    body = "\n".join([json.dumps({"analysis": ANALYSIS}), text, json.dumps(LINE)]).encode()
    answer = ndjson(client, body)
    assert answer.status_code == 202, answer.text[:300]
    assert answer.json()["lines"]["rejected"] == 1
    refused(client.post("/v1/jobs", content=text, headers={"Content-Type": "application/json"}), 422)
    refused(client.post("/v1/batches", content=text, headers={"Content-Type": "application/json"}), 422)
    refused(client.post("/v1/aerodynamics/fit", content=text, headers={"Content-Type": "application/json"}), 422)


def test_a_csv_made_to_hurt_is_refused(client: httpx.Client) -> None:
    headers = {"Content-Type": "text/csv"}
    for body in (b"," * 90_000, b'"' + b"x" * 90_000, b"a" * 200_000, b"span.length_m\n" + b'"' * 99_999, b"\x00,\x00"):
        assert client.post("/v1/batches", content=body, headers=headers).status_code in {413, 422}, body[:20]


def test_a_cursor_of_one_list_that_was_changed_opens_no_other(client: httpx.Client) -> None:
    for _ in range(2):
        service.submit(client)
    cursor = httpx.URL(client.get("/v1/jobs?limit=1").json()["next"]).params["cursor"]
    for place in range(0, len(cursor), 3):
        other = "A" if cursor[place] != "A" else "B"
        refused(client.get("/v1/jobs", params={"cursor": cursor[:place] + other + cursor[place + 1 :]}), 400)
    for changed in (cursor[:-4], cursor + cursor, cursor.swapcase(), cursor[::-1]):
        refused(client.get("/v1/jobs", params={"cursor": changed}), 400)
    identity = batch(client, LINE).raise_for_status().json()["id"]
    ranking = client.get(f"/v1/batches/{identity}/ranking", params={"partial": True, "cursor": cursor})
    refused(ranking, 400)


def test_a_key_is_looked_up_in_the_same_way_however_near_it_is(tmp_path: Path) -> None:
    statements: list[tuple[str, Any]] = []
    with asked_database(service.sqlite_settings(tmp_path), statements) as session:
        _, good = keys.create(session, "acme", tuple(Scope), None, None)
        session.flush()
        for text in (good[:-1] + "x", "galloping_" + "0" * 48, "", "é" * 5000):
            statements.clear()
            assert keys.look_up(session, keys.digest_of(text)) == (None, False)
            ((statement, parameters),) = statements
            assert "WHERE api_keys.digest = ?" in statement
            assert parameters == (keys.digest_of(text),)  # nothing of the text itself is ever compared
