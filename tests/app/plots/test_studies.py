import io
from typing import Any
from xml.etree import ElementTree

import pytest
from matplotlib.image import imread

from app import plots
from app.plots.studies import _label, curves
from tests.app.plots.drawn_studies import NOTHING, VALUES, study


@pytest.mark.parametrize(
    ("axes", "expected"),
    [
        ((), [4.0 / 60.0]),
        (("damping.vertical_ratio",), [2.0 / 60.0, 3.0 / 60.0, 4.0 / 60.0]),
        (("span.horizontal_tension_n",), [1200.0 / 125.0, 1201.0 / 125.0]),
        (("span.length_m",), [100.0 / 1.5, 126.0 / 1.6]),
        (("damping.model",), VALUES["damping.model"]),
    ],
)
def test_cycles_stand_over_the_ratio_of_the_source(axes: tuple[str, ...], expected: list[Any]) -> None:
    (series,) = curves({"": study(*axes)}, "reduced")
    places = [place for place, _ in series.points]
    assert places == (pytest.approx(expected) if isinstance(expected[0], float) else expected)


@pytest.mark.parametrize("axis", VALUES)
def test_cycles_stand_over_the_values_themselves_if_that_is_wanted(axis: str) -> None:
    (series,) = curves({"": study(axis)}, "parameter")
    assert [place for place, _ in series.points] == VALUES[axis]
    assert _label([axis], "parameter") == axis


def test_each_wind_speed_and_each_line_is_a_series() -> None:
    both = {"twin": study("span.length_m", winds=(4.0, 6.0)), "quad": study("span.length_m", winds=(4.0, 6.0))}
    series = list(curves(both, "reduced"))
    assert [one.name for one in series] == ["twin, 4 m/s", "twin, 6 m/s", "quad, 4 m/s", "quad, 6 m/s"]
    assert len({one.colour for one in series}) == 4


@pytest.mark.parametrize(
    "drawn",
    [*(study(axis) for axis in VALUES), study(), study("span.length_m", winds=(4.0, 5.0), failures=1), NOTHING],
    ids=lambda one: ",".join(one.axes) or "no axis",
)
def test_pictures_are_whole_whatever_was_varied(drawn: plots.Study) -> None:
    svg = plots.study("C11 twin", {"": drawn}, "svg")
    assert ElementTree.fromstring(svg).tag.endswith("svg")
    assert svg == plots.study("C11 twin", {"": drawn}, "svg")
    picture = imread(io.BytesIO(plots.study("C11 twin", {"": drawn}, "png", "parameter")), format="png")
    assert float(picture[..., :3].std()) > 0.01


def test_failed_points_are_counted() -> None:
    whole, broken = study("span.length_m"), study("span.length_m", failures=2)
    assert plots.study("x", {"": whole}, "svg") != plots.study("x", {"": broken}, "svg")
