import pytest

from app import convert
from app.plots import Options
from app.plots.tensions import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of

ROW = convert.example_tables()["tensions"][0]


def test_bars_go_from_the_smallest_to_the_largest_tension_in_kilonewtons() -> None:
    rows = [ROW, {**ROW, "model": "finite_element", "loops": 2, "stability": "unstable"}]
    first, second = figure_of(picture({"tensions": rows}, FACTS, Options())).axes
    (segment,) = first.collections[0].get_segments()
    assert segment[:, 1].tolist() == [pytest.approx(28.617), pytest.approx(32.095)]
    assert [first.collections[0].get_alpha(), second.collections[0].get_alpha()] == [1.0, 0.35]
    assert first.get_ylim() == second.get_ylim()
    assert list(first.get_lines()[0].get_ydata()) == [30.0, 30.0]  # at rest
    assert first.get_ylabel() == "tension [kN]"


def test_bars_of_both_models_stand_beside_each_other() -> None:
    rows = [{**ROW, "model": model} for model in ("hybrid", "finite_element")]
    (panel,) = figure_of(picture({"tensions": rows}, FACTS, Options())).axes
    left, right = (bar.get_segments()[0][0, 0] for bar in panel.collections)
    assert left < 10.0 < right


def test_slack_conductors_are_told_and_an_empty_table_says_why() -> None:
    slack = {**ROW, "smallest_at_support_n": None, "largest_at_support_n": None}
    figure = figure_of(picture({"tensions": [slack]}, FACTS, Options()))
    assert any("would go slack, without bars: 1." in text.get_text() for text in figure.texts)
    assert "neglects stretching" in figure.axes[0].texts[0].get_text()
