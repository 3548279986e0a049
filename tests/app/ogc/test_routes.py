"""The routes as the standard and one of its clients use them."""

import json
import threading
from collections.abc import Iterator
from typing import Any
from uuid import UUID

import httpx
import pytest
from jsonschema import Draft202012Validator
from owslib.ogcapi.processes import Processes

from app.ogc import descriptions, requests
from app.routes.own_documentation import KNOWN_LINE
from app.runtime.settings import Settings
from tests.app import service
from tests.documents import short_request
from tests.in_process import run_job
from tests.servers import wait_until

EXECUTION = "/ogc/processes/galloping/execution"
ASYNC = {"Prefer": "respond-async"}
LINK = {"type": "object", "required": ["href"], "properties": {"href": {"type": "string"}, "rel": {"type": "string"}}}
LINKS = {"type": "array", "items": LINK}
# The schemas of the standard (statusInfo.yaml, processSummary.yaml, landingPage.yaml, confClasses.yaml).
STATUS_INFO = {
    "type": "object",
    "required": ["jobID", "status", "type"],
    "properties": {
        "processID": {"type": "string"},
        "type": {"enum": ["process"]},
        "jobID": {"type": "string"},
        "status": {"enum": ["accepted", "running", "successful", "failed", "dismissed"]},
        "message": {"type": "string"},
        "created": {"type": "string"},
        "started": {"type": "string"},
        "finished": {"type": "string"},
        "updated": {"type": "string"},
        "progress": {"type": "integer", "minimum": 0, "maximum": 100},
        "links": LINKS,
    },
}
SUMMARY = {
    "type": "object",
    "required": ["id", "version"],
    "properties": {
        "id": {"type": "string"},
        "version": {"type": "string"},
        "jobControlOptions": {"items": {"enum": ["sync-execute", "async-execute", "dismiss"]}},
        "outputTransmission": {"items": {"enum": ["value", "reference"]}},
        "links": LINKS,
    },
}
LANDING = {"type": "object", "required": ["links"], "properties": {"links": LINKS}}
CONFORMANCE = {"type": "object", "required": ["conformsTo"], "properties": {"conformsTo": {"type": "array"}}}


def held(schema: dict[str, Any], document: Any) -> Any:
    assert [error.message for error in Draft202012Validator(schema).iter_errors(document)] == []
    return document


