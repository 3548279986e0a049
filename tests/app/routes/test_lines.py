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


def test_a_job_and_a_batch_take_lines_as_engineers_know_them(client: httpx.Client) -> None:
    client.post("/v1/conductors/own", content=SHEET.encode(), headers={"Content-Type": "text/csv"})
    line = {**KNOWN_LINE, "conductor": {"catalogue": "Own Drake"}}
    analysis = {"loops": [1], "wind_speeds_m_per_s": [5.0]}
    posted = client.post("/v1/jobs", json={"line": line, "analysis": analysis})
    assert posted.status_code == 202, posted.text
    assert posted.json()["name"] == KNOWN_LINE["name"]
    wrong = {**line, "conductor": {"catalogue": "nobody's"}}
    refused = client.post("/v1/jobs", json={"line": wrong, "analysis": analysis})
    assert [fault["pointer"] for fault in refused.json()["errors"]] == ["/line/conductor/catalogue"]
    batch = client.post("/v1/batches", json={"lines": [line, wrong, LINES["explicit"]], "analysis": analysis})
    assert batch.status_code == 202, batch.text
    document = batch.json()
    assert (document["lines"]["total"], document["lines"]["rejected"]) == (3, 1)
    assert [(fault["number"], fault["pointer"]) for fault in document["errors"]] == [(2, "/conductor/catalogue")]


def test_a_batch_of_named_conductors_comes_from_csv(client: httpx.Client) -> None:
    header = "name,conductor.catalogue,span.length_m,span.everyday.sag_m,ice.accretion.shape,ice.accretion.thickness_m"
    rows = [f"a{i},Drake,{250 + i},5.0,crescent,0.012,c11-40" for i in range(3)]
    text = "\n".join([f"{header},ice.aerodynamics.catalogue", *rows])
    answer = client.post("/v1/batches", content=text.encode(), headers={"Content-Type": "text/csv"})
    assert answer.status_code == 202, answer.text
    assert (answer.json()["lines"]["total"], answer.json()["lines"]["rejected"]) == (3, 0)
