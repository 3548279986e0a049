"""Turn a table of hourly weather into a line's climate: the iced hours of the record, event by event."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from datetime import datetime
from typing import Any

from app.schemas.faults import MOST_FAULTS, BadInput, Fault
from app.sheets.cells import WrongCell, value_of
from app.sheets.delimited import SheetRow, read_delimited
from engine.outcome import InvalidSpec
from engine.spec import YEAR_HOURS

_TIME = "time"
# Column of the table -> field of the record, and the numbers that it may hold.
_COLUMNS: Mapping[str, tuple[str, float, float]] = {
    "wind_speed_m_per_s": ("speed", 0.0, 100.0),
    "wind_direction_deg": ("direction", 0.0, 360.0),
    "temperature_c": ("temperature", -90.0, 60.0),
    "precipitation_mm_per_h": ("precipitation", 0.0, 500.0),
    "ice_load_kg_per_m": ("ice_load", 0.0, 100.0),
    "freezing_rain": ("freezing_rain", 0.0, 1.0),
}
_WIND = ("wind_speed_m_per_s", "wind_direction_deg")
_RAIN = ("temperature_c", "precipitation_mm_per_h")
_HOUR = 3600.0
_LONGEST = 200.0 * YEAR_HOURS


def climate_of_weather(raw: bytes, line_azimuth_deg: float, least_thickness_m: float | None = None) -> dict[str, Any]:
    """Return the climate that a table of hourly weather holds.

    Parameters
    ----------
    raw : bytes
        A table with the column `time` (2026-01-31T05:00), wind_speed_m_per_s, wind_direction_deg, and either
        ice_load_kg_per_m, or temperature_c and precipitation_mm_per_h, with or without freezing_rain (1 or 0). An empty
        cell was not measured.
    line_azimuth_deg : float
    least_thickness_m : float, optional
        Thickness from which the line counts as iced.

    Returns
    -------
    dict
        `climate`: for a line, null if no hour was iced; `found`: hours; `criterion`; `notes` on gaps and on the table.

    Raises
    ------
    BadInput
        With the faults of the table, by row as the spreadsheet shows it.
    """
    import numpy as np  # noqa: PLC0415 - as above

    from engine.risk.weather import IcingCriterion, Weather, iced_weather  # noqa: PLC0415 - loads the numerics

    table = read_delimited([raw], _lines)
    names = [name.strip().casefold() for name in table.header]
    _check_header(names)
    columns = _columns(names, table.rows)
    columns["direction"] = [math.radians(value) for value in columns["direction"]]
    azimuth = math.radians(line_azimuth_deg)
    criterion = IcingCriterion()
    if least_thickness_m is not None:
        criterion = replace(criterion, least_thickness=least_thickness_m)
    try:
        weather = Weather(**{name: np.array(values) for name, values in columns.items()})
    except InvalidSpec as error:
        raise BadInput([Fault(f"/{_TIME}", "inconsistent", fault.rule) for fault in error.faults]) from error
    iced = iced_weather(weather, azimuth, criterion)
    record = None if iced.record is None else {"years": iced.record.years, "events": iced.record.events}
    return {
        "climate": None if record is None else {"line_azimuth_deg": line_azimuth_deg, "record": record},
        "found": {name: value for name, value in asdict(iced).items() if name != "record"},
        "criterion": asdict(criterion),
        "notes": [
            *table.notes.sentences(),
            *_notes(iced.observed, iced.missing, iced.gaps, "ice_load_kg_per_m" in names),
        ],
    }


def _lines(pieces: Iterable[bytes], /) -> Any:
    return iter(b"".join(pieces).splitlines(keepends=True))


def _check_header(names: Sequence[str]) -> None:
    faults = [
        Fault("/header", "unknown_field", f"{name!r} is no column; known are {', '.join((_TIME, *_COLUMNS))}")
        for name in names
        if name not in (_TIME, *_COLUMNS)
    ]
    twice = {name for name in names if names.count(name) > 1}
    faults += [Fault("/header", "distinct", f"{name} stands there twice") for name in sorted(twice)]
    needed = [_TIME, *_WIND, *(() if "ice_load_kg_per_m" in names else _RAIN)]
    faults += [Fault("/header", "missing", f"the column {name} is needed") for name in needed if name not in names]
    if faults:
        raise BadInput(faults)


def _columns(names: Sequence[str], rows: Iterable[SheetRow]) -> dict[str, list[float]]:
    """Return the values of all fields of a record, NaN where nothing was measured, and the hours since its start."""
    found: dict[str, list[float]] = {"hour": [], **{field: [] for field, _, _ in _COLUMNS.values()}}
    faults: list[Fault] = []
    start: datetime | None = None
    for row in rows:
        cells = dict(zip(names, row.cells, strict=False))
        try:
            time = _time(row, cells.get(_TIME))
            start = start or time
            found["hour"].append(_hours(row, time, start))
            for name, (field, low, high) in _COLUMNS.items():
                found[field].append(_number(row, name, cells.get(name, ""), (low, high)))
        except BadInput as error:
            faults += error.faults
            if len(faults) >= MOST_FAULTS:
                break
    if faults:
        raise BadInput(faults)
    return found


def _time(row: SheetRow, cell: object) -> datetime:
    if row.fault:
        raise BadInput([Fault(f"/rows/{row.number}", "csv_invalid", row.fault)])
    try:
        return datetime.fromisoformat(str(cell).strip())
    except ValueError as error:
        raise _wrong(row, _TIME, f"must be a time such as 2026-01-31T05:00, got {str(cell)[:40]!r}") from error


def _hours(row: SheetRow, time: datetime, start: datetime) -> float:
    try:
        hours = (time - start).total_seconds() / _HOUR
    except TypeError as error:
        raise _wrong(row, _TIME, "must have an offset from UTC in all rows or in none") from error
    if hours != round(hours) or hours > _LONGEST:
        raise _wrong(row, _TIME, "must be whole hours after the first row, up to 200 years")
    return hours


def _number(row: SheetRow, name: str, cell: object, bounds: tuple[float, float]) -> float:
    if not str(cell).strip():
        return math.nan
    value = value_of(cell, comma=row.comma, others_comma=row.others_comma)
    if isinstance(value, WrongCell):
        raise _wrong(row, name, value.sentence)
    if not isinstance(value, int | float) or not bounds[0] <= value <= bounds[1]:
        raise _wrong(row, name, f"must be a number from {bounds[0]:g} to {bounds[1]:g}, got {str(cell)[:40]!r}")
    return float(value)


def _wrong(row: SheetRow, name: str, sentence: str) -> BadInput:
    return BadInput([Fault(f"/rows/{row.number}/{name}", "invalid", sentence)])


def _notes(observed: int, missing: int, gaps: int, by_load: bool) -> list[str]:
    notes = [f"The record has {observed} hours, {observed / YEAR_HOURS:.2f} years, with all that is needed."]
    if missing:
        notes.append(
            f"{missing} hours in {gaps} gaps are missing: they count neither as iced nor as free of ice. Over up to "
            "six hours in a row the ice stays as it was, over more it is taken to have fallen."
        )
    if not by_load:
        notes.append(
            "Ice is estimated from freezing rain, without snow and rime. Where the record does not say what fell, all "
            "of it from -5 to 0 degrees is taken for freezing rain, which counts snow as ice."
        )
    return notes
