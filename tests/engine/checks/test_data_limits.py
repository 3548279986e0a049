"""How far the data carry a motion, at the limits themselves."""

import math

import numpy as np
import pytest

from engine.checks.data_limits import LARGEST_ANGLE, motion_outcomes
from engine.outcome import Outcome

CONVERGED, BEYOND, OUTSIDE = Outcome.CONVERGED, Outcome.BEYOND_DATA, Outcome.OUTSIDE_FIT


def test_an_angle_is_held_against_the_fitted_range_or_thirty_degrees() -> None:
    assert math.degrees(LARGEST_ANGLE) == pytest.approx(30.0, rel=1e-12)
    degrees = np.array([29.0, 31.0, 29.0, 31.0, 31.0])
    ranges = np.array([np.inf, np.inf, 20.0, 40.0, 30.5])
    small, sag, slow = np.full((2, 5), 0.1), np.full(5, 2.0), np.zeros(5, dtype=np.bool_)
    found = motion_outcomes(np.radians(degrees), np.radians(ranges), slow, small, sag)
    assert found == [CONVERGED, BEYOND, OUTSIDE, CONVERGED, OUTSIDE]


def test_an_amplitude_is_held_against_the_sag_in_both_directions() -> None:
    amplitudes = np.array([[0.9, 1.1, 0.9, 1.1], [0.9, 0.9, 1.1, 0.9]])
    ranges = np.array([np.inf, np.inf, 1.0, 0.05])
    fast = np.zeros(4, dtype=np.bool_)
    found = motion_outcomes(np.full(4, 0.1), ranges, fast, amplitudes, np.ones(4))
    assert found == [CONVERGED, BEYOND, BEYOND, OUTSIDE]
    fast[0] = True
    assert motion_outcomes(np.full(4, 0.1), ranges, fast, amplitudes, np.ones(4))[0] is OUTSIDE
