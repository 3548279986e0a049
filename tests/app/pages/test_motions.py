import math

import pytest

from app.pages.motions import Motion, course, worst


def test_a_course_is_the_sum_of_its_waves() -> None:
    found = course([0.5, 1.0, 0.0, 0.0, 2.0], 8)
    angles = [2.0 * math.pi * number / 8 for number in range(8)]
    assert found == pytest.approx([0.5 + math.cos(angle) + 2.0 * math.sin(2.0 * angle) for angle in angles])


def motion(number: int, stability: str, vertical: float) -> Motion:
    row = {"stability": stability, "vertical_m": vertical, "frequency_hz": 0.25, "wind_speed_m_per_s": 4.0}
    return Motion(number, row, {})


def test_the_verdict_is_about_the_largest_stable_motion() -> None:
    found = worst([motion(0, "stable", 0.1), motion(1, "unstable", 0.9), motion(2, "stable", 0.3)])
    assert found is not None
    assert found.number == 2
    assert found.period == 4.0
    assert worst([motion(0, "unknown", 0.4)]) is None
