import pytest

from app.pages.measures import FEET, SI
from app.pages.shown_tables import column_name, shown_table

ROW = {"model": "finite_element", "loops": 2, "vertical_hz": 0.48161, "outcome": "no_convergence"}


def test_rows_are_in_words_and_in_the_units_of_the_reader() -> None:
    table = shown_table("frequencies", ["model", "loops", "vertical_hz", "outcome"], [ROW], SI)
    assert [list(row) for row in table.rows] == [["finite elements", "2", "0.482", "did not converge"]]
    assert [column.name for column in table.columns] == ["Model", "Loops", "Vertical", "Outcome"]
    assert [column.unit for column in table.columns] == ["", "", "Hz", ""]
    speeds = shown_table("critical_wind_speeds", ["wind_speed_m_per_s"], [{"wind_speed_m_per_s": 4.4704}], FEET)
    assert (speeds.columns[0].unit, speeds.rows[0][0]) == ("mph", "10.0")
    kept = shown_table("clearances", ["ok"], [{"ok": True}, {"ok": None}], SI)
    assert [row[0] for row in kept.rows] == ["yes", "\N{EN DASH}"]


def test_a_column_that_is_not_there_is_a_defect() -> None:
    with pytest.raises(KeyError):
        shown_table("frequencies", ["colour"], [], SI)
    assert column_name("any_new_name_m") == "any new name"
