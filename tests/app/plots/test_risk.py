from app import convert
from app.plots import Options
from app.plots.risk import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of

ROW = convert.example_tables()["risk"][0]


def test_hours_stand_in_their_intervals_with_the_probability_beside_them() -> None:
    rows = [ROW, {**ROW, "loops": None, "ice": None, "thickness_m": None, "probability_a_year": None}]
    (panel,) = figure_of(picture({"risk": rows}, FACTS, Options())).axes
    assert [label.get_text() for label in panel.get_yticklabels()] == ["glaze 12 mm, 1 loop", "any ice, any loops"]
    assert panel.collections[0].get_segments()[0].tolist() == [[3.1, 0.0], [12.7, 0.0]]
    assert panel.get_lines()[0].get_xydata().tolist() == [[6.4, 0.0]]
    assert [text.get_text() for text in panel.texts] == ["probability 0.62 (0.31 to 0.93)"]
    assert panel.get_xlabel() == "galloping [h a year]"


def test_a_long_table_is_cut_and_an_absent_climate_told() -> None:
    figure = figure_of(picture({"risk": [ROW] * 30}, FACTS, Options()))
    assert any("6 further rows of the table risk are not shown." in text.get_text() for text in figure.texts)
    (panel,) = figure_of(picture({"risk": []}, FACTS, Options())).axes
    assert panel.texts[0].get_text() == "the line has no climate"
