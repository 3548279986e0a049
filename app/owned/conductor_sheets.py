"""Read an owner's conductors from a spreadsheet whose columns declare their units."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app.owned.spreadsheets import Row, Sheet
from app.reference.catalogue_row import CatalogueRow, name_key
from app.schemas.faults import MOST_FAULTS, BadInput, Fault, json_pointer
from app.schemas.units import WrongUnit, in_unit

MOST_ROWS = 1000
MOST_READ = MOST_ROWS + 2
"""Rows of a sheet that are read: one more than conductors and a row of units, which tells that there are too many."""
_SOURCE = "own row"
_STRANDING = re.compile(r"(\d{1,3})\s*/\s*(\d{1,3})")
_DECLARED = re.compile(r"(.*?)\s*[\[(]\s*([^\])]*)\s*[\])]")


@dataclass(frozen=True, slots=True)
class _Quantity:
    """A column of numbers: field of the row, its unit there, smallest and largest plausible value."""

    field: str
    unit: str
    least: float
    most: float


_QUANTITIES: Mapping[str, _Quantity] = {
    "diameter": _Quantity("diameter_m", "m", 1e-3, 0.2),
    "mass": _Quantity("mass_kg_per_m", "kg/m", 0.01, 100.0),
    "area": _Quantity("area_m2", "m2", 1e-6, 0.01),
    "aluminium_area": _Quantity("aluminium_area_m2", "m2", 1e-7, 0.01),
    "aluminium_wire_diameter": _Quantity("aluminium_wire_diameter_m", "m", 1e-4, 0.02),
    "steel_wire_diameter": _Quantity("steel_wire_diameter_m", "m", 1e-4, 0.02),
    "rated_strength": _Quantity("rated_strength_n", "N", 1e2, 1e7),
    "youngs_modulus": _Quantity("youngs_modulus_pa", "Pa", 1e9, 1e12),
    "thermal_expansion": _Quantity("thermal_expansion_per_k", "1/K", 1e-6, 1e-4),
}
_TEXTS = ("name", "designation", "standard", "type", "stranding", "source")
_NEEDED = ("name", "diameter", "mass")
_WORDS: Mapping[str, str] = {
    "code_word": "name",
    "codeword": "name",
    "conductor": "name",
    "kind": "type",
    "weight": "mass",
    "unit_mass": "mass",
    "rts": "rated_strength",
    "uts": "rated_strength",
    "strength": "rated_strength",
    "modulus": "youngs_modulus",
    "e_modulus": "youngs_modulus",
    "expansion": "thermal_expansion",
    "total_area": "area",
    "aluminum_area": "aluminium_area",
    "aluminum_wire_diameter": "aluminium_wire_diameter",
}


@dataclass(frozen=True, slots=True)
class _Column:
    """A column of the sheet: its place, the name of what it holds, and the unit that it declares."""

    place: int
    name: str
    unit: str | None


def read_conductors(sheet: Sheet) -> list[CatalogueRow]:
    """Return the conductors of a sheet; its units stand in the names, `diameter [mm]`, or in a second row.

    Raises
    ------
    BadInput
        With every fault; pointers are `/header/diameter`, or `/rows/7/diameter` with the number that the spreadsheet
        shows.
    """
    columns, rows = _columns(sheet.header, sheet.rows)
    if not 1 <= len(rows) <= MOST_ROWS:
        found = len(rows) if len(rows) <= MOST_ROWS else "more"
        raise BadInput([Fault("", "csv_rows", f"the sheet must have 1 to {MOST_ROWS} conductors, got {found}")])
    faults: list[Fault] = []
    made = [_conductor(row, columns, faults) for row in rows]
    faults += _repeated(rows, columns)
    if faults:
        raise BadInput(faults[:MOST_FAULTS])
    return [row for row in made if row is not None]


def _columns(header: Sequence[str], rows: Sequence[Row]) -> tuple[list[_Column], list[Row]]:
    """Return the columns, and the rows without one that only declares units.

    Raises
    ------
    BadInput
        If a name is not known or is there twice, a needed column is missing, or a number has no unit.
    """
    second = rows[0] if rows and _declares_units(header, rows[0]) else None
    found = []
    for place, text in enumerate(header):
        declared = _DECLARED.fullmatch(text)
        name, unit = (declared[1], declared[2]) if declared else (text, None)
        key = re.sub(r"[\s_-]+", "_", name.strip().casefold())
        if second is not None and unit is None:
            unit = (second.cells[place].strip("[]() ") or None) if place < len(second.cells) else None
        if key:
            found.append(_Column(place, _WORDS.get(key, key), unit))
    faults = [*_wrong_columns(header, found)]
    if faults:
        raise BadInput(faults)
    return found, list(rows if second is None else rows[1:])


def _declares_units(header: Sequence[str], second: Row) -> bool:
    """Tell whether the second row holds units: no cell of it is a number, and the one of the diameter is not empty."""
    numbers = any(_number(cell) is not None for cell in second.cells)
    names = [name.casefold() for name in header]
    place = names.index("diameter") if "diameter" in names else None
    return not numbers and place is not None and place < len(second.cells) and second.cells[place] != ""


def _wrong_columns(header: Sequence[str], columns: Sequence[_Column]) -> list[Fault]:
    faults = []
    names = [column.name for column in columns]
    for column in columns:
        at = json_pointer(["header", header[column.place]])
        if column.name not in _QUANTITIES and column.name not in _TEXTS:
            known = ", ".join((*_TEXTS, *_QUANTITIES))
            faults.append(Fault(at, "csv_header", f"unknown column; the columns are {known}"))
        elif names.count(column.name) > 1:
            faults.append(Fault(at, "csv_header", f"two columns hold {column.name}"))
        elif column.name in _QUANTITIES and column.unit is None:
            unit = _QUANTITIES[column.name].unit
            faults.append(Fault(at, "csv_unit", f"must declare its unit, such as `{column.name} [{unit}]`"))
        elif column.name in _QUANTITIES:
            tried = in_unit({"value": 1.0, "unit": column.unit}, _QUANTITIES[column.name].unit)
            if isinstance(tried, WrongUnit):
                faults.append(Fault(at, "unit", tried.sentence))
    absent = [name for name in _NEEDED if name not in names]
    return [*faults, *(Fault("/header", "csv_header", f"no column {n}") for n in absent)]


def _conductor(row: Row, columns: Sequence[_Column], faults: list[Fault]) -> CatalogueRow | None:
    texts: dict[str, str] = {}
    numbers: dict[str, float | None] = {quantity.field: None for quantity in _QUANTITIES.values()}
    before = len(faults)
    for column in columns:
        cell = row.cells[column.place] if column.place < len(row.cells) else ""
        at = json_pointer(["rows", row.number, column.name])
        if column.name in _TEXTS:
            texts[column.name] = cell
            faults += _text_faults(at, column.name, cell)
        elif cell or column.name in _NEEDED:
            found = _value(cell, column)
            faults += [Fault(at, "csv_value", found)] if isinstance(found, str) else []
            numbers[_QUANTITIES[column.name].field] = None if isinstance(found, str) else found
    return None if len(faults) > before else _made(texts, numbers)


def _text_faults(at: str, name: str, cell: str) -> list[Fault]:
    if name in _NEEDED and not cell:
        return [Fault(at, "missing", "is needed")]
    if len(cell) > 200 or not cell.isprintable():
        return [Fault(at, "csv_value", "must have at most 200 printable characters")]
    if name == "stranding" and cell and not _STRANDING.fullmatch(cell):
        return [Fault(at, "csv_value", f"must be wires of aluminium / of steel, such as 26/7, got {cell!r}")]
    return []


def _value(cell: str, column: _Column) -> float | str:
    """Return the value of a cell in the unit of its field, or the sentence of its fault."""
    number, quantity = _number(cell), _QUANTITIES[column.name]
    if number is None:
        return f"must be a number, got {cell[:40]!r}" if cell else "is needed"
    value = in_unit({"value": number, "unit": column.unit}, quantity.unit)
    if not quantity.least <= value <= quantity.most:
        bounds = f"{quantity.least:g} to {quantity.most:g} {quantity.unit}"
        return f"must be in {bounds}, but {cell} {column.unit} is {value:g} {quantity.unit}"
    return float(value)


def _number(cell: str) -> float | None:
    try:
        number = float(cell)
    except ValueError:
        return None
    return number if abs(number) < float("inf") else None


def _made(texts: Mapping[str, str], numbers: Mapping[str, Any]) -> CatalogueRow:
    wires = _STRANDING.fullmatch(texts.get("stranding", ""))
    return CatalogueRow(
        name=texts["name"],
        designation=texts.get("designation") or texts["name"],
        standard=texts.get("standard") or "",
        type=texts.get("type") or "",
        aluminium_wires=int(wires[1]) if wires else None,
        steel_wires=int(wires[2]) if wires else None,
        source=texts.get("source") or _SOURCE,
        source_address=None,
        licence=None,
        own=True,
        **numbers,
    )


def _repeated(rows: Sequence[Row], columns: Sequence[_Column]) -> list[Fault]:
    (place,) = (column.place for column in columns if column.name == "name")
    seen: dict[str, int] = {}
    faults = []
    for row in rows:
        key = name_key(row.cells[place] if place < len(row.cells) else "")
        if key and key in seen:
            detail = f"row {seen[key]} has this name already"
            faults.append(Fault(json_pointer(["rows", row.number, "name"]), "repeated_name", detail))
        seen.setdefault(key, row.number)
    return faults
