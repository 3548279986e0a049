import re

import pytest

from app.pages.drawings.orbits import SIZE, Surroundings, ellipse_points, orbit_picture, orbit_scale
from app.pages.measures import FEET, SI
from app.pages.motions import Motion

MOTION = Motion(0, {}, {"vertical": [0.0, 0.5, 0.0], "horizontal": [0.0, 0.0, 0.1], "torsional": [0.0, 0.0, 0.0]})
LINE = {
    "bundle": {"subconductors": 2, "radius_m": 0.2, "orientation_deg": 90.0},
    "conductor": {"diameter_m": 0.03},
    "phases": [{"name": "top <b>", "y_m": 7.0, "z_m": 1.0}],
    "required_clearance_m": 1.5,
}


def test_the_foot_of_the_ellipse_lies_below_the_resting_wire() -> None:
    points = ellipse_points((6.0, 2.4, 1.8))
    assert min(y for _, y in points) == pytest.approx(-1.8)
    assert max(y for _, y in points) == pytest.approx(4.2)
    assert max(x for x, _ in points) == pytest.approx(1.2, rel=1e-3)


def test_everything_lies_within_the_drawing_at_one_scale() -> None:
    around = Surroundings(LINE, (6.0, 2.4, 1.8))
    scale = orbit_scale(MOTION, around)
    for point in [*ellipse_points((6.0, 2.4, 1.8)), (1.0, 8.5), (2.5, 7.0), (0.0, -0.5)]:  # with the clearance
        x, y = scale.place(point)
        assert 0.0 < x < SIZE[0]
        assert 0.0 < y < SIZE[1]
    across, up = (
        scale.place((1.0, 0.0))[0] - scale.place((0.0, 0.0))[0],
        scale.place((0.0, 0.0))[1] - scale.place((0.0, 1.0))[1],
    )
    assert across == pytest.approx(up)


def test_the_picture_has_a_path_for_each_wire_and_names_the_phases() -> None:
    drawn = str(orbit_picture(MOTION, Surroundings(LINE, None), SI, "Orbits"))
    assert drawn.count('class="path"') == 2
    assert "top &lt;b&gt;" in drawn
    assert "ellipse" not in drawn
    assert "[ft]" in str(orbit_picture(MOTION, Surroundings(LINE, None), FEET, "Orbits"))


@pytest.mark.parametrize("height", [0.4, 1.0, 3.0, 7.0, 9.3, 12.0, 14.5, 23.0, 61.0])
def test_no_figure_of_the_grid_lies_on_the_words_at_the_top(height: float) -> None:
    line = {**LINE, "phases": [{"name": "top", "y_m": height, "z_m": 0.0}]}
    for units in (SI, FEET):
        drawn = str(orbit_picture(MOTION, Surroundings(line, None), units, "Orbits"))
        figures = re.findall(r'<text x="2" y="([^"]+)" class="figures">', drawn)
        assert figures
        # The arrow of the wind ends at 32; figures are some 11 high above their foot.
        assert min(float(foot) - 11.0 for foot in figures) > 32.0
