import numpy as np
import pytest

from app.plots import Options
from app.plots.canvas.sheet import settle
from app.plots.orbits import grid_of, picture
from tests.app.plots.drawn_motions import FACTS, NO_MOTIONS, SURROUNDED, motions
from tests.app.plots.seen import figure_of


def test_orbits_are_drawn_to_one_scale_with_equal_axes() -> None:
    sheet = picture(motions(), FACTS, Options())
    settle(sheet)
    scales = set()
    for panel in figure_of(sheet).axes:
        place = panel.get_position()
        (left, right), (bottom, top) = panel.get_xlim(), panel.get_ylim()
        across = place.width * sheet.width / (right - left)
        assert place.height * sheet.height / (top - bottom) == pytest.approx(across, rel=1e-9)
        scales.add(round(across, 1))
    assert len(figure_of(sheet).axes) == 4
    assert len(scales) == 1


def test_an_orbit_is_the_motion_of_its_coefficients() -> None:
    panel = figure_of(picture(motions(speeds=(4.0,), loops=(1,)), FACTS, Options())).axes[0]
    (line,) = panel.get_lines()
    across, up = np.asarray(line.get_data())
    assert (across.min(), across.max()) == (pytest.approx(0.0), pytest.approx(0.2))
    assert (up.min(), up.max()) == (pytest.approx(-0.2), pytest.approx(0.2))


def test_ellipse_and_phases_that_are_far_larger_have_a_panel_of_their_own() -> None:
    figure = figure_of(picture(motions(loops=(1,)), SURROUNDED, Options()))
    surrounded, *others = figure.axes
    assert surrounded.get_title() == "all orbits and what surrounds them"
    ellipse = surrounded.patches[0]
    assert ellipse.get_center() == (0.0, pytest.approx(1.2))
    assert (ellipse.width, ellipse.height) == (2.4, 6.0)
    assert [0.5, 7.0] in [line.get_xydata()[0].tolist() for line in surrounded.get_lines()]
    assert len(others) == 2
    assert not any(panel.patches for panel in others)


def test_many_wind_speeds_are_thinned_and_the_picture_says_so() -> None:
    speeds = tuple(np.linspace(3.0, 9.0, 41).tolist())
    figure = figure_of(picture(motions(speeds=speeds), FACTS, Options()))
    assert any("9 of 41 wind speeds are shown" in text.get_text() for text in figure.texts)
    assert len(figure.axes[0].get_lines()) == 9
    assert figure.axes[-1].get_ylabel() == "wind speed [m/s]"  # a bar of colours takes the place of nine entries


def test_quasi_periodic_motions_are_told() -> None:
    found = motions(loops=(1,))
    found["limit_cycles"][2]["kind"] = "quasi_periodic"
    texts = [text.get_text() for text in figure_of(picture(found, FACTS, Options())).texts]
    assert any("quasi-periodic motions (1) have no closed orbit" in text for text in texts)


def test_without_any_motion_there_is_still_a_sheet() -> None:
    assert figure_of(picture(NO_MOTIONS, FACTS, Options())).texts[0].get_text() == "C11 twin"


@pytest.mark.parametrize(
    ("panels", "width", "expected"), [(4, 1000.0, (1, 4)), (5, 1000.0, (2, 3)), (3, 400.0, (3, 1))]
)
def test_panels_fill_the_width(panels: int, width: float, expected: tuple[int, int]) -> None:
    assert grid_of(panels, width) == expected
