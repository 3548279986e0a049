"""Results as Parquet, streamed: typed columns that carry unit and meaning, with few rows in memory."""

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import pyarrow as pa
from pyarrow.parquet import ParquetWriter

from app.export.exported_columns import ExportedColumn, Kind

_TYPES: Mapping[Kind, pa.DataType] = {
    "number": pa.float64(),
    "integer": pa.int64(),
    "truth": pa.bool_(),
    "text": pa.string(),
}
_ROWS_A_GROUP = 10_000


def parquet_bytes(columns: Sequence[ExportedColumn], rows: Iterable[Mapping[str, Any]]) -> Iterator[bytes]:
    """Yield the pieces of a Parquet file, one row group at a time.

    Parameters
    ----------
    columns : sequence of ExportedColumn
        The unit and the description become metadata of the field under these names.
    rows : iterable of mappings
        Values by the name of their column; an absent value is null.
    """
    schema = pa.schema([_field(column) for column in columns])
    sink = _Sink()
    remaining = iter(rows)
    with ParquetWriter(sink, schema, compression="zstd") as writer:
        while group := list(islice(remaining, _ROWS_A_GROUP)):
            arrays = [pa.array([row.get(field.name) for row in group], field.type) for field in schema]
            writer.write_batch(pa.record_batch(arrays, schema=schema), row_group_size=_ROWS_A_GROUP)
            yield sink.taken()
    yield sink.taken()


class _Sink(io.RawIOBase):
    """Collects written bytes until they are taken."""

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self._position = 0

    def writable(self) -> bool:
        return True

    def tell(self) -> int:
        return self._position

    def write(self, data: Any) -> int:
        piece = bytes(data)
        self._pieces.append(piece)
        self._position += len(piece)
        return len(piece)

    def taken(self) -> bytes:
        """Return the bytes written since the last call."""
        pieces, self._pieces = self._pieces, []
        return b"".join(pieces)


def _field(column: ExportedColumn) -> pa.Field:
    metadata = {"unit": column.unit, "description": column.description}
    return pa.field(column.name, _TYPES[column.kind], metadata={name: text for name, text in metadata.items() if text})
