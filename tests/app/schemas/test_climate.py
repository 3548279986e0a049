"""The climate of a line in requests: its faults with pointers, and what an analysis makes of it."""

import math
from typing import Any

import pytest

from app import convert
from app.reference.source_lines import example
from tests.app.lines import SHORT, changed, faults

CLIMATE: dict[str, Any] = {
    "line_azimuth_deg": 90.0,
    "sectors": [
        {"direction_deg": 0.0, "width_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}
    ],
    "icing": [{"kind": "glaze", "hours_a_year": 40.0}],
}
LINE = {**example("c11-twin"), "climate": CLIMATE}


@pytest.mark.parametrize(
    ("path", "value", "pointer", "word"),
    [
        ("sectors.0.share", 100.0, "/line/climate/sectors", "percent: 12 % is 0.12"),
        ("sectors.0.share", 0.9, "/line/climate/sectors", "sum to 1"),
        ("sectors.0.weibull_shape", -2.0, "/line/climate/sectors/0/weibull_shape", "greater than or equal"),
        (
            "sectors.0.weibull_scale_lowest_m_per_s",
            7.0,
            "/line/climate/sectors/0/weibull_scale_lowest_m_per_s",
            "must not exceed the value (6)",
        ),
        ("icing.0.event_hours", 5.0, "/line/climate/icing/0", "either hours, or events with event_hours"),
        ("icing.0.events_a_year_lowest", 5.0, "/line/climate/icing/0", "events_a_year is needed for its ends"),
        ("icing.0.hours_a_year", 8780.0, "/line/climate/icing", "longer than the year"),
    ],
)
def test_faults_name_field_and_rule(path: str, value: object, pointer: str, word: str) -> None:
    found = faults({"line": changed(f"climate.{path}", value, LINE), "analysis": SHORT})
    assert [fault.pointer for fault in found if word in fault.detail] == [pointer]


def test_a_risk_needs_a_climate() -> None:
    (fault,) = faults({"line": example("c11-twin"), "analysis": {**SHORT, "risk": True}})
    assert (fault.pointer, fault.detail) == ("/line/climate", "must be given for a risk")
    assert convert.read_analysis({**SHORT, "risk": True}).risk is True


def risk_of(document: dict[str, Any]) -> list[dict[str, Any]]:
    (point,) = [item for item in convert.run(document) if isinstance(item, convert.PointResult)]
    assert point.failure is None
    rows: list[dict[str, Any]] = point.tables["risk"]
    onset = min(row["wind_speed_m_per_s"] for row in point.tables["critical_wind_speeds"])
    return [{**row, "onset": onset} for row in rows]


def test_an_analysis_of_a_line_with_a_climate_has_its_risk() -> None:
    row = risk_of({"line": LINE, "analysis": SHORT})[0]
    share = math.exp(-((row["onset"] / 6.0) ** 2)) - math.exp(-((30.0 / 6.0) ** 2))
    assert (row["model"], row["loops"], row["ice"]) == ("hybrid", 1, "glaze")
    assert row["hours_a_year"] == pytest.approx(40.0 * share, rel=1e-12)
    assert risk_of({"line": LINE, "analysis": {**SHORT, "risk": False}}) == []
    assert risk_of({"line": example("c11-twin"), "analysis": SHORT}) == []


def test_a_study_may_vary_the_climate() -> None:
    axis = {"parameter": "climate.icing.0.hours_a_year", "values": [20.0, 9000.0]}
    found = faults({"line": LINE, "analysis": SHORT, "study": {"axes": [axis]}})
    assert [fault.pointer for fault in found] == ["/study/axes/0/values/1"]
