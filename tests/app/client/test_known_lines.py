"""The client's methods about catalogues and lines as engineers know them, against the real service."""

from collections.abc import Iterator

import httpx
import pytest

from app.client import Client, Refused
from app.reference.ice_shapes import ICE_SHAPES
from app.routes.own_documentation import KNOWN_LINE, OWN_TABLE, SHEET
from app.runtime.settings import Settings
from app.schemas.known import KnownLine
from tests.app import service
from tests.app.known_documents import CONTRACT
from tests.app.lines import SHORT


@pytest.fixture
def client(own_client: httpx.Client) -> Iterator[Client]:
    """Give a client of a service of this test's own."""
    with Client(str(own_client.base_url)) as made:
        yield made


def test_a_line_is_resolved_with_typed_assumptions(client: Client) -> None:
    resolved = client.resolve(KNOWN_LINE)
    assert client.resolve(KnownLine.model_validate(KNOWN_LINE)) == resolved
    row = next(row for row in resolved.assumptions if row.path == "damping.vertical_ratio")
    assert row.origin == "assumed"
    assert row.lowest is not None and row.highest is not None
    assert row.lowest < resolved.line["damping"]["vertical_ratio"] < row.highest
    with pytest.raises(Refused) as caught:
        client.resolve({**KNOWN_LINE, "conductor": {"catalogue": "Drak"}})
    assert [fault.pointer for fault in caught.value.faults] == ["/conductor/catalogue"]


def test_catalogues_are_read(client: Client) -> None:
    assert [row.name for row in client.conductors("drake")] == ["Drake"]
    assert [row.name for row in client.ice_shapes()] == [shape.name for shape in ICE_SHAPES]


def test_own_rows_are_stored_named_and_removed(client: Client) -> None:
    (kept,) = client.store_conductors(SHEET).conductors
    assert kept.conductor.diameter_m == 0.02811
    line = {**KNOWN_LINE, "conductor": {"catalogue": "own drake"}}
    assert client.resolve(line).line["conductor"]["diameter_m"] == 0.02811
    table = client.store_table(OWN_TABLE["table"])
    assert [row.id for row in client.own_tables()] == [table.id]
    assert [row.id for row in client.own_conductors()] == [kept.id]
    client.remove_own("conductors", kept.id)
    client.remove_own("aerodynamics", table.id)
    assert client.own_conductors() == []
    assert client.own_tables() == []


def test_lines_of_a_batch_are_ranked_by_risk(client: Client, own_client: httpx.Client, own_settings: Settings) -> None:
    calm = {**CONTRACT["climate"], "icing": [{"kind": "glaze", "hours_a_year": 4.0}]}
    lines = [{**CONTRACT, "climate": calm, "reference": "calm"}, {**CONTRACT, "reference": "icy"}]
    batch = client.submit_batch(lines, {**SHORT, "risk": True})
    service.work_off(own_client, own_settings, f"/v1/batches/{batch.id}")
    ranked = list(client.ranking(client.batch(batch.id), by="risk", limit=1))
    assert [(row.rank, row.reference) for row in ranked] == [(1, "icy"), (2, "calm")]
