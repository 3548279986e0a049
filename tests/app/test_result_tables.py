"""One declaration makes a table: its JSON, CSV, Parquet, schema and address follow by its name."""

import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, cast, get_args

import httpx
import orjson
import pyarrow.parquet as pq
import pytest
from pydantic import ValidationError

from app import convert
from app.answers.batches import BatchTableName
from app.answers.results import ResultDocument, TableName
from app.answers.rows import row_schema, with_tables
from app.convert.run import point_results, specification_of_point
from app.export.exported_columns import exported_columns
from app.export.formats import csv_text
from app.export.parquet import parquet_bytes
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.schemas.fields import Answer
from engine import result
from engine.outcome import Stability
from engine.result import Column, DenHartog, Result, StaticState, Table, Title, tables_of
from tests.app import service


@dataclass(frozen=True, slots=True)
class SwayRow:
    """How far the span sways.

    What follows the first paragraph is for readers of the code.
    """

    loops: Annotated[int, Column("Loops per span", 1, unit="1")]
    sway_m: Annotated[float | None, Column("Sway; null at rest", 0.25, unit="m")]
    pace: Annotated[Literal["slow", "fast"], Column("How it sways", "slow")]
    stability: Annotated[Stability, Column("Whether it lasts", "stable")]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Swaying(Result):
    sways: Annotated[tuple[SwayRow, ...], Title("How far the span sways")] = ()


@pytest.fixture
def sways(monkeypatch: pytest.MonkeyPatch) -> Iterator[Table]:
    """Declare one table more for a while."""
    table = Table("sways", "How far the span sways", SwayRow)
    monkeypatch.setitem(cast("dict[str, Table]", result.TABLES), "sways", table)
    yield table


def found() -> Any:
    (point,) = point_results([(0, {})], [_LINE], [_SWAYING])
    return orjson.loads(point.tables_json)["sways"]


_LINE = specification_of_point({"line": example("c11-twin")}, 0)[0]
_SWAYING = _Swaying(
    static=StaticState(30000.0, 1285.0, 1.5, None, None),
    den_hartog=DenHartog(-0.2, True),
    orbits=(),
    warnings=(),
    engine_version="0",
    sways=(SwayRow(1, 0.5, "fast", Stability.STABLE), SwayRow(2, None, "slow", Stability.UNKNOWN)),
)
ROWS: list[dict[str, Any]] = [
    {"loops": 1, "sway_m": 0.5, "pace": "fast", "stability": "stable"},
    {"loops": 2, "sway_m": None, "pace": "slow", "stability": "unknown"},
]


def test_json_follows(sways: Table) -> None:
    assert found() == ROWS
    assert convert.example_tables()["sways"] == [{"loops": 1, "sway_m": 0.25, "pace": "slow", "stability": "stable"}]


def test_csv_follows(sways: Table) -> None:
    text = "".join(csv_text(convert.columns("sways"), ROWS))
    assert text == "loops,sway_m,pace,stability\r\n1,0.5,fast,stable\r\n2,,slow,unknown\r\n"


def test_parquet_follows_with_units(sways: Table) -> None:
    columns = exported_columns("sways", convert.columns("sways"))
    read = pq.read_table(io.BytesIO(b"".join(parquet_bytes(columns, ROWS))))
    assert read.to_pylist() == ROWS
    assert read.schema.field("sway_m").metadata == {b"unit": b"m", b"description": b"Sway; null at rest"}


def test_the_schema_follows_with_description_unit_and_example(sways: Table) -> None:
    document = with_tables(Answer, {"sways": sways})
    schema = document.model_json_schema()
    assert schema["properties"]["sways"]["description"] == "How far the span sways"
    row = schema["$defs"]["Sway"]
    assert row["description"] == "How far the span sways."
    assert list(row["properties"]) == row["required"] == convert.columns("sways")
    assert row["properties"]["sway_m"] == {
        "anyOf": [{"type": "number"}, {"type": "null"}],
        "description": "Sway; null at rest [m]",
        "examples": [0.25],
        "title": "Sway M",
        "x-unit": "m",
    }
    assert row["properties"]["stability"]["enum"] == ["stable", "unstable", "unknown"]
    read: Any = document.model_validate({"sways": found()})
    assert read.sways[0].stability is Stability.STABLE
    assert read.model_dump(mode="json") == {"sways": ROWS}


def test_a_row_stored_before_a_column_was_declared_is_read_with_null() -> None:
    schema = row_schema(SwayRow)
    old = {name: value for name, value in ROWS[0].items() if name != "sway_m"}
    assert schema.model_validate_json(orjson.dumps(old)).model_dump(mode="json") == {**ROWS[0], "sway_m": None}
    with pytest.raises(ValidationError, match="pace"):
        schema.model_validate({"loops": 1, "stability": "stable"})


def test_a_table_without_title_and_a_column_without_declaration_are_refused() -> None:
    @dataclass
    class Bare:
        sways: tuple[SwayRow, ...]

    with pytest.raises(TypeError, match="no Title"):
        tables_of(Bare)
    with pytest.raises(TypeError, match="no Column"):
        result.columns_of(Bare)


def test_every_table_has_an_address_and_a_place_in_the_result_document() -> None:
    assert list(convert.TABLES) == [name.replace("-", "_") for name in get_args(TableName)]
    assert get_args(BatchTableName) == (*get_args(TableName), "summary")
    assert [name for name in ResultDocument.model_fields if name in convert.TABLES] == list(convert.TABLES)


def test_every_table_is_served_at_its_address(shared_client: httpx.Client, shared_settings: Settings) -> None:
    job = service.finished(shared_client, shared_settings)
    whole = shared_client.get(f"{job}/results").json()
    for address, name in convert.TABLES_BY_ADDRESS.items():
        assert shared_client.get(f"{job}/results/{address}").json() == {name: whole[name]}
        header = shared_client.get(f"{job}/results/{address}?format=csv").text.partition("\r\n")[0]
        assert header.split(",") == convert.columns(name)
    assert shared_client.get(f"{job}/results/sways").status_code == 404
