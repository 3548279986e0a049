from typing import Any

import numpy as np
import pytest

from app.plots import Facts, Options
from app.plots.maps import _quantities, _ticks, map_sheet
from tests.app.plots.drawn_studies import NOTHING, study
from tests.app.plots.seen import figure_of

AXES = ("span.horizontal_tension_n", "span.length_m")


def test_a_map_shows_the_lowest_onset_and_the_largest_lasting_motion() -> None:
    one = study(*AXES, winds=(4.0, 6.0))
    (_, critical), (name, vertical), (_, horizontal) = _quantities(one.found, AXES, 6.0)
    assert name.endswith("(A_y / s_a), 6 m/s")
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
    panels = figure_of(map_sheet(one.found, Facts("C11 twin", axes=axes), Options())).axes
    maps = [panel for panel in panels if panel.get_xlabel()]
    assert [panel.get_xlabel() for panel in maps] == ["span: length [m]"] * 3
    assert maps[0].get_title() == "critical wind speed [m/s]\nhybrid model, 1 loop"
    values = np.ma.compressed(maps[0].collections[0].get_array())
    assert values[np.isfinite(values)].tolist() == [2.0, 3.0, 4.0, 5.0]
    assert len(maps[0].get_lines()) == failures  # crosses


def test_panels_of_one_quantity_have_one_scale() -> None:
    found = study(*AXES).found
    twice: dict[str, Any] = {
        name: [*rows, *({**row, "loops": 2} for row in rows if "loops" in row)] for name, rows in found.items()
    }
    for row in twice["critical_wind_speeds"]:
        if row["loops"] == 2:
            row["wind_speed_m_per_s"] *= 3.0
    panels = figure_of(map_sheet(twice, Facts("x", axes=AXES), Options())).axes
    limits = [panel.collections[0].get_clim() for panel in panels if panel.get_title().startswith("critical")]
    assert limits == [(0.0, 15.0), (0.0, 15.0)]


def test_a_map_of_nothing_is_a_picture() -> None:
    assert len(figure_of(map_sheet(NOTHING.found, Facts("x", axes=AXES), Options())).axes) == 1
