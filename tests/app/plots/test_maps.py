import io
from xml.etree import ElementTree

import pytest
from matplotlib.image import imread

from app import plots
from app.plots.maps import _quantities, _ticks
from tests.app.plots.drawn_studies import NOTHING, study

AXES = ("span.horizontal_tension_n", "span.length_m")


def test_a_map_shows_the_lowest_onset_and_the_largest_lasting_motion() -> None:
    one = study(*AXES, winds=(4.0, 6.0))
    (_, critical), (name, vertical), (_, horizontal) = _quantities(one.found, AXES, 6.0)
    assert name.endswith("at 6 m/s")
    assert critical("hybrid", 1) == {(24e3, 100.0): 2.0, (24e3, 126.0): 3.0, (30e3, 100.0): 4.0, (30e3, 126.0): 5.0}
    assert vertical("hybrid", 1)[30e3, 126.0] == pytest.approx(0.4)
    assert set(horizontal("hybrid", 1).values()) == {0.12}
    assert critical("finite_element", 1) == {}


def test_numbers_rise_along_an_axis_and_words_stay_as_they_come() -> None:
    found = {"static": [{"a": 2.0, "b": "z"}, {"a": 1.0, "b": "y"}], "failures": [{"a": 3.0, "b": "z"}]}
    assert _ticks(("a", "b"), found) == [[1.0, 2.0, 3.0], ["z", "y"]]


@pytest.mark.parametrize("failures", [0, 1])
@pytest.mark.parametrize("axes", [AXES, ("damping.model", "span.length_m")])
def test_two_axes_make_a_map(axes: tuple[str, str], failures: int) -> None:
    one = study(*axes, failures=failures)
    svg = plots.study("C11 twin", {"": one}, "svg")
    assert ElementTree.fromstring(svg).tag.endswith("svg")
    picture = imread(io.BytesIO(plots.study("C11 twin", {"": one}, "png")), format="png")
    assert float(picture[..., :3].std()) > 0.01


def test_a_map_of_nothing_is_a_picture() -> None:
    empty = plots.Study(AXES, 126.0, NOTHING.found)
    assert ElementTree.fromstring(plots.study("C11 twin", {"": empty}, "svg")).tag.endswith("svg")