@pytest.fixture
def working(own_client: httpx.Client, own_settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service whose jobs a thread works off."""
    stop = threading.Event()

    def work() -> None:
        while not stop.wait(0.05):
            for job in own_client.get("/v1/jobs?status=accepted").json()["jobs"]:
                run_job(own_settings, UUID(job["id"]))

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    try:
        yield own_client
    finally:
        stop.set()
        thread.join(30.0)


def test_the_landing_page_leads_to_everything(shared_client: httpx.Client) -> None:
    landing = held(LANDING, shared_client.get("/ogc/").json())
    assert shared_client.get("/ogc").json() == landing
    links = landing["links"]
    assert {"self", "service-desc", "conformance", "http://www.opengis.net/def/rel/ogc/1.0/processes"} <= {
        link["rel"] for link in links
    }
    assert {shared_client.get(link["href"]).status_code for link in links} == {200}
    classes = held(CONFORMANCE, shared_client.get("/ogc/conformance").json())["conformsTo"]
    assert "http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/core" in classes


def test_the_process_is_listed_and_described_with_schemas(shared_client: httpx.Client) -> None:
    (listed,) = shared_client.get("/ogc/processes").json()["processes"]
    held(SUMMARY, listed)
    described = held(SUMMARY, shared_client.get("/ogc/processes/galloping").json())
    assert {name: entry["minOccurs"] for name, entry in described["inputs"].items()} == {
        "line": 1,
        "analysis": 0,
        "study": 0,
        "placement": 0,
        "remedies": 0,
    }
    schema = described["inputs"]["line"]["schema"]
    assert "$ref" not in str(described)
    Draft202012Validator.check_schema(schema)
    for line in (short_request()["line"], KNOWN_LINE):
        held(schema, line)
    missing = shared_client.get("/ogc/processes/other")
    assert missing.status_code == 404
    assert missing.json()["type"].endswith("/1.0/no-such-process")
    unknown = shared_client.post("/ogc/processes/other/execution", json={})
    assert (unknown.status_code, unknown.json()["type"]) == (404, missing.json()["type"])


def test_an_execution_is_asynchronous_where_the_client_prefers_it(
    own_client: httpx.Client, own_settings: Settings
) -> None:
    posted = own_client.post(EXECUTION, json={"inputs": short_request()}, headers=ASYNC)
    assert (posted.status_code, posted.headers["Preference-Applied"]) == (201, "respond-async")
    job = posted.headers["Location"]
    assert job == str(own_client.base_url.join(f"/ogc/jobs/{posted.json()['jobID']}"))
    assert held(STATUS_INFO, posted.json())["status"] == "accepted"
    early = own_client.get(f"{job}/results")
    assert (early.status_code, early.json()["type"][-17:]) == (404, "/result-not-ready")
    run_job(own_settings, UUID(posted.json()["jobID"]))
    status = held(STATUS_INFO, own_client.get(job).json())
    assert (status["status"], status["progress"]) == ("successful", 100)
    results = next(link["href"] for link in status["links"] if link["rel"].endswith("/results"))
    found = own_client.get(results).json()["result"]["value"]
    assert found == own_client.get(f"/v1/jobs/{status['jobID']}/results").json()
    gone = own_client.delete(job)
    assert (gone.status_code, held(STATUS_INFO, gone.json())["status"]) == (200, "dismissed")
    assert own_client.get(job).json()["type"].endswith("/no-such-job")


def test_a_waiting_job_is_dismissed(own_client: httpx.Client) -> None:
    job = own_client.post(EXECUTION, json={"inputs": short_request()}, headers=ASYNC).headers["Location"]
    assert own_client.delete(job).json()["status"] == "dismissed"
    assert own_client.get(job).json()["status"] == "dismissed"
    assert own_client.get(f"{job}/results").status_code == 410


def test_a_short_execution_answers_with_its_results(working: httpx.Client) -> None:
    qualified = {"line": {"value": short_request()["line"], "mediaType": "application/json"}}
    asked = {"inputs": {**qualified, "analysis": short_request()["analysis"]}}
    raw = working.post(EXECUTION, json=asked)
    assert raw.status_code == 200, raw.text
    assert raw.json()["limit_cycles"]
    (monitor,) = raw.links.values()
    assert monitor["rel"] == "monitor"
    assert held(STATUS_INFO, working.get(monitor["url"]).json())["status"] == "successful"
    document = working.post(EXECUTION, json={**asked, "response": "document", "mode": "auto"})
    assert document.json()["result"]["value"]["limit_cycles"] == raw.json()["limit_cycles"]


def test_faults_of_the_inputs_point_into_them(shared_client: httpx.Client) -> None:
    def pointers(document: dict[str, Any]) -> list[str]:
        answer = shared_client.post(EXECUTION, json=document)
        assert answer.status_code == 422
        return [fault["pointer"] for fault in answer.json()["errors"]]

    line = short_request()["line"]
    assert pointers({"inputs": {"line": {**line, "span": {**line["span"], "length_m": -1.0}}}}) == [
        "/inputs/line/span/length_m"
    ]
    assert pointers({"inputs": {"line": {"href": "https://grid.example/line.json"}}}) == ["/inputs/line"]
    assert pointers({"inputs": {"line": line, "webhook_url": "https://grid.example/", "a/b": 1}}) == [
        "/inputs/webhook_url",
        "/inputs/a~1b",
    ]
    assert pointers({"inputs": {"line": line}, "outputs": {"rows": {}}}) == ["/outputs/rows"]
    assert pointers({}) == ["/inputs"]


def test_the_list_of_jobs_is_filtered_and_paged(own_client: httpx.Client, own_settings: Settings) -> None:
    first = own_client.post(EXECUTION, json={"inputs": short_request()}, headers=ASYNC).json()["jobID"]
    run_job(own_settings, UUID(first))
    for _ in range(2):
        service.submit(own_client)

    def jobs(query: str) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = own_client.get(f"/ogc/jobs?{query}").raise_for_status().json()["jobs"]
        return [held(STATUS_INFO, job) for job in found]

    assert [job["jobID"] for job in jobs("status=successful&status=failed")] == [first]
    assert len(jobs("type=process&processID=galloping")) == 3
    assert jobs("processID=other") == []
    assert [job["jobID"] for job in jobs("status=successful,failed&processID=other,galloping&f=json")] == [first]
    assert len(jobs("limit=10000")) == 3
    assert len(jobs("datetime=2000-01-01T00:00:00Z/..")) == 3
    assert jobs("datetime=../2000-01-01T00:00:00Z") == []
    assert [job["jobID"] for job in jobs("minDuration=0")] == [first]
    assert jobs("minDuration=3600") == []
    page = own_client.get("/ogc/jobs?limit=2").json()
    following = next(link["href"] for link in page["links"] if link["rel"] == "next")
    assert [job["jobID"] for job in own_client.get(following).json()["jobs"]] == [first]
    assert own_client.get("/ogc/jobs?datetime=soon").status_code == 400


def test_a_page_of_jobs_has_no_more_than_the_service_allows(
    own_client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(requests, "_LARGEST_PAGE", 1)
    for _ in range(2):
        service.submit(own_client)
    page = own_client.get("/ogc/jobs?limit=1000").json()
    following = next(link["href"] for link in page["links"] if link["rel"] == "next")
    older = own_client.get(following).json()
    assert [len(found["jobs"]) for found in (page, older)] == [1, 1]
    assert page["jobs"][0]["jobID"] != older["jobs"][0]["jobID"]


@pytest.mark.parametrize("member", ["subscriber", "subscribers"])
def test_a_subscriber_to_failures_alone_is_heard_under_both_names(own_client: httpx.Client, member: str) -> None:
    asked = {"inputs": short_request(), member: {"failedUri": "https://127.0.0.1/hook"}}
    refused = own_client.post(EXECUTION, json=asked, headers=ASYNC)
    assert [fault["pointer"] for fault in refused.json()["errors"]] == ["/subscriber/failedUri"]


def test_owslib_finds_and_runs_the_process(working: httpx.Client) -> None:
    service_of = Processes(str(working.base_url.join("/ogc/")))
    assert [process["id"] for process in service_of.processes()] == ["galloping"]
    assert "line" in service_of.process("galloping")["inputs"]
    done = service_of.execute("galloping", short_request(), response="document")
    assert done["result"]["value"]["limit_cycles"]
    service_of.execute("galloping", short_request(), async_=True)
    job = service_of.response_headers["Location"]
    wait_until(lambda: working.get(job).json()["status"] == "successful", what="the job")
    assert working.get(f"{job}/results").json()["result"]["value"]["limit_cycles"]


def test_the_description_links_to_the_address_under_which_it_is_read() -> None:
    for place in ("https://a.example/gal", "http://b.example:8000"):
        links = json.loads(descriptions.description_text(place))["links"]
        assert {link["href"].removeprefix(f"{place}/ogc/processes/galloping") for link in links} == {"", "/execution"}
