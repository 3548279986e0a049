"""`POST /v1/remedies`: a job whose table `remedies` is served in every form."""

from uuid import UUID

import httpx

from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests.app import service
from tests.in_process import run_job

DOCUMENT = {
    "line": example("c11-twin"),
    "analysis": {"loops": [2], "wind_speeds_m_per_s": [6.0]},
    "remedies": {"tried": [{"type": "tension", "factor": 1.2}]},
}


def test_a_comparison_is_a_job(shared_client: httpx.Client, shared_settings: Settings) -> None:
    headers = {**service.ANEW, "Idempotency-Key": "remedies-1"}
    posted = shared_client.post("/v1/remedies", json=DOCUMENT, headers=headers)
    assert posted.status_code == 202, posted.text
    again = shared_client.post("/v1/remedies", json=DOCUMENT, headers=headers)
    assert (again.json()["id"], again.headers["location"]) == (posted.json()["id"], posted.headers["location"])
    run_job(shared_settings, UUID(posted.json()["id"]))
    address = posted.headers["location"]
    rows = shared_client.get(f"{address}/results/remedies").json()["remedies"]
    assert [row["kind"] for row in rows] == ["none", "tension"]
    text = shared_client.get(f"{address}/results/remedies?format=csv").text
    assert text.startswith("remedy,kind,what,places,change,rank,")
    assert shared_client.get(address).json()["status"] == "successful"


def test_the_usual_remedies_need_no_name(shared_client: httpx.Client) -> None:
    posted = shared_client.post("/v1/remedies", json={"line": example("c11-single")}, headers=service.ANEW)
    assert posted.status_code == 202, posted.text
    assert shared_client.delete(posted.headers["location"]).status_code == 200


def test_faults_name_the_field(shared_client: httpx.Client) -> None:
    wrong = {**DOCUMENT, "remedies": {"tried": [{"type": "detuning_pendulum", "positions_m": [300.0], "mass": 3}]}}
    answer = shared_client.post("/v1/remedies", json=wrong)
    assert answer.status_code == 422
    assert "/remedies/tried/0/mass" in [fault["pointer"] for fault in answer.json()["errors"]]
