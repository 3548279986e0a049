"""Jobs answered from what is stored, over HTTP on either database."""

import functools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any
from uuid import UUID

import httpx
import pytest
from sqlalchemy import event
from sqlalchemy.orm import Session, sessionmaker

from app.convert import ENGINE_VERSION
from app.jobs import job_records, leases, reuse, webhooks
from app.jobs.leases import Failure
from app.jobs.reuse import Source
from app.runtime.settings import Settings
from app.schemas import JobRequest
from app.security.caller import LOCAL
from app.storage import counters
from app.tables import FailureKind
from tests.app import service
from tests.app.lines import changed
from tests.documents import point_result, short_request
from tests.statements import counted


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service on either kind of database."""
    with service.running(settings) as running:
        yield running


def submitted(client: httpx.Client, document: dict[str, Any] | None = None) -> dict[str, Any]:
    """Post a request that may be answered from what is stored, and return the status document."""
    status: dict[str, Any] = client.post("/v1/jobs", json=document or short_request()).raise_for_status().json()
    return status


def labelled(**labels: Any) -> dict[str, Any]:
    return {**short_request(), "line": {**short_request()["line"], **labels}}


def test_the_same_line_is_answered_from_what_is_stored(client: httpx.Client, settings: Settings) -> None:
    first = service.finished(client, settings)
    again = submitted(client, labelled(name="another name", asset_id="L9", tags={"a": "b"}))
    assert (again["status"], again["progress"], again["attempt"]) == ("successful", 1.0, 0)
    assert again["reused_from"] == first[-36:]
    assert (again["name"], again["engine_version"]) == ("another name", ENGINE_VERSION)
    address = f"/v1/jobs/{again['id']}"
    assert client.get(address).json() == again
    tables = ("frequencies", "critical-wind-speeds", "limit-cycles")
    for table in tables:
        assert client.get(f"{address}/results/{table}").json() == client.get(f"{first}/results/{table}").json()
    assert client.get(f"{address}/plots/orbit.svg").status_code == 200
    assert client.delete(first).status_code == 204
    assert client.get(f"{address}/results/limit-cycles").json()["limit_cycles"]
    third = submitted(client)
    assert third["reused_from"] == again["id"]


def test_an_end_from_what_is_stored_is_an_end_like_others(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with service.running(settings.model_copy(update={"webhook_private_networks": True})) as client:
        service.finished(client, settings)
        hook = {"webhook_url": "https://127.0.0.1/hook"}
        address = f"/v1/jobs/{submitted(client, {**short_request(), **hook})['id']}"
        with sessions.begin() as session:
            assert webhooks.enlist(session) == 1
            assert counters.totals(session)["jobs", "successful"][0] == 2
        (told,) = client.get(f"{address}/deliveries").json()["deliveries"]
        assert told["state"] == "pending"
        events = client.get(f"{address}/events").text.splitlines()
        assert [line for line in events if line.startswith("event: ")] == ["event: accepted", "event: successful"]
        waited = client.get(address, headers={"Prefer": "wait=20"}).json()
        assert waited["status"] == "successful"


def test_another_question_is_computed(client: httpx.Client, settings: Settings) -> None:
    service.finished(client, settings)
    other = {**short_request(), "analysis": {**short_request()["analysis"], "harmonics": 6}}
    assert submitted(client, other)["status"] == "accepted"
    anew = client.post("/v1/jobs", json=short_request(), headers={"Cache-Control": "no-cache"}).json()
    assert (anew["status"], anew["reused_from"]) == ("accepted", None)


def test_nothing_is_reused_that_failed_or_was_dismissed(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    failed = submitted(client)
    with sessions.begin() as session:
        held = leases.claim(session, UUID(failed["id"]), "test", 30.0)
        assert held is not None
        leases.fail(session, held, Failure(FailureKind.TIME_LIMIT, "too long"), [point_result()])
    dismissed = submitted(client)
    client.delete(f"/v1/jobs/{dismissed['id']}")
    assert (dismissed["status"], submitted(client)["status"]) == ("accepted", "accepted")


def test_nothing_of_another_owner_or_engine_is_reused(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    job = submitted(client)
    with sessions.begin() as session:
        held = leases.claim(session, UUID(job["id"]), "test", 30.0)
        assert held is not None
        found = replace(point_result(), input_hash=reuse.hash_of(LOCAL.owner, held.document))  # by engine 9.9.9
        leases.finish(session, held, [found])
        assert reuse.find(session, [(LOCAL.owner, held.document)], ENGINE_VERSION) == [None]
        asked = [(owner, held.document) for owner in ("another", LOCAL.owner)]
        assert reuse.find(session, asked, "9.9.9") == [None, Source(held.job_id)]
    assert submitted(client)["status"] == "accepted"


STUDY = {**short_request(), "study": {"axes": [{"parameter": "span.horizontal_tension_n", "values": [29e3, 31e3]}]}}


def test_a_study_is_answered_by_the_same_study_only(client: httpx.Client, settings: Settings) -> None:
    first = service.finished(client, settings, STUDY)
    again = submitted(client, STUDY)
    assert (again["status"], again["reused_from"]) == ("successful", first[-36:])
    results = [client.get(f"{address}/results").json() for address in (first, f"/v1/jobs/{again['id']}")]
    assert results[0]["limit_cycles"] == results[1]["limit_cycles"] != []
    for tension in (29e3, 31e3):  # a point of a study is a line by itself, too, but it is not found as one
        alone = {**short_request(), "line": changed("span.horizontal_tension_n", tension, short_request()["line"])}
        assert submitted(client, alone)["status"] == "accepted"


@pytest.mark.parametrize("document", [short_request(), STUDY], ids=["line", "study"])
def test_a_look_for_what_is_stored_is_one_statement(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session], document: dict[str, Any]
) -> None:
    kept = JobRequest.model_validate(document).kept()
    for found in (False, True):
        with sessions() as session, counted() as statements:
            (source,) = reuse.find(session, [(LOCAL.owner, kept)], ENGINE_VERSION)
            assert (source is not None) == found
        # The points of a study are read as well, to see that none is corrupt.
        assert len(statements) == (2 if found and "study" in kept else 1)
        service.finished(client, settings, document)


def test_a_look_for_many_lines_is_one_statement_and_one_for_each_that_is_found(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    stored = service.finished(client, settings)[-36:]
    lines = [changed("span.horizontal_tension_n", 29e3 + n, short_request()["line"]) for n in range(20)]
    asked = [short_request(), *({**short_request(), "line": line} for line in lines), labelled(name="once more")]
    kept = [(LOCAL.owner, JobRequest.model_validate(document).kept()) for document in asked]
    with sessions() as session, counted() as statements:
        found = reuse.find(session, kept, ENGINE_VERSION)
    assert found == [Source(UUID(stored)), *[None] * 20, Source(UUID(stored))]
    of_sqlite = settings.database_url.startswith("sqlite")  # it is in this process, and asked line by line
    assert len(statements) == (21 if of_sqlite else 2)


def test_labels_are_no_part_of_the_input() -> None:
    assert job_records.input_hash(labelled(name="a")) == job_records.input_hash(labelled(name="b", tags={"x": "y"}))
    assert job_records.input_hash(labelled(conductor={})) != job_records.input_hash(labelled())


TWO_LINES = [short_request(), {**short_request(), "line": changed("span.length_m", 99.0, short_request()["line"])}]


@pytest.mark.parametrize(
    ("documents", "index"),
    [([short_request()], "ix_results_input_hash"), (TWO_LINES, "ix_results_input_hash"), ([STUDY], "ix_jobs_owner_")],
)
def test_a_look_for_what_is_stored_goes_along_an_index(
    sessions: sessionmaker[Session], documents: list[dict[str, Any]], index: str
) -> None:
    asked: list[tuple[str, Any]] = []

    def note(_: Any, __: Any, statement: str, parameters: Any, *___: Any) -> None:
        asked.append((statement, parameters))

    with sessions() as session:
        connection = session.connection()
        event.listen(connection, "before_cursor_execute", note)
        kept = [JobRequest.model_validate(document).kept() for document in documents]
        reuse.find(session, [(LOCAL.owner, document) for document in kept], ENGINE_VERSION)
        statement, parameters = asked[0]
        if connection.dialect.name == "sqlite":
            explain = "EXPLAIN QUERY PLAN"
        else:
            explain = "EXPLAIN"
            connection.exec_driver_sql("SET LOCAL enable_seqscan = off")  # of a table without rows
        plan = str(connection.exec_driver_sql(f"{explain} {statement}", parameters).all())
    assert index in plan
    with_index = ("INDEX SCAN", "INDEX ONLY SCAN", "BITMAP HEAP SCAN", "FUNCTION SCAN")  # the last is of what is asked
    assert "SCAN" not in functools.reduce(lambda text, kind: text.replace(kind, ""), with_index, plan.upper())
