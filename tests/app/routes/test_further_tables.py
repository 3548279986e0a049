"""The tables that an analysis has only if it is asked for them: posted, run, and fetched in every form."""

import csv
import io
from typing import Any

import httpx
import pyarrow.parquet as pq
import pytest

from app.answers.results import ResultDocument, TableName
from app.client import Client
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.schemas.placement import EXAMPLE
from tests.app import service
from tests.app.lines import close

PENDULUM = {"type": "detuning_pendulum", "position_m": 40.0, "mass_kg": 15.0, "arm_m": 0.4}
ANALYSIS = {
    "loops": [1, 2],
    "models": ["hybrid", "finite_element"],
    "finite_element_loops": [1, 2],
    "wind_speeds_m_per_s": [4.0],
    "loop_competition": "checked",
    "device_effect": "reported",
}
TABLES = ["internal-resonances", "bifurcations", "model-comparisons", "loop-competitions", "device-effects"]
Rows = list[dict[str, Any]]


def line() -> dict[str, Any]:
    given = example("c11-twin")
    return {**given, "span": {**given["span"], "elements": 6}, "devices": [PENDULUM]}


@pytest.fixture(scope="module")
def address(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished job that was asked for everything."""
    return service.finished(shared_client, shared_settings, {"line": line(), "analysis": ANALYSIS})


@pytest.fixture(scope="module")
def placed(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished search for places."""
    search = {**EXAMPLE, "generations": 1, "population": 5}
    asked = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}
    document = {"line": example("c11-twin"), "analysis": asked, "placement": search}
    return service.finished(shared_client, shared_settings, document)


@pytest.fixture(scope="module")
def batch(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished batch of two such lines."""
    found = shared_client.post("/v1/batches", json={"lines": [line(), line()], "analysis": ANALYSIS})
    address: str = found.headers["location"]
    service.work_off(shared_client, shared_settings, address)
    return address


def rows(client: httpx.Client, address: str, table: str) -> Rows:
    """Return the rows of a table, which CSV, Parquet and the whole document hold, too."""
    name = table.replace("-", "_")
    found: Rows = client.get(f"{address}/results/{table}").raise_for_status().json()[name]
    cells = csv.DictReader(io.StringIO(client.get(f"{address}/results/{table}?format=csv").text, newline=""))
    assert found
    assert list(cells) == [{key: "" if value is None else str(value) for key, value in row.items()} for row in found]
    assert (
        pq.read_table(io.BytesIO(client.get(f"{address}/results/{table}?format=parquet").content)).to_pylist() == found
    )
    whole = client.get(f"{address}/results").json()
    assert whole[name] == found
    ResultDocument.model_validate(whole)
    return found


def test_internal_resonances(shared_client: httpx.Client, address: str) -> None:
    found = rows(shared_client, address, "internal-resonances")
    assert {(row["model"], row["loops"]) for row in found} >= {("hybrid", 1), ("hybrid", 2)}


def test_bifurcations(shared_client: httpx.Client, address: str) -> None:
    hopf = [row for row in rows(shared_client, address, "bifurcations") if row["type"] == "hopf"]
    onsets = {
        row["wind_speed_m_per_s"]
        for row in shared_client.get(f"{address}/results/critical-wind-speeds").json()["critical_wind_speeds"]
    }
    assert hopf
    assert all(any(row["wind_speed_m_per_s"] == pytest.approx(onset) for onset in onsets) for row in hopf)


def test_model_comparisons(shared_client: httpx.Client, address: str) -> None:
    (row, *_) = rows(shared_client, address, "model-comparisons")
    hybrid = (row["hybrid_vertical_m"] ** 2 + row["hybrid_horizontal_m"] ** 2) ** 0.5
    other = (row["finite_element_vertical_m"] ** 2 + row["finite_element_horizontal_m"] ** 2) ** 0.5
    assert row["amplitude_difference"] == pytest.approx(other / hybrid - 1.0, rel=1e-6)


def test_loop_competitions(shared_client: httpx.Client, address: str) -> None:
    found = rows(shared_client, address, "loop-competitions")
    assert {row["loops"] for row in found} == {1, 2}
    for row in found:
        assert row["stability"] == ("stable" if row["growth_per_cycle"] < 1.0 else "unstable")


def test_device_effects(shared_client: httpx.Client, shared_settings: Settings, address: str) -> None:
    found = {(row["model"], row["loops"]): row for row in rows(shared_client, address, "device-effects")}
    bare = {**line(), "devices": []}
    without = service.finished(shared_client, shared_settings, {"line": bare, "analysis": {**ANALYSIS, "loops": [1]}})
    for at, name in ((address, "with"), (without, "without")):
        critical = shared_client.get(f"{at}/results/critical-wind-speeds").json()["critical_wind_speeds"]
        onsets = [row["wind_speed_m_per_s"] for row in critical if (row["model"], row["loops"]) == ("hybrid", 1)]
        assert found["hybrid", 1][f"critical_wind_speed_{name}_m_per_s"] == pytest.approx(min(onsets))


def test_placements(shared_client: httpx.Client, placed: str) -> None:
    found = rows(shared_client, placed, "placements")
    assert [row["device"] for row in found] == [0, 1]
    (effect,) = rows(shared_client, placed, "device-effects")
    assert effect["critical_wind_speed_with_m_per_s"] == pytest.approx(found[0]["objective_value"], rel=1e-3)


@pytest.mark.parametrize("table", TABLES)
def test_a_batch_has_these_tables_line_by_line(
    shared_client: httpx.Client, address: str, batch: str, table: TableName
) -> None:
    alone = rows(shared_client, address, table)
    assert alone
    with Client(str(shared_client.base_url)) as client:
        document = client.batch(batch[-36:])
        found, frame = list(client.batch_rows(document, table)), client.batch_frame(document, table)
    assert (list(frame), frame["number"].tolist()) == (list(found[0]), [row["number"] for row in found])
    assert [row["number"] for row in found] == [1] * len(alone) + [2] * len(alone)
    for row, expected in zip(found, alone * 2, strict=True):
        labels = {"number": row["number"], "reference": None, "asset_id": None}
        assert list(row) == [*labels, *expected]
        assert close(row, {**labels, **expected}), row
