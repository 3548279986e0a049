from typing import Any

from app import convert
from app.plots import Options
from app.plots.canvas.themes import LIGHT
from app.plots.clearances import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of

ROW = convert.example_tables()["clearances"][0]


def row(other: str, distance: float | None, **changes: Any) -> dict[str, Any]:
    ok = None if distance is None else distance >= 1.5
    return {**ROW, "other_phase": other, "distance_m": distance, "ok": ok, **changes}


def test_the_nearest_pair_is_on_top_with_its_smallest_distances() -> None:
    rows = [row("far", 6.0), row("near", 3.0), row("near", 1.0), row("near", 0.1, stability="unstable")]
    ellipse = row("near", -0.5, method="cigre", stability=None)
    (panel,) = figure_of(picture({"clearances": [*rows, ellipse]}, FACTS, Options())).axes
    assert [label.get_text() for label in panel.get_yticklabels()] == ["this line\nnear", "this line\nfar"]
    places = [line.get_xydata().tolist()[0] for line in panel.get_lines()[:3]]
    assert places == [[1.0, 0.0], [-0.5, 0.0], [6.0, 1.0]]
    colours = [line.get_color() for line in panel.get_lines()[:3]]
    assert colours == [LIGHT.bad, LIGHT.bad, LIGHT.good]
    required = panel.collections[0].get_segments()[0]
    assert required[:, 0].tolist() == [1.5, 1.5]


def test_what_is_not_drawn_is_told() -> None:
    many = [row(f"wire {number}", 1.0 + number) for number in range(16)]
    figure = figure_of(picture({"clearances": [*many, row("wire 0", None, method="cigre")]}, FACTS, Options()))
    told = next(text.get_text() for text in figure.texts if "further pairs" in text.get_text())
    assert told.startswith("2 further pairs are farther apart; 1 distances are not known")
    assert len(figure.axes[0].get_yticks()) == 14


def test_a_line_alone_says_so() -> None:
    (panel,) = figure_of(picture({"clearances": []}, FACTS, Options())).axes
    assert panel.texts[0].get_text() == "no other phase is given"
