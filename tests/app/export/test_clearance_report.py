from app import convert
from app.export.clearance_report import COLUMNS, report_rows


def test_rows_have_the_figures_of_the_table_under_the_names_of_reports() -> None:
    row = convert.example_row(convert.TABLES["clearances"].row) | {"major_axis_m": 5.0, "b_distance_m": 1.5}
    line = {"name": "North 4", "asset_id": "L204", "tags": {"structure": "T17", "set": "2"}}
    (made,) = report_rows(line, [row])
    assert set(made) == set(COLUMNS)
    assert (made["structure"], made["set"], made["phase"], made["other_phase"]) == ("T17", "2", "this", "top")
    assert (made["distance"], made["margin"]) == (row["distance_m"], row["margin_m"])
    assert (made["major_axis_length"], made["b_distance"]) == (5.0, 1.5)
    assert (made["galloping_ellipse_method"], made["wind_from"]) == (row["method"], "left")


def test_without_a_tag_the_structure_is_the_asset_or_the_name() -> None:
    row = convert.example_row(convert.TABLES["clearances"].row)
    for line, expected in (({"asset_id": "L204", "name": "N"}, "L204"), ({"name": "N"}, "N"), ({}, None)):
        assert next(report_rows(line, [row]))["structure"] == expected
