from typing import Any

import numpy as np
import pytest

from app import convert
from app.plots import Options
from app.plots.canvas.sheet import settle
from app.plots.verdict import picture
from tests.app.plots.drawn_motions import FACTS, NO_MOTIONS, SURROUNDED, Tables, motions
from tests.app.plots.seen import figure_of


def found(**changes: Any) -> Tables:
    row = convert.example_tables()["verdict"][0]
    worst = {"worst_loops": 1, "worst_wind_m_per_s": 6.0, "vertical_peak_to_peak_m": 0.6}
    return {**motions(), "verdict": [{**row, **worst, **changes}], "clearances": []}


def test_the_sentence_stands_above_both_panels() -> None:
    figure = figure_of(picture(found(sentence="Gallops from 2.3 m/s."), FACTS, Options()))
    assert "Gallops from 2.3 m/s." in [text.get_text() for text in figure.texts]
    assert len(figure.axes) == 2


def test_the_span_hangs_with_its_sag_and_moves_as_far_as_its_worst_motion() -> None:
    side = figure_of(picture(found(), FACTS, Options())).axes[0]
    wire = np.asarray(side.get_lines()[0].get_data())
    assert wire[1].min() == pytest.approx(-1.5)
    reach = side.collections[0].get_paths()[0].vertices
    assert (reach[:, 1].min(), wire[0, [0, -1]].tolist()) == (pytest.approx(-1.8), [0.0, 126.0])


def test_heights_are_as_many_times_larger_as_the_title_says() -> None:
    sheet = picture(found(), FACTS, Options())
    settle(sheet)
    panel = figure_of(sheet).axes[0]
    place, (bottom, top) = panel.get_position(), panel.get_ylim()
    times = place.height * sheet.height / (top - bottom) / (place.width * sheet.width / 126.0)
    assert panel.get_title() == f"span from the side, heights {times:g} times larger"
    assert times in {2.0, 5.0, 10.0, 20.0, 50.0}


def test_the_cross_section_has_equal_axes_and_the_paths_of_the_sub_conductors() -> None:
    sheet = picture(found(), FACTS, Options())
    settle(sheet)
    panel = figure_of(sheet).axes[1]
    place, (left, right), (bottom, top) = panel.get_position(), panel.get_xlim(), panel.get_ylim()
    assert place.height * sheet.height / (top - bottom) == pytest.approx(place.width * sheet.width / (right - left))
    paths = [np.asarray(line.get_data()) for line in panel.get_lines() if len(line.get_xydata()) > 100]
    assert len(paths) == 2
    # z + W + y Theta with W = 0.1 + 0.15 sin; y + V - z Theta with V = 0.3 cos and Theta = 0.01 cos.
    assert paths[0][0].max() == pytest.approx(0.2 + 0.25)
    assert paths[0][1].max() == pytest.approx(0.3 + 0.2 * -0.01)


def test_phases_and_the_smallest_distance_are_shown() -> None:
    row = {"distance_m": 1.26, "required_m": 1.5, "method": "computed", "stability": "stable"}
    figure = figure_of(picture({**found(), "clearances": [row]}, SURROUNDED, Options()))
    assert figure.axes[1].get_xlabel().endswith("smallest distance 1.26 m, required 1.50 m")
    assert len(figure.axes[0].get_lines()) == 1 + 2 + 2  # the span, two phases, two supports


@pytest.mark.parametrize("gallops", ["no", "undecided"])
def test_a_line_that_rests_is_drawn_at_rest(gallops: str) -> None:
    rests = found(gallops=gallops, vertical_peak_to_peak_m=None)
    figure = figure_of(picture(rests, FACTS, Options(theme="dark")))
    assert figure.axes[1].get_title() == "cross-section at rest"
    assert "no lasting motion of known size" in [text.get_text() for text in figure.axes[0].texts]


def test_without_a_verdict_it_says_so() -> None:
    texts = [text.get_text() for text in figure_of(picture({**NO_MOTIONS, "verdict": []}, FACTS, Options())).texts]
    assert "There is no verdict: nothing was computed." in texts
