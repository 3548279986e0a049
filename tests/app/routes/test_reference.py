import httpx

from app import convert
from app.answers.reference import ConductorList, FieldList, IceShapeList, TableList, Version
from app.convert import ENGINE_VERSION
from app.runtime.version import SERVICE_VERSION
from app.schemas.field_table import all_fields


def test_the_versions_are_told(shared_client: httpx.Client) -> None:
    found = Version.model_validate_json(shared_client.get("/v1/version").content)
    assert (found.service, found.engine, found.api) == (SERVICE_VERSION, ENGINE_VERSION, "v1")


def test_conductors_are_sought_by_words(shared_client: httpx.Client) -> None:
    answer = shared_client.get("/v1/conductors", params={"search": "acsr drake"})
    assert answer.status_code == 200
    (row,) = ConductorList.model_validate_json(answer.content).conductors
    assert row.diameter_m == 0.02814
    assert len(shared_client.get("/v1/conductors").json()["conductors"]) > 50
    assert shared_client.get("/v1/conductors", params={"search": "x" * 101}).status_code == 400


def test_ice_shapes_are_listed_with_source_and_caveats(shared_client: httpx.Client) -> None:
    shapes = IceShapeList.model_validate_json(shared_client.get("/v1/ice-shapes").content).ice_shapes
    assert [shape.name for shape in shapes] == ["c11-40", "c11-270"]
    assert all(shape.source and shape.caveats for shape in shapes)


def test_fields_are_the_table_of_the_schemas(shared_client: httpx.Client) -> None:
    answer = shared_client.get("/v1/fields")
    FieldList.model_validate_json(answer.content)
    assert answer.json()["fields"] == list(all_fields())


def test_tables_are_listed_with_every_column(shared_client: httpx.Client) -> None:
    found = TableList.model_validate_json(shared_client.get("/v1/tables").content).tables
    assert {table.name: [column.name for column in table.columns] for table in found} == {
        name: convert.columns(name) for name in convert.TABLES
    }
    (cycles,) = (table for table in found if table.address == "limit-cycles")
    (vertical,) = (column for column in cycles.columns if column.name == "vertical_m")
    assert (vertical.kind, vertical.unit, vertical.description) == ("number", "m", "Vertical amplitude")
