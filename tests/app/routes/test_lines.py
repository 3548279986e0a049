import httpx

from app.answers.lines import ResolvedLine
from app.routes.own_documentation import KNOWN_LINE, SHEET
from tests.app.known_documents import CONTRACT, LINES

ADDRESS = "/v1/lines/resolve"


def test_a_line_is_resolved_to_one_that_can_be_submitted(shared_client: httpx.Client) -> None:
    for line in (CONTRACT, KNOWN_LINE, LINES["explicit"]):
        answer = shared_client.post(ADDRESS, json=line)
        assert answer.status_code == 200, answer.text
        explicit = ResolvedLine.model_validate_json(answer.content).line
        job = {"line": explicit, "analysis": {"loops": [1], "wind_speeds_m_per_s": [5.0]}}
        assert shared_client.post("/v1/jobs", json=job).status_code == 202


def test_own_conductors_can_be_named(client: httpx.Client) -> None:
    named = {**KNOWN_LINE, "conductor": {"catalogue": "own drake"}}
    refused = client.post(ADDRESS, json=named)
    assert refused.status_code == 422
    assert [fault["pointer"] for fault in refused.json()["errors"]] == ["/conductor/catalogue"]
    client.post("/v1/conductors/own", content=SHEET.encode(), headers={"Content-Type": "text/csv"})
    assert client.post(ADDRESS, json=named).json()["line"]["conductor"]["diameter_m"] == 0.02811


def test_faults_of_schema_and_parts_name_their_fields(shared_client: httpx.Client) -> None:
    answer = shared_client.post(ADDRESS, json={**CONTRACT, "span": {"length_m": 300.0, "tension_n": 3e4}})
    (fault,) = answer.json()["errors"]
    assert (fault["pointer"], "horizontal_tension_n" in fault["detail"]) == ("/span/tension_n", True)
    wrapped = shared_client.post(ADDRESS, json={"line": CONTRACT}).json()["errors"]
    assert "is a line already" in next(fault["detail"] for fault in wrapped if fault["pointer"] == "/line")
