import re

import pytest

from app.pages.drawings.wind_profiles import wind_profile
from app.pages.measures import FEET, SI

PROFILE = [{"position_m": 0.0, "factor": 0.6}, {"position_m": 150.0, "factor": 1.2}]
LINE = {"span": {"length_m": 300.0}, "wind": {"profile": PROFILE}}


def test_the_profile_is_drawn_from_zero_and_held_outside_its_points() -> None:
    text = str(wind_profile(LINE, SI))
    found = re.search(r'd="M([^"]*)" class="path"', text)
    assert found is not None
    points = [tuple(map(float, point.split())) for point in found[1].split("L")]
    ground = 90.0 - 22.0
    assert (ground - points[0][1]) / (ground - points[2][1]) == pytest.approx(0.5)
    assert (points[2][0], points[3][0]) == (280.0, 534.0)
    assert points[3][1] == points[2][1]
    assert ">0.600</text>" in text
    assert " ft</text>" in str(wind_profile(LINE, FEET))


def test_a_uniform_wind_has_no_drawing() -> None:
    assert wind_profile({"span": {"length_m": 300.0}, "wind": {"profile": []}}, SI) is None
