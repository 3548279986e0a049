import re

import pytest

from app.pages.drawings.phase_places import phase_places
from app.pages.measures import FEET, SI

LINE = {
    "bundle": {"subconductors": 2, "radius_m": 0.2, "orientation_deg": 90.0},
    "phases": [{"name": "top", "y_m": 3.0, "z_m": 4.0}, {"name": "wire", "y_m": 9.0, "z_m": 0.0}],
    "required_clearance_m": 1.5,
}


def test_phases_are_named_with_their_distance_and_drawn_to_one_scale() -> None:
    drawn = str(phase_places(LINE, SI))
    assert "top, 5.00 m" in drawn
    assert drawn.count('class="phase"') == drawn.count('class="clear"') == 2
    assert "top, 16.4 ft" in str(phase_places(LINE, FEET))
    places = [(float(x), float(y)) for x, y in re.findall(r'cx="([\d.]+)" cy="([\d.]+)" r="4" class="phase"', drawn)]
    (x1, y1), (x2, y2) = places
    assert (x1 - x2) / 4.0 == pytest.approx((y1 - y2) / 6.0, rel=1e-4)


def test_a_line_by_itself_has_no_such_drawing() -> None:
    assert phase_places({**LINE, "phases": []}, SI) is None


def test_interphase_spacers_tie_the_phases_that_they_name() -> None:
    devices = [
        {"type": "interphase_spacer", "between": pair} for pair in (["this", "top"], ["top", "wire"], ["top", "x"])
    ]
    assert str(phase_places({**LINE, "devices": devices}, SI)).count('class="tie"') == 2


def test_a_phase_that_is_nearer_than_required_is_named_so() -> None:
    drawn = str(phase_places({**LINE, "required_clearance_m": 6.0}, SI))
    assert "top, 5.00 m: nearer than required" in drawn
    assert "wire, 9.00 m<" in drawn
    assert " m</text>" in drawn
