import csv
import gzip
import io
import json
from collections.abc import Iterator
from typing import Any

import httpx
import pyarrow.parquet as pq
import pytest
from sqlalchemy import update
from sqlalchemy.orm import Session, sessionmaker

from app.export.formats import PARQUET
from app.jobs import leases
from app.jobs.leases import Failure
from app.main import create_app
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.storage.database import make_engine
from app.tables import FailureKind, PointRow
from tests.app import service
from tests.app.lines import SHORT, changed, close
from tests.app.service import chunks, work_off
from tests.in_process import run_job

TWIN = example("c11-twin")
BAD = changed("span.length_m", -1.0, TWIN)
MIXED = [
    {**TWIN, "reference": "a", "asset_id": "L1"},
    {**BAD, "reference": "b"},
    {**changed("span.length_m", 150.0, TWIN), "reference": "c"},
]


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service on either kind of database, with small chunks."""
    with service.running(settings.model_copy(update={"most_chunk_lines": 2})) as running:
        yield running


def post(client: httpx.Client, lines: list[Any], query: str = "") -> httpx.Response:
    return client.post(f"/v1/batches{query}", json={"lines": lines, "analysis": SHORT})


def accepted(client: httpx.Client, lines: list[Any]) -> str:
    answer = post(client, lines)
    assert answer.status_code == 202, answer.text
    return str(answer.headers["location"])


def ndjson(client: httpx.Client, address: str) -> list[dict[str, Any]]:
    answer = client.get(address)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"].startswith("application/x-ndjson")
    return [json.loads(text) for text in answer.text.splitlines()]


def test_a_mixed_batch_runs_its_valid_lines_and_tells_of_the_others(client: httpx.Client, settings: Settings) -> None:
    answer = post(client, MIXED)
    status = answer.json()
    assert (answer.status_code, answer.headers["location"]) == (202, f"/v1/batches/{status['id']}")
    assert int(answer.headers["retry-after"]) >= 1
    assert (status["status"], status["progress"]) == ("accepted", 0.0)
    assert status["lines"] == {
        "total": 3, "accepted": 2, "running": 0, "successful": 0, "failed": 0, "dismissed": 0, "rejected": 1,
        "reused": 0,
    }  # fmt: skip
    (fault,) = status["errors"]
    assert (fault["number"], fault["reference"], fault["pointer"]) == (2, "b", "/span/length_m")
    assert client.get(f"{answer.headers['location']}/errors").json() == {"errors": [fault]}
    status = work_off(client, settings, answer.headers["location"])
    assert (status["status"], status["progress"], status["lines"]["successful"]) == ("successful", 1.0, 2)
    assert status["created_at"] <= status["started_at"] <= status["finished_at"]
    assert {client.get(link["href"]).status_code for link in status["links"]} == {200}


def test_numbers_are_those_of_a_single_job(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, MIXED)
    work_off(client, settings, address)
    first, second, third = ndjson(client, f"{address}/results")
    assert [(o["number"], o["reference"], o["asset_id"], o["status"]) for o in (first, second, third)] == [
        (1, "a", "L1", "successful"),
        (2, "b", None, "rejected"),
        (3, "c", None, "successful"),
    ]
    assert "/span/length_m" in second["failure"]["detail"]
    single = service.finished(client, settings, {"line": changed("span.length_m", 150.0, TWIN), "analysis": SHORT})
    expected = client.get(f"{single}/results").json()
    assert close(third["static"], expected["static"]) and third["den_hartog"] == expected["den_hartog"]
    for table in ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations"):
        assert [pair for pair in zip(third[table], expected[table], strict=True) if not close(*pair)] == []
    assert third["limit_cycles"] and third["critical_wind_speeds"]


def test_tables_hold_the_rows_of_all_lines(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, MIXED)
    work_off(client, settings, address)
    whole = ndjson(client, f"{address}/results")
    for name in ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations"):
        expected = [
            {**{key: line[key] for key in ("number", "reference", "asset_id")}, **row}
            for line in whole
            for row in line[name]
        ]
        assert ndjson(client, f"{address}/results?table={name.replace('_', '-')}") == expected


def test_csv_has_labels_and_the_summary_every_line(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, [{**TWIN, "reference": "=1+1"}, BAD])
    work_off(client, settings, address)
    (cycle,) = [o for o in ndjson(client, f"{address}/results") if o["number"] == 1]
    answer = client.get(f"{address}/results", headers={"Accept": "text/csv"})
    assert answer.headers["content-type"].startswith("text/csv")
    first, second = csv.DictReader(io.StringIO(answer.text))
    assert (first["number"], first["reference"], first["status"]) == ("1", "'=1+1", "successful")
    assert float(first["sag_m"]) == cycle["static"]["sag_m"]
    lasting = [row["vertical_m"] for row in cycle["limit_cycles"] if row["stability"] == "stable"]
    assert float(first["largest_vertical_m"]) == max(lasting)
    lowest = min(row["wind_speed_m_per_s"] for row in cycle["critical_wind_speeds"])
    assert float(first["lowest_critical_wind_speed_m_per_s"]) == lowest
    assert (second["status"], second["sag_m"]) == ("rejected", "")
    rows = list(csv.DictReader(io.StringIO(client.get(f"{address}/results?table=frequencies&format=csv").text)))
    whole = client.get(f"{address}/results?table=frequencies", headers={"Accept": "application/json"}).json()
    lines = client.get(f"{address}/results?table=frequencies&format=ndjson").text.splitlines()
    assert whole == {"frequencies": [json.loads(line) for line in lines]}
    assert [row["number"] for row in rows] == ["1"] * len(cycle["frequencies"])


def test_the_summary_has_name_and_verdict_of_every_line(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, MIXED)
    work_off(client, settings, address)
    whole = [line for line in ndjson(client, f"{address}/results") if line["status"] == "successful"]
    first, rejected, third = ndjson(client, f"{address}/results?table=summary")
    for row, line in zip((first, third), whole, strict=True):
        (verdict,) = line["verdict"]
        assert {name: row[name] for name in verdict} == verdict
        assert row["sentence"] and row["name"] == TWIN["name"]
    assert (rejected["name"], rejected["gallops"], rejected["sentence"]) == (None, None, None)
    assert first["onset_m_per_s"] != third["onset_m_per_s"]


def test_a_verdict_stored_before_it_had_a_column_is_found(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, [TWIN])
    work_off(client, settings, address)
    before = ndjson(client, f"{address}/results?table=summary")
    engine = make_engine(settings)
    with engine.begin() as connection:
        connection.execute(update(PointRow).values(verdict=None))
    engine.dispose()
    assert ndjson(client, f"{address}/results?table=summary") == before


def test_excel_opens_the_summary_in_any_country(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, MIXED)
    work_off(client, settings, address)
    plain = client.get(f"{address}/results?format=csv").content.decode()
    assert client.get(f"{address}/results?format=csv&dialect=excel").content.decode("utf-8") == "\ufeff" + plain
    european = client.get(f"{address}/results?format=csv&dialect=excel_semicolon").content.decode("utf-8-sig")
    rows = list(csv.DictReader(io.StringIO(european), delimiter=";"))
    for row, usual in zip(rows, csv.DictReader(io.StringIO(plain)), strict=True):
        assert row["sag_m"].replace(",", ".") == usual["sag_m"] and "." not in row["onset_m_per_s"]
        assert row["sentence"] == usual["sentence"]
    assert client.get(f"{address}/results?format=ndjson&dialect=excel").status_code == 400


def test_parquet_says_the_same_as_ndjson(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, MIXED)
    work_off(client, settings, address)
    for table in ("summary", "limit-cycles"):
        answer = client.get(f"{address}/results?table={table}", headers={"Accept": PARQUET})
        assert answer.headers["content-type"] == PARQUET
        found = pq.read_table(io.BytesIO(answer.content))
        assert found.to_pylist() == ndjson(client, f"{address}/results?table={table}")
    assert found.schema.field("vertical_m").metadata[b"unit"] == b"m"


def test_results_wait_for_the_end_unless_partial_ones_are_asked_for(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, [TWIN, TWIN, TWIN])
    run_job(settings, chunks(client, address)[-1])
    answer = client.get(f"{address}/results")
    assert (answer.status_code, answer.json()["links"][0]["href"]) == (409, address)
    states = [line["status"] for line in ndjson(client, f"{address}/results?partial=true")]
    assert sorted(states) in (["accepted", "accepted", "successful"], ["accepted", "successful", "successful"])


def test_forms_that_there_are_not_are_refused(client: httpx.Client) -> None:
    address = accepted(client, [TWIN])
    assert client.get(f"{address}/results?partial=true", headers={"Accept": "text/html"}).status_code == 406
    assert client.get(f"{address}/results?partial=true&format=ods").status_code == 400
    assert client.get(f"{address}/results?table=orbits").status_code == 400
    assert client.post("/v1/batches", content=b"x", headers={"Content-Type": "text/plain"}).status_code == 415
    brotli = {"Content-Type": "text/csv", "Content-Encoding": "br"}
    assert client.post("/v1/batches", content=b"x", headers=brotli).status_code == 415


def test_ndjson_and_csv_say_the_same_as_json(client: httpx.Client, settings: Settings) -> None:
    lines = "".join(json.dumps(line) + "\n" for line in ({"analysis": SHORT}, *MIXED))
    packed = {"Content-Type": "application/x-ndjson", "Content-Encoding": "gzip"}
    post_body = create_app(settings).openapi()["paths"]["/v1/batches"]["post"]["requestBody"]["content"]
    answers = [
        client.post("/v1/batches", content=gzip.compress(lines.encode()), headers=packed),
        client.post(
            "/v1/batches",
            params={"analysis": json.dumps(SHORT)},
            content=post_body["text/csv"]["example"].encode(),
            headers={"Content-Type": "text/csv"},
        ),
        post(client, [TWIN]),
    ]
    assert [answer.status_code for answer in answers] == [202, 202, 202], [answer.text for answer in answers]
    for answer in answers:
        work_off(client, settings, answer.headers["location"])
    packed_lines, rows, single = (ndjson(client, f"{answer.headers['location']}/results") for answer in answers)
    assert [line["status"] for line in packed_lines] == ["successful", "rejected", "successful"]
    assert (rows[0]["reference"], rows[0]["asset_id"]) == ("row-1", "L204-S017")
    pairs = zip(rows[0]["limit_cycles"], single[0]["limit_cycles"], strict=True)
    assert [pair for pair in pairs if not close(*pair)] == []


def test_an_atomic_batch_with_a_fault_is_refused_with_all_faults(client: httpx.Client) -> None:
    answer = post(client, [TWIN, BAD, {**TWIN, "colour": "red"}], "?atomic=true")
    assert answer.status_code == 422
    assert [e["pointer"] for e in answer.json()["errors"]] == ["/lines/1/span/length_m", "/lines/2/colour"]
    assert client.get("/v1/batches").json()["batches"] == []
    assert post(client, [TWIN], "?atomic=true").status_code == 202


@pytest.mark.parametrize(
    "body",
    [{"lines": []}, {}, [], {"lines": [TWIN], "webhook": "https://x"}, {"lines": [TWIN], "analysis": {"x": 1}}],
)
def test_bodies_at_fault_are_refused(client: httpx.Client, body: object) -> None:
    answer = client.post("/v1/batches", json=body)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert answer.json()["errors"]


def test_limits_on_bodies_are_those_of_batches(own_settings: Settings) -> None:
    tight = own_settings.model_copy(update={"max_body_bytes": 3000, "max_batch_bytes": 6000})
    header = {"Content-Type": "application/x-ndjson"}
    text = json.dumps({"analysis": SHORT}) + "\n" + json.dumps(TWIN) + "\n"
    with service.running(tight) as client:
        assert client.post("/v1/batches", content=text + "\n" * 4000, headers=header).status_code == 202
        assert client.post("/v1/batches", content=text + "\n" * 9000, headers=header).status_code == 413
        bomb = gzip.compress((text + "\n" * 1_000_000).encode())
        assert len(bomb) < tight.max_batch_bytes
        packed = {**header, "Content-Encoding": "gzip"}
        assert client.post("/v1/batches", content=bomb, headers=packed).status_code == 413
        assert post(client, [TWIN] * 6).status_code == 413
        assert len(client.get("/v1/batches").json()["batches"]) == 1


def test_a_waiting_batch_is_cancelled_at_once_and_then_removed(client: httpx.Client) -> None:
    address = accepted(client, [TWIN] * 3)
    assert client.delete(f"{address}?if_ended=true").status_code == 409
    answer = client.delete(address)
    assert (answer.status_code, answer.json()["status"], answer.json()["lines"]["dismissed"]) == (200, "dismissed", 3)
    kept = client.post(f"{address}/cancel")
    assert (kept.status_code, kept.json()["status"]) == (200, "dismissed")
    assert client.delete(address).status_code == 204
    assert [client.get(address + end).status_code for end in ("", "/results", "/errors")] == [404, 404, 404]
    assert client.delete(address).status_code == 404


def test_a_running_batch_is_asked_to_stop(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    address = accepted(client, [TWIN] * 3)
    with sessions.begin() as session:
        leases.claim(session, chunks(client, address)[0], "test", 30.0)
    answer = client.delete(address)
    assert (answer.status_code, answer.json()["status"]) == (202, "running")


def test_failed_lines_are_resubmitted_and_run(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    address = accepted(client, [{**TWIN, "reference": f"r{n}"} for n in range(1, 5)])
    lost = chunks(client, address)[0]
    with sessions.begin() as session:
        held = leases.claim(session, lost, "test", 30.0)
        assert held is not None
        leases.fail(session, held, Failure(FailureKind.WORKER_LOST, "Lost."))
    status = work_off(client, settings, address)
    assert (status["lines"]["successful"], status["lines"]["failed"]) == (2, 2)
    before = ndjson(client, f"{address}/results")
    assert [line["failure"] for line in before if line["failure"]] == [{"kind": "worker_lost", "detail": "Lost."}] * 2
    answer = client.post(f"{address}/resubmit")
    assert (answer.status_code, answer.json()["lines"]["accepted"], answer.json()["status"]) == (202, 2, "running")
    assert work_off(client, settings, address)["lines"]["successful"] == 4
    after = ndjson(client, f"{address}/results")
    assert [(line["number"], line["reference"]) for line in after] == [(n, f"r{n}") for n in range(1, 5)]
    assert {len(line["limit_cycles"]) for line in after} == {len(after[0]["limit_cycles"])}
    assert client.post(f"{address}/resubmit").json()["lines"]["successful"] == 4


def test_batches_are_listed_newest_first(client: httpx.Client) -> None:
    made = [accepted(client, [TWIN]) for _ in range(3)]
    first = client.get("/v1/batches?limit=2").json()
    second = client.get(first["next"]).json()
    assert [f"/v1/batches/{b['id']}" for b in first["batches"] + second["batches"]] == made[::-1]
    assert second["next"] is None
    assert client.get("/v1/jobs").json()["jobs"] == []


def test_a_chunk_answers_like_a_job_whose_points_are_lines(client: httpx.Client, settings: Settings) -> None:
    address = accepted(client, [TWIN])
    (chunk,) = chunks(client, address)
    work_off(client, settings, address)
    rows = client.get(f"/v1/jobs/{chunk}/results/frequencies?format=csv").text.splitlines()
    assert rows[0].startswith("number,model,") and rows[1].startswith("1,hybrid,")
    assert client.get(f"/v1/jobs/{chunk}/results").json()["static"][0]["number"] == 1
