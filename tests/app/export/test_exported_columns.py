from typing import Any, get_args

import pytest

from app import convert
from app.answers.results import ResultDocument
from app.batches import line_results
from app.export.exported_columns import ExportedColumn, axis_columns, exported_columns


@pytest.mark.parametrize("table", [*convert.TABLES, "summary"])
def test_every_column_of_every_table_has_its_kind_and_meaning(table: str) -> None:
    names = line_results.columns(table)
    columns = exported_columns(table, names)
    assert [column.name for column in columns] == names
    assert all(column.description for column in columns)
    for column in columns:
        unit = {"_m": "m", "_hz": "Hz", "_rad": "rad", "_n": "N", "_m_per_s": "m/s", "_n_per_m": "N/m"}
        ends = [text for end, text in sorted(unit.items(), key=lambda item: len(item[0])) if column.name.endswith(end)]
        if ends:
            assert (column.kind, column.unit) == ("number", ends[-1]), column.name


def test_kinds_follow_the_schemas() -> None:
    names = ["loops", "branch", "stability", "vertical_m", "outcome"]
    assert [column.kind for column in exported_columns("limit_cycles", names)] == [
        "integer",
        "integer",
        "text",
        "number",
        "text",
    ]
    assert exported_columns("summary", ["den_hartog_unstable"])[0].kind == "truth"
    assert exported_columns("frequencies", ["number", "vertical_hz"])[1] == ExportedColumn(
        "vertical_hz", "number", "Hz", "Dominantly vertical"
    )


def test_an_unknown_column_is_an_error() -> None:
    with pytest.raises(KeyError):
        exported_columns("frequencies", ["colour"])


def test_axes_have_the_units_of_the_fields_that_they_vary() -> None:
    axes: list[dict[str, Any]] = [
        {"parameter": "span.horizontal_tension_n", "values": [24000, 30000.0]},
        {"parameter": "damping.model", "values": ["constant_ratio"]},
        {"parameter": "devices.0.position_m", "values": [1.0]},
    ]
    assert [(c.name, c.kind, c.unit) for c in axis_columns(axes)] == [
        ("span.horizontal_tension_n", "number", "N"),
        ("damping.model", "text", None),
        ("devices.0.position_m", "number", None),
    ]


@pytest.mark.parametrize("table", convert.TABLES)
def test_tables_of_a_job_have_the_columns_of_their_schema_and_no_others(table: str) -> None:
    row, _ = get_args(ResultDocument.model_fields[table].annotation)
    assert convert.columns(table) == list(row.model_fields)
    assert not {"number", "reference", "asset_id"} & {*convert.columns(table)}  # labels of a batch's lines
