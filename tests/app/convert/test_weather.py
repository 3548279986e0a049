"""Climates from tables of hourly weather: what is read, what is counted, and what is refused by row."""

import math
from typing import Any

import pytest

from app import convert
from app.convert.weather import climate_of_weather
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from tests.app.lines import SHORT

HEADER = "time,wind_speed_m_per_s,wind_direction_deg,temperature_c,precipitation_mm_per_h"


def rows(count: int, wet: range = range(2, 4)) -> list[str]:
    """Return hours of frost, some of them with freezing rain, and a wind of 5 m/s from the west."""
    return [f"2026-01-{1 + h // 24:02d}T{h % 24:02d}:00,5,270,-2,{4.0 if h in wet else 0}" for h in range(count)]


def found(lines: list[str], header: str = HEADER, azimuth: float = 0.0) -> dict[str, Any]:
    return climate_of_weather("\n".join([header, *lines]).encode(), azimuth)


def refused(lines: list[str], header: str = HEADER) -> list[str]:
    with pytest.raises(BadInput) as caught:
        found(lines, header)
    return [f"{fault.pointer} {fault.detail}" for fault in caught.value.faults]


def test_iced_hours_are_counted_with_the_wind_across_the_line() -> None:
    answer = found(rows(30), azimuth=30.0)
    record = answer["climate"]["record"]
    assert record["years"] == pytest.approx(30.0 / 8766.0)
    assert [len(winds) for winds in record["events"]] == [28]
    assert record["events"][0][0] == pytest.approx(5.0 * math.sin(math.radians(240.0)) * -1.0)
    assert answer["found"] == {"observed": 30, "missing": 0, "gaps": 0, "iced": 28, "thickest": pytest.approx(2.24e-3)}
    assert answer["criterion"]["radial_share"] == 0.28


def test_gaps_and_a_european_sheet_are_said() -> None:
    european = [line.replace(",", ";").replace(";-2;", ";-2,5;") for line in rows(30)]
    del european[10:20]
    european[5] = european[5].replace(";5;270;", ";;270;")
    answer = found(european, HEADER.replace(",", ";"))
    assert (answer["found"]["missing"], answer["found"]["gaps"], answer["found"]["observed"]) == (11, 2, 19)
    notes = " ".join(answer["notes"])
    assert "Cells are separated by semicolons. Decimal commas were read as decimal points." in notes
    assert "11 hours in 2 gaps are missing" in notes


def test_without_icing_there_is_no_climate() -> None:
    assert found(rows(30, wet=range(0)))["climate"] is None


def test_an_ice_load_needs_neither_temperature_nor_precipitation() -> None:
    header = "time,wind_speed_m_per_s,wind_direction_deg,ice_load_kg_per_m"
    lines = [f"2026-01-01T{h:02d}:00,5,270,{0.5 if h > 3 else 0}" for h in range(9)]
    assert found(lines, header)["found"]["iced"] == 5


def test_faults_name_the_row_as_the_spreadsheet_shows_it() -> None:
    lines = rows(5)
    lines[1] = "yesterday,5,270,-2,0"
    lines[2] = lines[2].replace(",270,", ",400,")
    lines[3] = lines[3].replace(":00,", ":30,")
    assert refused(lines) == [
        "/rows/3/time must be a time such as 2026-01-31T05:00, got 'yesterday'",
        "/rows/4/wind_direction_deg must be a number from 0 to 360, got '400'",
        "/rows/5/time must be whole hours after the first row, up to 200 years",
    ]
    assert refused([lines[0], lines[0]]) == ["/time must rise from row to row, one row an hour"]
    assert refused([], HEADER.replace("temperature_c", "temp")) == [
        f"/header 'temp' is no column; known are time, {', '.join(KNOWN)}",
        "/header the column temperature_c is needed",
    ]


KNOWN = (
    "wind_speed_m_per_s",
    "wind_direction_deg",
    "temperature_c",
    "precipitation_mm_per_h",
    "ice_load_kg_per_m",
    "freezing_rain",
)


def test_a_line_takes_the_climate_and_counts_the_hours_above_its_onset() -> None:
    answer = found(rows(30))
    line = {**example("c11-twin"), "climate": _as_json(answer["climate"])}
    request = convert.read({"line": line, "analysis": SHORT})
    (point,) = [item for item in convert.run(request.kept()) if isinstance(item, convert.PointResult)]
    row = point.tables["risk"][0]
    years = answer["climate"]["record"]["years"]
    assert row["hours_a_year"] == pytest.approx(28.0 / years)  # 5 m/s is above the onset
    assert row["hours_lowest"] < row["hours_a_year"] < row["hours_highest"]


def _as_json(climate: dict[str, Any]) -> dict[str, Any]:
    return {**climate, "record": {**climate["record"], "events": [list(w) for w in climate["record"]["events"]]}}
