from app.pages.findings import Findings


def test_findings_hold_the_tables_of_the_point(found: Findings) -> None:
    assert found.here["static"]["sag_m"] > 1.0
    assert found.verdict is not None
    assert found.verdict["gallops"] == "yes"
    assert {row["wind_speed_m_per_s"] for row in found.rows("limit_cycles")} == {4.0, 8.0}
    assert found.rows("no_such_table") == ()
    assert found.line["span"]["length_m"] == 300.0
    assert found.analysis["loops"] == [1]
