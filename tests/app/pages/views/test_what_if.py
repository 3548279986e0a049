from typing import Any

import httpx
import pytest

from app.pages import examples
from tests.app import service
from tests.app.pages.reading import read, send

SPACER = {"type": "spacer", "position_m": 120.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}
PHASE = {"devices": [SPACER]}  # its place does not move along with the length


@pytest.fixture(scope="module")
def address(known_job: str) -> str:
    return f"/pages/jobs/{known_job}/what-if"


def looked(client: httpx.Client, address: str, fields: dict[str, str]) -> dict[str, Any]:
    mark = read(client, address).fields["mark"]
    answer = client.post(f"{address}/curves", data={"mark": mark, **fields}, timeout=60.0)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_the_page_begins_with_the_values_of_the_line(shared_client: httpx.Client, address: str) -> None:
    page = read(shared_client, address)
    assert page.fields["ice"] == "12"
    assert page.fields["tension_everyday_share_of_rated_strength"] == "20"
    assert "What if: Twin Drake, 300 m" in page.text
    assert "hybrid model computes 1 loop" in page.text


def test_the_curve_follows_and_nothing_is_stored(shared_client: httpx.Client, address: str) -> None:
    before = looked(shared_client, address, {})
    assert before["at"] == 8.0
    assert before["sentence"].startswith("Gallops from")
    assert before["pieces"]
    jobs = shared_client.get("/v1/jobs").json()["jobs"]
    thick = looked(shared_client, address, {"ice": "25", "wind": "6"})
    assert thick["at"] == 6.0
    assert thick["onset"] > before["onset"]
    assert dict(thick["facts"])["Horizontal tension (H)"] != dict(before["facts"])["Horizontal tension (H)"]
    assert shared_client.get("/v1/jobs").json()["jobs"] == jobs


def test_the_moved_line_becomes_a_job_in_the_form_in_which_it_is_known(
    shared_client: httpx.Client, address: str
) -> None:
    answer = send(shared_client, address, {"ice": "25", "pendulum_mass": "15"})
    assert answer.status_code == 303
    fields = read(shared_client, f"{answer.headers['location']}/what-if").fields
    assert (fields["ice"], fields["pendulum_mass"]) == ("25", "15")
    assert fields["tension_everyday_share_of_rated_strength"] == "20"


def test_what_cannot_be_computed_is_refused_in_words(shared_client: httpx.Client) -> None:
    job = service.submit(shared_client, {"line": examples.line("c11-twin")})["id"]
    address = f"/pages/jobs/{job}/what-if"
    page = read(shared_client, address)
    assert "thickness cannot be moved" in page.text
    assert shared_client.post(f"{address}/curves", data={"mark": "forged"}).status_code == 403
    line = {**examples.line("c11-twin"), "phases": [{"name": "far", "y_m": 5.0, "z_m": 0.0, "line": PHASE}]}
    other = service.submit(shared_client, {"line": line})["id"]
    answer = send(shared_client, f"/pages/jobs/{other}/what-if", {"span": "80"})
    assert answer.status_code == 422
    assert "cannot be computed with these values" in answer.text


def test_a_line_with_tied_phases_says_why_no_curve_follows_and_becomes_a_job(shared_client: httpx.Client) -> None:
    spacer = {"type": "interphase_spacer", "position_m": 62.94, "mass_kg": 30.0, "between": ["this", "top"]}
    line = {**examples.line("c11-twin"), "devices": [spacer], "phases": [{"name": "top", "y_m": 7.0}]}
    address = f"/pages/jobs/{service.submit(shared_client, {'line': line})['id']}/what-if"
    page = read(shared_client, address)
    assert "An interphase spacer ties phases of this line" in page.text
    assert "data-curves" not in page.text
    refused = shared_client.post(f"{address}/curves", data={"mark": page.fields["mark"]})
    assert (refused.status_code, refused.json()["type"].rpartition("/")[2]) == (422, "takes-too-long")
    assert send(shared_client, address, {"damping_vertical_ratio": "0.9"}).status_code == 303
