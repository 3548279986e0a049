"""Branches of cycles over the wind speed against exact ones."""

import numpy as np
import pytest

from engine.cycles.branches import follow_from_hopf_points
from engine.cycles.harmonic_balance import half_peak_to_peak
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel
from tests.builders import Oscillators, hand_made


def one_degree_of_freedom() -> ReducedModel:
    """Return m (y'' + 2 zeta w y' + w^2 y) = U^2 (a_1 v - a_3 v^3), v = y'/U, with m = w = 1 (section 11)."""
    zeta, terms = 0.005, {(0, (1,)): 0.01, (0, (1, 1, 1)): -0.04}
    return hand_made(Oscillators(np.eye(1), np.array([[2.0 * zeta]]), np.eye(1), terms))


def test_branch_of_one_degree_of_freedom_is_the_exact_parabola() -> None:
    # a_1 U - 2 zeta - (3/4) a_3 (w A)^2 / U = 0 to first order in the small damping (theory section 11).
    model = one_degree_of_freedom()
    crossings = critical_wind_speeds(model, 30.0)
    assert crossings.wind_speed == pytest.approx([1.0])
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 5, np.array([3.0]))
    speed = branch_set.orbits.wind_speed[1:]
    amplitude = half_peak_to_peak(branch_set.orbits.coefficients)[1:, 0]
    assert speed[-1] > 3.0
    assert amplitude**2 == pytest.approx((0.01 * speed**2 - 0.01 * speed) / (0.75 * 0.04), rel=1e-3)


def test_van_der_pol_branch_has_amplitude_two() -> None:
    # y'' - mu (1 - y^2) y' + y = 0 for every wind speed: the load is U^2 (mu v / U - mu y^2 v / U) at U = 1.
    mu = 0.01
    terms = {(0, (1,)): 2.0 * mu, (0, (0, 0, 1)): -mu}
    model = hand_made(Oscillators(np.eye(1), np.array([[mu]]), np.eye(1), terms))
    crossings = critical_wind_speeds(model, 5.0)
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 5, np.array([1.0]))
    index = int(np.abs(branch_set.orbits.wind_speed - 1.0).argmin())
    speed = branch_set.orbits.wind_speed[index]
    # mu (2 U - 1 - U y^2) y': amplitude 2 sqrt((2 U - 1) / U).
    amplitude = half_peak_to_peak(branch_set.orbits.coefficients)[index, 0]
    assert crossings.wind_speed == pytest.approx([0.5])
    assert amplitude == pytest.approx(2.0 * np.sqrt((2.0 * speed - 1.0) / speed), rel=1e-3)
