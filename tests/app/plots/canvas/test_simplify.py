import numpy as np
import pytest

from app.plots.canvas.simplify import kept_points


def test_points_of_a_straight_line_are_left_out() -> None:
    points = np.column_stack([np.linspace(0.0, 10.0, 50), np.linspace(0.0, 5.0, 50)])
    assert np.flatnonzero(kept_points(points, 0.1)).tolist() == [0, 49]


@pytest.mark.parametrize("tolerance", [0.01, 0.1, 1.0])
def test_a_circle_stays_within_the_tolerance(tolerance: float) -> None:
    phase = np.linspace(0.0, 2.0 * np.pi, 2001)
    points = 100.0 * np.column_stack([np.cos(phase), np.sin(phase)])
    kept = points[kept_points(points, tolerance)]
    middles = 0.5 * (kept[:-1] + kept[1:])
    assert np.hypot(*middles.T).min() > 100.0 - 1.05 * tolerance
    assert len(kept) < 2.5 * np.pi / np.sqrt(2.0 * tolerance / 100.0)


def test_corners_stay() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]])
    assert kept_points(points, 0.1).tolist() == [True, False, True, False, True]


def test_a_closed_path_keeps_its_far_side() -> None:
    points = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 0.0]])
    assert kept_points(points, 0.1).all()
