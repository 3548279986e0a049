from typing import Any

import numpy as np
import pytest

from app.plots import Abscissa, Facts, Options
from app.plots.parts.paths import label_of
from app.plots.studies import Study, curves, drawn_together, label, picture
from tests.app.plots.drawn_studies import NOTHING, VALUES, study
from tests.app.plots.seen import figure_of


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
    assert label([axis], "parameter") == label_of(axis)


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
@pytest.mark.parametrize("abscissa", ["reduced", "parameter"])
def test_pictures_are_whole_whatever_was_varied(drawn: Study, abscissa: Abscissa) -> None:
    facts = Facts("C11 twin", length=125.0, axes=tuple(drawn.axes))
    panels = figure_of(picture(drawn.found, facts, Options(abscissa=abscissa))).axes
    assert [panel.get_xlabel() for panel in panels] == [label(drawn.axes, abscissa)] * 3
    assert panels[0].get_ylabel() == "amplitude over sag (A_y / s_a)"


def test_points_stand_at_their_ratios() -> None:
    panels = figure_of(
        picture(study("span.length_m").found, Facts("x", length=125.0, axes=("span.length_m",)), Options())
    ).axes
    (line,) = panels[0].get_lines()
    assert np.asarray(line.get_data()).tolist() == [
        pytest.approx([100.0 / 1.5, 126.0 / 1.6]),
        pytest.approx([0.1, 0.2]),
    ]


def test_failed_points_are_counted() -> None:
    broken = study("span.length_m", failures=2)
    figure = figure_of(picture(broken.found, Facts("x", length=125.0, axes=("span.length_m",)), Options()))
    assert "2 points failed" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_several_lines_are_drawn_together() -> None:
    both = {"twin": study("span.length_m"), "quad": study("span.length_m")}
    svg = drawn_together("Spans", both, Options())
    assert b"twin" in svg
    assert b"quad" in svg
    assert svg == drawn_together("Spans", both, Options())
