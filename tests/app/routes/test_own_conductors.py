import httpx
import pytest

from app.answers.owned import OwnConductorList, StoredConductors
from app.routes.own_documentation import SHEET

ADDRESS = "/v1/conductors/own"
CSV = {"Content-Type": "text/csv"}


def stored(client: httpx.Client, text: str, **headers: str) -> httpx.Response:
    return client.post(ADDRESS, content=text.encode(), headers={**CSV, **headers})


def test_own_conductors_are_stored_listed_found_and_removed(client: httpx.Client) -> None:
    answer = stored(client, SHEET)
    assert answer.status_code == 200
    (row,) = StoredConductors.model_validate_json(answer.content).conductors
    assert (row.conductor.own, row.conductor.diameter_m, row.doubts) == (True, 0.02811, [])
    (listed,) = OwnConductorList.model_validate_json(client.get(ADDRESS).content).conductors
    assert listed == row
    found = client.get("/v1/conductors", params={"search": "drake"}).json()["conductors"]
    assert [(one["name"], one["own"]) for one in found] == [("Own Drake", True), ("Drake", False)]
    assert client.delete(f"{ADDRESS}/{row.id}").status_code == 204
    assert client.delete(f"{ADDRESS}/{row.id}").status_code == 404
    assert client.get(ADDRESS).json() == {"conductors": []}


def test_a_row_replaces_the_one_of_its_name_and_hides_the_shipped_one(client: httpx.Client) -> None:
    for diameter in (27.0, 28.0):
        stored(client, f"name,diameter [mm],mass [kg/m]\nDRAKE,{diameter},1.6\n")
    found = client.get("/v1/conductors", params={"search": "drake"}).json()["conductors"]
    assert [(one["name"], one["diameter_m"]) for one in found] == [("DRAKE", 0.028)]


def test_a_sheet_with_a_fault_stores_nothing(client: httpx.Client) -> None:
    answer = stored(client, "name,diameter [mm],mass [kg/m]\nA,28,1.6\nB,28,\n")
    assert answer.status_code == 422
    assert [fault["pointer"] for fault in answer.json()["errors"]] == ["/rows/3/mass"]
    assert client.get(ADDRESS).json() == {"conductors": []}


def test_figures_that_contradict_each_other_are_told_and_kept(client: httpx.Client) -> None:
    text = "name,diameter [mm],mass [kg/m],area [mm2],aluminium area [mm2]\nA,28.14,2.6,468.6,402.8\n"
    (row,) = stored(client, text).json()["conductors"]
    assert len(row["doubts"]) == 1
    assert "the mass, 2.6 kg/m" in row["doubts"][0]


def test_a_key_stores_once(client: httpx.Client) -> None:
    first = stored(client, SHEET, **{"Idempotency-Key": "k"})
    again = stored(client, SHEET, **{"Idempotency-Key": "k"})
    assert (again.content, again.headers["Idempotency-Replayed"]) == (first.content, "true")
    assert stored(client, SHEET + "\n", **{"Idempotency-Key": "k"}).status_code == 422


@pytest.mark.parametrize("media_type", ["application/json", "text/plain"])
def test_another_media_type_is_refused(shared_client: httpx.Client, media_type: str) -> None:
    answer = shared_client.post(ADDRESS, content=b"{}", headers={"Content-Type": media_type})
    assert (answer.status_code, answer.headers["Accept-Post"]) == (415, "text/csv")
