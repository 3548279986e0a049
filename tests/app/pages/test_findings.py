from app.pages.findings import Findings, with_axes


def test_findings_hold_the_tables_of_the_point(found: Findings) -> None:
    assert found.here["static"]["sag_m"] > 1.0
    assert found.verdict is not None
    assert found.verdict["gallops"] == "yes"
    assert {row["wind_speed_m_per_s"] for row in found.rows("limit_cycles")} == {4.0, 8.0}
    assert found.rows("no_such_table") == ()
    assert found.line["span"]["length_m"] == 300.0
    assert found.analysis["loops"] == [1]


def test_the_line_of_a_point_has_the_values_of_the_study() -> None:
    line = {"span": {"length_m": 100.0}, "devices": [{"mass_kg": 1.0}]}
    made = with_axes(line, {"span.length_m": 120.0, "devices.0.mass_kg": 2.0})
    assert made == {"span": {"length_m": 120.0}, "devices": [{"mass_kg": 1.0}]}
    assert line["span"] == {"length_m": 100.0}
