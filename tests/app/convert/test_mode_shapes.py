import pytest

from app import convert
from app.reference.source_lines import example
from tests.app.lines import SHORT

REQUEST = {"line": example("c11-twin"), "analysis": {**SHORT, "loops": [1, 2], "models": ["hybrid", "finite_element"]}}


def test_there_is_a_row_for_each_model_direction_and_number_of_loops() -> None:
    rows = convert.mode_shapes(REQUEST, 0)
    places = {(row["model"], row["direction"], row["loops"]) for row in rows}
    assert len(rows) == len(places) == 12
    row = rows[0]
    assert len(row["vertical"]) == len(row["longitudinal"]) == len(row["position_m"]) == 21
    assert max(row["vertical"]) == pytest.approx(1.0, abs=0.1)


def test_a_point_of_a_study_has_its_own_line() -> None:
    axes = [{"parameter": "span.length_m", "values": [100.0, 150.0]}]
    ends = [convert.mode_shapes({**REQUEST, "study": {"axes": axes}}, i)[0]["position_m"][-1] for i in (0, 1)]
    assert ends == pytest.approx([100.0, 150.0])


def test_a_line_at_fault_is_refused() -> None:
    slack = {**REQUEST["line"], "span": {"length_m": 125.88, "horizontal_tension_n": 10.0}}
    with pytest.raises(ValueError, match="horizontal_tension"):
        convert.mode_shapes({**REQUEST, "line": slack}, 0)
