"""Searches for places through the border: checked with pointers, run, and given back as rows."""

import copy
from typing import Any

import pytest

from app import convert
from app.answers.results import ResultDocument
from app.answers.rows import row_schema
from app.reference.source_lines import example
from app.schemas.placement import EXAMPLE
from tests.app.lines import faults

ANALYSIS = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}
SEARCH: dict[str, Any] = EXAMPLE | {"generations": 1, "population": 5}


def request(**changes: Any) -> dict[str, Any]:
    """Return a short search on the twin line."""
    return {"line": example("c11-twin"), "analysis": ANALYSIS, "placement": copy.deepcopy(SEARCH) | changes}


def pointers(document: dict[str, Any]) -> list[str]:
    """Return where faults are found."""
    return [fault.pointer for fault in faults(document)]


def test_a_search_gives_devices_and_their_effect() -> None:
    kept = convert.read(request()).kept()
    assert kept["placement"]["population"] == 5
    assert "study" not in kept
    items = list(convert.run(kept))
    advances = [item for item in items if isinstance(item, convert.Advance)]
    (point,) = (item for item in items if isinstance(item, convert.PointResult))
    assert any("generation" in advance.step for advance in advances)
    assert [row["type"] for row in point.tables["placements"]] == ["detuning_pendulum"] * 2
    (effect,) = point.tables["device_effects"]
    assert effect["critical_wind_speed_with_m_per_s"] > effect["critical_wind_speed_without_m_per_s"]
    assert list(effect) == convert.columns("device_effects")
    fields = ResultDocument.model_fields
    assert {"placements", "device_effects", "model_comparisons", "loop_competitions"} <= fields.keys()
    row = row_schema(convert.TABLES["placements"].row).model_validate(point.tables["placements"][0])
    assert row.model_dump()["device"] == 0


def test_the_effect_of_a_lines_own_devices_is_reported_if_asked_for() -> None:
    line = example("c11-twin")
    line["devices"] = [{"type": "detuning_pendulum", "position_m": 40.0, "mass_kg": 15.0, "arm_m": 0.4}]
    asked = convert.read({"line": line, "analysis": ANALYSIS | {"device_effect": "reported"}}).kept()
    point = next(item for item in convert.run(asked) if isinstance(item, convert.PointResult))
    assert [row["loops"] for row in point.tables["device_effects"]] == [1]
    assert point.tables["placements"] == []


def test_faults_point_into_the_placement() -> None:
    assert pointers(request(device={**SEARCH["device"], "position_m": {"lowest": 5.0, "highest": 130.0}})) == [
        "/placement/device/position_m/highest"
    ]
    assert pointers(request(device={**SEARCH["device"], "mass_kg": {"lowest": 5.0, "highest": 3.0}})) == [
        "/placement/device/mass_kg"
    ]
    assert pointers(request(population=2)) == ["/placement/population"]
    assert pointers(request(device={"type": "spacer"})) == ["/placement/device"]
    assert pointers(request() | {"analysis": ANALYSIS | {"wind_speeds_m_per_s": []}}) == []
    still = request(objective="lowest_amplitude") | {"analysis": ANALYSIS | {"wind_speeds_m_per_s": []}}
    assert pointers(still) == ["/placement/objective"]


def test_a_spoiler_must_fit_where_it_is_to_be() -> None:
    coefficients = example("c11-twin")["ice"]["aerodynamics"]
    spoiler = {"type": "airflow_spoiler", "length_m": 30.0, "aerodynamics": coefficients}
    assert pointers(request(device=spoiler | {"position_m": {"lowest": 0.0, "highest": 60.0}})) == []
    assert pointers(request(device=spoiler | {"position_m": {"lowest": 0.0, "highest": 20.0}})) == [
        "/placement/device/length_m"
    ]


def test_a_study_excludes_a_placement() -> None:
    study = {"axes": [{"parameter": "span.length_m", "values": [100.0]}]}
    assert pointers(request() | {"study": study}) == [""]


@pytest.mark.parametrize("name", ["study", "placement"])
def test_what_was_not_asked_for_is_not_kept(name: str) -> None:
    assert name not in convert.read({"line": example("c11-twin")}).kept()
