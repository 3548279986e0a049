from typing import Any

import pytest

from app import convert
from app.convert import Advance, PointResult
from app.reference.source_lines import example
from engine.outcome import InvalidSpec
from tests.app.lines import FULL_LINE, SHORT, changed


def results(document: dict[str, Any]) -> tuple[list[PointResult], list[Advance]]:
    items = list(convert.run(document))
    return [i for i in items if isinstance(i, PointResult)], [i for i in items if isinstance(i, Advance)]


def test_the_twin_gives_the_figures_of_the_theory() -> None:
    (point,), advances = results({"line": example("c11-twin"), "analysis": SHORT})
    assert point.failure is None
    assert point.static["horizontal_tension_n"] == 30000.0
    assert point.den_hartog == {"coefficient": -0.1667, "unstable": True}
    (frequencies,) = point.tables["frequencies"]
    assert frequencies["vertical_hz"] == pytest.approx(0.482, rel=0.01)
    assert point.tables["critical_wind_speeds"][0]["wind_speed_m_per_s"] == pytest.approx(2.403, rel=0.005)
    cycles = [row for row in point.tables["limit_cycles"] if row["kind"] == "periodic"]
    assert [row["vertical_m"] for row in cycles] == [pytest.approx(0.1568, rel=0.01), pytest.approx(0.2884, rel=0.01)]
    assert {row["stability"] for row in cycles} == {"stable"}
    assert [orbit["cycle"] for orbit in point.orbits] == [
        number for number, row in enumerate(point.tables["limit_cycles"]) if row["kind"] == "periodic"
    ]
    fractions = [advance.fraction for advance in advances]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


def test_rows_hold_nothing_but_what_json_can_carry() -> None:
    (point,), _ = results({"line": example("c11-single"), "analysis": SHORT})
    rows = [row for rows in point.tables.values() for row in rows]
    kinds = {type(value) for row in rows for value in row.values()}
    assert {str, int, float, type(None)} <= kinds <= {str, int, float, bool, type(None)}
    assert {type(number) for orbit in point.orbits for number in orbit["vertical"]} == {float}


def test_columns_are_those_of_the_rows() -> None:
    (point,), _ = results({"line": example("c11-twin"), "analysis": SHORT})
    for table in ("frequencies", "critical_wind_speeds", "limit_cycles"):
        assert {tuple(row) for row in point.tables[table]} == {tuple(convert.columns(table))}
    assert convert.columns("bifurcations")[:3] == ["model", "loops", "branch"]


def test_a_study_runs_every_combination_with_the_last_axis_fastest() -> None:
    axes = [
        {"parameter": "span.horizontal_tension_n", "values": [24000.0, 36000.0]},
        {"parameter": "damping.vertical_ratio", "values": [0.0005, 0.001]},
    ]
    analysis = {**SHORT, "wind_speeds_m_per_s": []}
    points, advances = results({"line": example("c11-twin"), "analysis": analysis, "study": {"axes": axes}})
    assert [tuple(point.axes.values()) for point in points] == [
        (24000.0, 0.0005),
        (24000.0, 0.001),
        (36000.0, 0.0005),
        (36000.0, 0.001),
    ]
    assert [point.static["horizontal_tension_n"] for point in points] == [24000.0, 24000.0, 36000.0, 36000.0]
    onset = [point.tables["critical_wind_speeds"][0]["wind_speed_m_per_s"] for point in points]
    assert onset[0] < onset[1]
    assert advances[-1].fraction == 1.0


def test_fields_that_follow_an_axis_take_its_values() -> None:
    axis = {"parameter": "damping.vertical_ratio", "also": ["damping.horizontal_ratio"], "values": [1e-3]}
    analysis = {**SHORT, "wind_speeds_m_per_s": [], "loops": [2]}
    (tied,), _ = results({"line": example("c11-twin"), "analysis": analysis, "study": {"axes": [axis]}})
    line = changed("damping.vertical_ratio", 1e-3, changed("damping.horizontal_ratio", 1e-3, example("c11-twin")))
    (given,), _ = results({"line": line, "analysis": analysis})
    assert tied.tables == given.tables
    assert tied.axes == {"damping.vertical_ratio": 1e-3}


def followed(parameter: str, values: list[float], line: dict[str, Any]) -> list[convert.PointResult]:
    """Run a study that follows one field of a line, one loop at 6 m/s."""
    study = {"axes": [{"parameter": parameter, "values": values}], "follow": True}
    analysis = {"models": ["hybrid"], "loops": [1], "wind_speeds_m_per_s": [6.0]}
    points, advances = results({"line": line, "analysis": analysis, "study": study})
    assert advances[-2].step == "branches over the field"
    assert advances[-1].fraction == 1.0
    return points


def test_a_study_follows_its_cycles_whatever_the_order_of_the_values() -> None:
    points = followed("damping.vertical_ratio", [3e-3, 5e-4, 1e-3], example("c11-twin"))
    assert {point.axes["damping.vertical_ratio"]: len(point.tables["followed_cycles"]) for point in points} == {
        5e-4: 1,
        1e-3: 1,
        3e-3: 0,
    }
    for point in points:
        for cycle in point.tables["followed_cycles"]:
            assert list(cycle) == convert.columns("followed_cycles")
            (own,) = (row for row in point.tables["limit_cycles"] if row["kind"] == "periodic")
            assert cycle["vertical_m"] == pytest.approx(own["vertical_m"], rel=1e-3)
    (hopf,) = (row for point in points for row in point.tables["followed_bifurcations"])
    assert (hopf["type"], hopf["branch"]) == ("hopf", 0)
    assert 1e-3 < hopf["value"] < 3e-3


def test_a_point_that_fails_does_not_end_the_branches_of_its_study() -> None:
    points = followed("damping.vertical_ratio", [5e-4, -1.0, 1e-3], example("c11-twin"))
    assert sorted(len(point.tables["followed_cycles"]) for point in points) == [0, 1, 1]


@pytest.mark.parametrize(("parameter", "values"), [("span.elements", [10, 12]), ("bundle.subconductors", [2, 3])])
def test_a_field_of_whole_numbers_is_not_followed(parameter: str, values: list[float]) -> None:
    points = followed(parameter, values, example("c11-twin"))
    assert [point.failure for point in points] == [None, None]
    bifurcations = [row for point in points for row in point.tables["followed_bifurcations"]]
    assert bifurcations == []


def test_a_point_that_fails_does_not_end_its_study() -> None:
    line = changed("devices", FULL_LINE["devices"][:1], example("c11-twin"))
    axis = {"parameter": "devices.0.position_m", "values": [20.0, 200.0, 30.0]}
    points, _ = results({"line": line, "analysis": {**SHORT, "wind_speeds_m_per_s": []}, "study": {"axes": [axis]}})
    assert [point.failure is None for point in points] == [True, False, True]
    assert "devices.0.position must lie on the span" in str(points[1].failure)
    assert points[1].tables["frequencies"] == []


def test_a_single_line_at_fault_raises() -> None:
    with pytest.raises(InvalidSpec, match=r"devices\.0\.position"):
        list(convert.run({"line": changed("devices.0.position_m", 200.0), "analysis": SHORT}))
