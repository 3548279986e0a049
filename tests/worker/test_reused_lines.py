"""Lines of batches whose results are stored already, and jobs that find them, by the API and a worker's execution."""

import json
from collections.abc import Iterator
from typing import Any
from uuid import UUID

import httpx
import pytest
from sqlalchemy import event, select, update
from sqlalchemy.orm import Session, sessionmaker

from app import convert
from app.convert import ENGINE_VERSION
from app.jobs import reuse
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import LOCAL, Scope
from app.storage import stored_results
from app.storage.stored_results import CorruptResult
from app.tables import PointRow
from tests.app import service
from tests.app.known_documents import CONTRACT
from tests.app.lines import SHORT, changed
from tests.documents import STRANGER
from tests.servers import wait_until

TWIN = example("c11-twin")
KNOWN = {**CONTRACT, "phases": CONTRACT["phases"][:1]}
LINES = [{**changed("span.length_m", 100.0 + number, TWIN), "reference": f"r{number}"} for number in range(4)]


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service on either kind of database."""
    with service.running(settings) as running:
        yield running


def finished(client: httpx.Client, settings: Settings, lines: list[dict[str, Any]], **changes: Any) -> dict[str, Any]:
    """Post a batch, work it off in this process, and return its status document."""
    headers = {"Cache-Control": "no-cache"} if changes.pop("anew", False) else {}
    body = {"lines": lines, "analysis": {**SHORT, **changes}}
    address = client.post("/v1/batches", json=body, headers=headers).headers["location"]
    found = service.work_off(client, settings, address)
    assert found["status"] == "successful"
    return found


def told(client: httpx.Client, batch: dict[str, Any]) -> list[dict[str, Any]]:
    """Return everything that is told of the lines, without what is theirs alone."""
    text = client.get(f"/v1/batches/{batch['id']}/results?format=ndjson").text
    return [json.loads(line) for line in text.splitlines()]


def test_equal_lines_are_not_computed_again(client: httpx.Client, settings: Settings) -> None:
    first = finished(client, settings, LINES)
    assert (first["lines"]["successful"], first["lines"]["reused"]) == (4, 0)
    labelled = [{**line, "name": "other", "asset_id": f"A{n}", "tags": {"a": "b"}} for n, line in enumerate(LINES)]
    again = finished(client, settings, [*labelled[::-1], changed("span.length_m", 90.0, TWIN)])
    assert (again["lines"]["successful"], again["lines"]["reused"]) == (5, 4)
    before, after = told(client, first), told(client, again)
    own = {"number", "reference", "asset_id"}
    for one, other in zip(before, after[3::-1], strict=True):
        assert {k: v for k, v in one.items() if k not in own} == {k: v for k, v in other.items() if k not in own}
    assert [(line["number"], line["reference"]) for line in after[:2]] == [(1, "r3"), (2, "r2")]


def test_another_analysis_is_computed_and_so_is_what_is_asked_anew(client: httpx.Client, settings: Settings) -> None:
    finished(client, settings, LINES)
    assert finished(client, settings, LINES, loops=[2])["lines"]["reused"] == 0
    assert finished(client, settings, LINES, anew=True)["lines"]["reused"] == 0


def test_another_version_is_computed(client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]) -> None:
    finished(client, settings, LINES)
    with sessions.begin() as session:
        session.execute(update(PointRow).where(PointRow.point <= 3).values(engine_version="0.0.1"))
    assert finished(client, settings, LINES)["lines"]["reused"] == 1


def test_another_owner_is_told_nothing(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    finished(client, settings, LINES)
    with sessions.begin() as session:
        headers = [
            {"Authorization": f"Bearer {keys.create(session, name, tuple(Scope), None, None)[1]}"}
            for name in (LOCAL.owner, STRANGER.owner)
        ]
    for header, reused in zip(headers, (4, 0), strict=True):
        client.headers.update(header)
        wait_until(lambda: client.get("/v1/jobs").status_code == 200, what="the key")
        assert finished(client, settings, LINES)["lines"]["reused"] == reused


def test_reused_lines_outlive_the_batch_that_they_come_from(client: httpx.Client, settings: Settings) -> None:
    first = finished(client, settings, LINES)
    second = finished(client, settings, LINES)
    assert client.delete(f"/v1/batches/{first['id']}").status_code == 204
    assert second["lines"]["reused"] == 4
    assert [line["status"] for line in told(client, second)] == ["successful"] * 4
    third = finished(client, settings, LINES)
    assert third["lines"]["reused"] == 4


def test_of_many_copies_one_is_read(client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]) -> None:
    for _ in range(4):
        batch = finished(client, settings, LINES)
    assert batch["lines"]["reused"] == 4
    read: list[object] = []
    with sessions() as session:
        hashes = {row.point: row.input_hash or "" for row in session.scalars(select(PointRow))}
        session.expunge_all()
        event.listen(session, "loaded_as_persistent", lambda _, row: read.append(row))
        found = reuse.stored(session, hashes, ENGINE_VERSION)
    assert sorted(point.point for point in found) == [1, 2, 3, 4]
    assert len(read) == 4  # of 16


def single(line: dict[str, Any], **changes: Any) -> dict[str, Any]:
    return {"line": {k: v for k, v in line.items() if k != "reference"}, "analysis": {**SHORT, **changes}}


def test_a_job_is_answered_by_a_line_of_a_batch(client: httpx.Client, settings: Settings) -> None:
    batch = finished(client, settings, LINES)
    told_of_third = told(client, batch)[2]
    labelled = {**single(LINES[2]), "line": {**single(LINES[2])["line"], "name": "other", "tags": {"a": "b"}}}
    job = client.post("/v1/jobs", json=labelled).json()
    (chunk,) = client.get("/v1/jobs", params={"batch_id": batch["id"]}).json()["jobs"]
    assert (job["status"], job["attempt"], job["reused_from"]) == ("successful", 0, chunk["id"])
    assert client.delete(f"/v1/batches/{batch['id']}").status_code == 204  # the copy stays
    address = f"/v1/jobs/{job['id']}"
    result = client.get(f"{address}/results").json()
    for name in ("static", "den_hartog", "frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations"):
        assert result[name] == told_of_third[name] != [], name
    assert next(iter(result["limit_cycles"][0])) == "model"  # no number of a line
    assert result["input"]["line"]["name"] == "other"
    orbit, second = (client.get(f"{address}/plots/orbit.svg?point={point}") for point in (0, 1))
    assert (orbit.status_code, second.status_code) == (200, 404)
    assert client.get(f"{address}/results/limit-cycles?format=csv").text.startswith("model,")


def test_a_line_of_a_batch_is_answered_by_a_job(client: httpx.Client, settings: Settings) -> None:
    address = service.finished(client, settings, single(LINES[1]))
    expected = client.get(f"{address}/results").json()
    batch = finished(client, settings, LINES)
    assert (batch["lines"]["successful"], batch["lines"]["reused"]) == (4, 1)
    found = told(client, batch)[1]
    assert (found["number"], found["reference"]) == (2, "r1")
    assert found["limit_cycles"] == expected["limit_cycles"] != []
    ranked = client.get(f"/v1/batches/{batch['id']}/ranking").json()["lines"]
    assert sorted(line["number"] for line in ranked) == [1, 2, 3, 4]


def test_what_a_job_was_given_answers_others(client: httpx.Client, settings: Settings) -> None:
    batch = finished(client, settings, LINES)
    job = client.post("/v1/jobs", json=single(LINES[0])).json()
    client.delete(f"/v1/batches/{batch['id']}")
    assert client.post("/v1/jobs", json=single(LINES[0])).json()["reused_from"] == job["id"]
    assert finished(client, settings, LINES)["lines"]["reused"] == 1


def test_a_job_is_answered_by_nothing_else(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    finished(client, settings, LINES)
    anew = {"Cache-Control": "no-cache"}
    study = {"study": {"axes": [{"parameter": "span.horizontal_tension_n", "values": [30000.0]}]}}
    others = [single(LINES[0], loops=[2]), single(changed("span.length_m", 99.0, TWIN)), {**single(LINES[0]), **study}]
    assert [client.post("/v1/jobs", json=other).json()["status"] for other in others] == ["accepted"] * 3
    assert client.post("/v1/jobs", json=single(LINES[0]), headers=anew).json()["status"] == "accepted"
    for change in ({"engine_version": "0.0.1"}, {"engine_version": ENGINE_VERSION, "failure": "no start converged"}):
        with sessions.begin() as session:
            session.execute(update(PointRow).values(**change))
        assert client.post("/v1/jobs", json=single(LINES[0])).json()["status"] == "accepted"


def test_a_job_of_another_owner_is_told_nothing_of_lines(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    finished(client, settings, LINES)
    with sessions.begin() as session:
        _, key = keys.create(session, STRANGER.owner, tuple(Scope), None, None)
    client.headers["Authorization"] = f"Bearer {key}"
    wait_until(lambda: client.get("/v1/jobs").status_code == 200, what="the key")
    assert client.post("/v1/jobs", json=single(LINES[0])).json()["status"] == "accepted"


def test_lines_in_engineers_forms_keep_what_is_assumed_of_them(client: httpx.Client, settings: Settings) -> None:
    explicit = convert.resolve_document(KNOWN)["line"]
    lines = [{**KNOWN, "name": "as known", "reference": "known"}, {**explicit, "reference": "explicit"}]
    batch = finished(client, settings, lines, uncertainty={"samples": 16})
    known, spelled = told(client, batch)
    assert known["assumptions"] == convert.resolve_document(KNOWN)["assumptions"]
    assert spelled["assumptions"] == []
    assert known["limit_cycles"] == spelled["limit_cycles"]
    table = client.get(f"/v1/batches/{batch['id']}/results?table=assumptions&format=csv").text.splitlines()
    assert [row.split(",")[:2] for row in table[1:]] == [["1", "known"]] * len(known["assumptions"])
    (verdict,) = known["verdict"]
    summary = client.get(f"/v1/batches/{batch['id']}/results?table=summary&format=ndjson").text.splitlines()
    row = json.loads(summary[0])
    asked = ("gallops", "onset_m_per_s", "vertical_peak_to_peak_m", "clearance_margin_m", "what_decides")
    assert row["name"] == "as known"
    assert {name: row[name] for name in asked} == {name: verdict[name] for name in asked}
    assert None not in {name: row[name] for name in asked if name != "what_decides"}.values()
    again = finished(client, settings, [{**KNOWN, "name": "another"}, explicit], uncertainty={"samples": 16})
    assert again["lines"]["reused"] == 2
    assert [line["assumptions"] for line in told(client, again)] == [known["assumptions"], []]
    assert finished(client, settings, [KNOWN], uncertainty={"samples": 8})["lines"]["reused"] == 0


def test_a_corrupt_result_is_reported_and_computed_anew(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session], caplog: pytest.LogCaptureFixture
) -> None:
    first = service.finished(client, settings, {"line": TWIN, "analysis": SHORT})
    kept = client.get(f"{first}/results/limit-cycles").json()
    with sessions.begin() as session:
        (row,) = session.scalars(select(PointRow))
        assert row.tables is not None
        place = len(row.tables) // 2
        row.tables = row.tables[:place] + bytes([row.tables[place] ^ 1]) + row.tables[place + 1 :]
    with sessions() as session, pytest.raises(CorruptResult):
        list(stored_results.rows(session, UUID(first.rpartition("/")[2]), "limit_cycles"))
    for part in ("results", "results/limit-cycles", "plots/amplitude.svg", "clearance?vertical_spacing_m=4"):
        answer = client.get(f"{first}/{part}")
        assert (answer.status_code, answer.json()["type"]) == (410, "/problems/damaged")
        assert "retry" in answer.json()["detail"]
    retried = client.post(f"{first}/retry").raise_for_status().json()
    assert retried["status"] == "accepted", "a damaged result is not reused"
    batch = client.post("/v1/batches", json={"lines": [TWIN], "analysis": SHORT}).raise_for_status()
    done = service.work_off(client, settings, batch.headers["Location"])
    assert (done["status"], done["lines"]["reused"]) == ("successful", 0)
    assert "is corrupt" in caplog.text
    again = client.post("/v1/jobs", json={"line": TWIN, "analysis": SHORT}).raise_for_status().json()
    assert again["status"] == "successful", "the sound copy is found"
    assert client.get(f"/v1/jobs/{again['id']}/results/limit-cycles").json() == kept


@pytest.mark.parametrize("bit", range(0, 8 * 200, 97))
def test_no_flipped_bit_passes_as_another_number(bit: int) -> None:
    text = json.dumps([{"vertical_m": number / 7.0} for number in range(60)]).encode()
    packed = bytearray(stored_results.packed(text))
    packed[bit // 8] ^= 1 << bit % 8
    try:
        found = stored_results.unpacked(bytes(packed))
    except CorruptResult:
        return
    assert found == text
