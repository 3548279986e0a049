"""Convert files, iterables and data frames to bodies that can be sent again."""

import json
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Union
from urllib.parse import urlencode

from pydantic import BaseModel

from app.schemas import Line

if TYPE_CHECKING:
    import pandas as pd

Lines = Union[Iterable[Line | Mapping[str, Any]], Path, str, "pd.DataFrame"]

_IN_MEMORY_BYTES = 4_000_000
_TYPES = {
    ".csv": "text/csv",
    ".ndjson": "application/x-ndjson",
    ".jsonl": "application/x-ndjson",
    ".json": "application/json",
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    ".geojson": "application/geo+json",
    ".rdf": "application/rdf+xml",
    ".xml": "application/rdf+xml",
}
_ADDRESSED = (".csv", ".xlsx", ".geojson", ".rdf", ".xml")


@dataclass(frozen=True, slots=True)
class Upload:
    """A body with its headers and query parameters."""

    file: IO[bytes]
    headers: Mapping[str, str]
    parameters: Mapping[str, str] = field(default_factory=dict)

    def query(self, atomic: bool) -> str:
        """Return the query string of the address."""
        return urlencode({**self.parameters, **({"atomic": "true"} if atomic else {})})


def as_json(part: BaseModel | Mapping[str, Any]) -> dict[str, Any]:
    """Return a document as JSON-compatible values."""
    return (
        part.model_dump(mode="json", by_alias=True, exclude_unset=True) if isinstance(part, BaseModel) else dict(part)
    )


@contextmanager
def opened(lines: Lines, analysis: Mapping[str, Any], defaults: Mapping[str, Any] | None = None) -> Iterator[Upload]:
    """Yield the body of a batch, in a file that moves to disk if it is large.

    Raises
    ------
    ValueError
        If a file's suffix is unknown, or an analysis or defaults are given for a file that contains them.
    OSError
        If the file cannot be read.
    """
    if isinstance(lines, (str, Path)):
        headers, parameters = _of_file(Path(lines), analysis, defaults)
        with Path(lines).open("rb") as file:
            yield Upload(file, headers, parameters)
        return
    with tempfile.SpooledTemporaryFile(_IN_MEMORY_BYTES) as spool:
        frame: Any = lines if hasattr(lines, "to_csv") else None
        if frame is not None:
            _of_cells(frame).to_csv(spool, index=any(name is not None for name in frame.index.names))
            yield Upload(spool, {"Content-Type": _TYPES[".csv"]}, _parameters(analysis, defaults))
            return
        for document in _documents(lines, analysis, defaults):
            spool.write(json.dumps(document).encode() + b"\n")
        yield Upload(spool, {"Content-Type": _TYPES[".ndjson"]})


def _of_cells(frame: Any) -> Any:
    """Return a frame whose lists, arrays and objects, such as devices, are JSON as cells hold it."""
    return frame.apply(lambda column: column.map(_cell))


def _cell(cell: Any) -> Any:
    if isinstance(cell, (list, tuple, dict)) or getattr(cell, "ndim", False):
        return json.dumps(cell, default=lambda array: array.tolist())  # Parquet's lists are read as arrays
    return cell


def frame(rows: Iterable[Mapping[str, Any]]) -> "pd.DataFrame":
    """Return rows as a data frame.

    Raises
    ------
    ImportError
        If pandas is not installed (extra `galloping[pandas]`).
    """
    import pandas as pd  # noqa: PLC0415 - optional, and slow to load

    return pd.DataFrame.from_records(list(rows))


def _documents(
    lines: Iterable[Any], analysis: Mapping[str, Any], defaults: Mapping[str, Any] | None
) -> Iterator[dict[str, Any]]:
    yield {"analysis": analysis} | ({"defaults": defaults} if defaults else {})
    for line in lines:
        yield as_json(line)


def _parameters(analysis: Mapping[str, Any], defaults: Mapping[str, Any] | None) -> dict[str, str]:
    return {"analysis": json.dumps(analysis)} | ({"defaults": json.dumps(defaults)} if defaults else {})


def _of_file(
    path: Path, analysis: Mapping[str, Any], defaults: Mapping[str, Any] | None
) -> tuple[dict[str, str], dict[str, str]]:
    """Return the headers and the query parameters for a file."""
    packed = path.suffix.lower() == ".gz"
    suffix = (path.with_suffix("").suffix if packed else path.suffix).lower()
    if suffix not in _TYPES:
        raise ValueError(f"{path.name} must end in one of {', '.join(_TYPES)}, followed by .gz if it is compressed")
    given = [name for name, part in (("analysis", analysis), ("defaults", defaults)) if part]
    if given and suffix not in _ADDRESSED:
        raise ValueError(f"{path.name} contains its {given[0]}, so no other can be given")
    headers = {"Content-Type": _TYPES[suffix]} | ({"Content-Encoding": "gzip"} if packed else {})
    if suffix not in _ADDRESSED or (suffix == ".geojson" and not given):  # features may bring their own
        return headers, {}
    return headers, _parameters(analysis, defaults)
