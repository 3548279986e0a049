import io
from collections.abc import Iterator
from typing import Any

import pyarrow.parquet as pq
import pytest

from app.export.exported_columns import ExportedColumn
from app.export.parquet import parquet_bytes

COLUMNS = [
    ExportedColumn("number", "integer", "1", "Number of the line"),
    ExportedColumn("vertical_m", "number", "m", "Vertical amplitude"),
    ExportedColumn("unstable", "truth", None, "Whether"),
    ExportedColumn("kind", "text", None, "Kind"),
]
ROW: dict[str, Any] = {"number": 1, "vertical_m": 0.25, "unstable": True, "kind": "=1+1"}


def written(rows: Any) -> Any:
    return pq.ParquetFile(io.BytesIO(b"".join(parquet_bytes(COLUMNS, rows))))


def test_values_come_back_with_their_types_and_nulls() -> None:
    rows = [ROW, {"number": 2, "vertical_m": 3, "unstable": None}]
    file = written(rows)
    assert [str(field.type) for field in file.schema_arrow] == ["int64", "double", "bool", "string"]
    assert file.read().to_pylist() == [ROW, {"number": 2, "vertical_m": 3.0, "unstable": None, "kind": None}]


def test_fields_carry_unit_and_description() -> None:
    schema = written([]).schema_arrow
    assert schema.field("vertical_m").metadata[b"unit"] == b"m"
    assert schema.field("kind").metadata[b"description"] == b"Kind"
    assert b"unit" not in schema.field("kind").metadata


def test_a_table_without_rows_is_whole() -> None:
    assert written([]).read().num_rows == 0


@pytest.mark.parametrize("count", [10_000, 10_001, 35_000])
def test_rows_are_written_a_group_at_a_time(count: int) -> None:
    pulled = 0

    def rows() -> Iterator[dict[str, Any]]:
        nonlocal pulled
        for number in range(count):
            pulled += 1
            yield {**ROW, "number": number}

    pieces = parquet_bytes(COLUMNS, rows())
    first = next(pieces)
    assert pulled == 10_000  # what the first piece holds is all that was read for it
    file = pq.ParquetFile(io.BytesIO(first + b"".join(pieces)))
    assert file.num_row_groups == -(-count // 10_000)
    assert file.read(["number"]).column("number").to_pylist() == list(range(count))
