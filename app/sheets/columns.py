"""Convert columns with dotted field names to line documents: `span.length_m`, `ice.aerodynamics.vertical.0`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from app.schemas.faults import BadInput, Fault, json_pointer
from app.sheets.cells import WrongCell, value_of
from app.sheets.delimited import SheetRow

_MOST_COLUMNS = 500
_MOST_TOKENS = 8
_MOST_ITEMS = 200
_TEXTS = frozenset({"reference", "name", "asset_id"})
_TEXTS_WITHIN = frozenset({"name", "catalogue"})

Path = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Computed:
    """A value that follows from what was sent: path in the line, value, unit, and the sentence that says whence."""

    path: tuple[str, str]
    value: float
    unit: str
    source: str

    @property
    def name(self) -> str:
        """Dotted name of the field."""
        return ".".join(self.path)


@dataclass(frozen=True, slots=True)
class PlacedLine:
    """A line document, or a `BadInput`, and where in the body it stands: "row 5", "feature 3".

    row: its number in the spreadsheet; faults: of single values; geometry: its coordinates as GeoJSON, to be kept with
    it; computed: what follows from them; sources: what a field was called in the body, by its JSON pointer.
    """

    place: str
    document: object
    faults: tuple[Fault, ...] = ()
    row: int | None = None
    geometry: Mapping[str, Any] | None = None
    computed: tuple[Computed, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Columns:
    """The place of each column's cells in a line document."""

    paths: tuple[Path, ...]

    @classmethod
    def of(cls, header: Sequence[str]) -> "Columns":
        """Read the names in the header.

        Raises
        ------
        BadInput
            If there is no name, or a name is empty, appears twice, or lies within another.
        """
        if not 1 <= len(header) <= _MOST_COLUMNS:
            detail = f"the header must have 1 to {_MOST_COLUMNS} field names, got {len(header)}"
            raise BadInput([Fault("/header", "csv_header", detail)])
        paths = [_path(name.strip()) for name in header]
        faults = [_fault(place, header[place], why) for place, why in enumerate(_wrong(paths)) if why]
        if faults:
            raise BadInput(faults)
        return cls(tuple(paths))

    def line(self, row: SheetRow) -> PlacedLine:
        """Return the document of a row; cells beyond its end are empty, and cells beyond the header must be."""
        if row.fault is not None:
            return _of_row(row, BadInput([Fault("", "csv_invalid", row.fault)]))
        if any(not _is_empty(cell) for cell in row.cells[len(self.paths) :]):
            detail = f"the row has {len(row.cells)} cells, but the header has {len(self.paths)}"
            return _of_row(row, BadInput([Fault("", "csv_row", detail)]))
        document: dict[str | int, Any] = {}
        faults = []
        for path, cell in zip(self.paths, row.cells, strict=False):
            if _is_empty(cell):
                continue
            value = _value(path, cell, row)
            if isinstance(value, WrongCell):
                faults.append(Fault(json_pointer(path), "csv_value", value.sentence))
            else:
                _put(document, path, value)
        return _of_row(row, _with_lists(document), faults)


def _of_row(row: SheetRow, document: object, faults: Sequence[Fault] = ()) -> PlacedLine:
    return PlacedLine(f"row {row.number}", document, tuple(faults), row.number)


def _path(name: str) -> Path:
    tokens = name.split(".")
    if name.startswith("tags."):  # a tag's key may contain dots
        return ("tags", name.partition(".")[2])
    return tuple(int(token) if token.isdecimal() and token.isascii() else token for token in tokens)


def _wrong(paths: Sequence[Path]) -> list[str]:
    """Return for each column what is wrong with its name, an empty text if nothing is."""
    seen: dict[Path, int] = {}
    for path in paths:
        seen[path] = seen.get(path, 0) + 1
    inner = {path[:depth] for path in seen for depth in range(1, len(path))}
    return [_why(path, seen[path], path in inner) for path in paths]


def _why(path: Path, times: int, holds_others: bool) -> str:
    if "" in path or isinstance(path[0], int) or len(path) > _MOST_TOKENS:
        return "is not a dotted field name"
    if any(isinstance(token, int) and token >= _MOST_ITEMS for token in path):
        return f"names an item beyond the {_MOST_ITEMS}th"
    if times > 1:
        return "appears twice"
    return "is given both as a whole and in parts" if holds_others else ""


def _fault(place: int, name: str, why: str) -> Fault:
    return Fault(json_pointer(["header", place]), "csv_header", f"column {name[:100]!r} {why}")


def _put(document: dict[str | int, Any], path: Path, value: object) -> None:
    for token in path[:-1]:
        document = document.setdefault(token, {})
    document[path[-1]] = value


def _is_empty(cell: object) -> bool:
    return cell is None or (isinstance(cell, str) and not cell.strip())


def _value(path: Path, cell: object, row: SheetRow) -> object:
    """Return the text of a text field as it is, otherwise what the cell means; the schema judges what is left."""
    is_text = path[0] in _TEXTS or path[-1] in _TEXTS_WITHIN or (path[0] == "tags" and len(path) > 1)
    if isinstance(cell, str) and is_text:
        return cell
    value = value_of(cell, comma=row.comma, others_comma=row.others_comma)
    return str(value) if is_text and isinstance(value, int | float) else value


def _with_lists(node: Any) -> Any:
    """Convert objects whose keys are numbers to lists; a missing item is null."""
    if not isinstance(node, dict):
        return node
    inner = {key: _with_lists(value) for key, value in node.items()}
    if inner and all(isinstance(key, int) for key in inner):
        return [inner.get(number) for number in range(max(inner) + 1)]
    return {str(key): value for key, value in inner.items()}
