import math
from typing import Any

import httpx
import pytest

from app.answers.owned import OwnTableList, OwnTableRow
from tests.app.known_documents import CONTRACT

ADDRESS = "/v1/aerodynamics/own"


def table(name: str = "Our D", **changes: Any) -> dict[str, Any]:
    rows = [
        {
            "angle_deg": float(angle),
            "lift": 0.8 * math.sin(math.radians(2 * angle)),
            "drag": 1.2 - 0.3 * math.cos(math.radians(2 * angle)),
            "moment": 0.0,
        }
        for angle in range(0, 100, 10)
    ]
    return {"name": name, "table": rows, "static_angle_deg": 40.0, "half_range_deg": 30.0, **changes}


def test_a_table_is_stored_listed_named_in_a_line_and_removed(client: httpx.Client) -> None:
    answer = client.post(ADDRESS, json=table(source="tunnel"))
    assert answer.status_code == 200, answer.text
    row = OwnTableRow.model_validate_json(answer.content)
    assert (row.table.name, row.doubts, row.ice_direction_deg) == ("Our D", [], None)
    assert OwnTableList.model_validate_json(client.get(ADDRESS).content).tables == [row]
    named = {**CONTRACT, "ice": {**CONTRACT["ice"], "aerodynamics": {"catalogue": "our d", "angle_deg": 50.0}}}
    resolved = client.post("/v1/lines/resolve", json=named).json()
    assert resolved["line"]["ice"]["aerodynamics"]["table"][0]["drag"] == pytest.approx(0.9)
    client.post(ADDRESS, json=table(name=" OUR  d", half_range_deg=20.0))
    (kept,) = client.get(ADDRESS).json()["tables"]
    assert kept["table"]["half_range_deg"] == 20.0
    assert client.delete(f"{ADDRESS}/{kept['id']}").status_code == 204
    assert client.delete(f"{ADDRESS}/{kept['id']}").status_code == 404
    assert client.post("/v1/lines/resolve", json=named).status_code == 422


def test_slips_are_told_when_a_table_is_stored_and_when_it_is_fitted(shared_client: httpx.Client) -> None:
    swapped = table()
    for row in swapped["table"]:
        row["lift"], row["drag"] = row["drag"], row["lift"]
    stored = shared_client.post(ADDRESS, json=swapped).json()
    assert "lift and drag look swapped" in stored["doubts"][0]
    measured = {key: swapped[key] for key in ("table", "static_angle_deg", "half_range_deg")}
    assert shared_client.post("/v1/aerodynamics/fit", json=measured).json()["doubts"] == stored["doubts"]


def test_a_wrong_table_is_refused(shared_client: httpx.Client) -> None:
    answer = shared_client.post(ADDRESS, json=table(colour=1, name=""))
    assert answer.status_code == 422
    assert {fault["pointer"] for fault in answer.json()["errors"]} == {"/name", "/colour"}
