"""Branches of tori: born at an exact torus point, and from one torus point of a line to the other."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.aerodynamics import force
from engine.arrays import FloatArray
from engine.bifurcations import bifurcations
from engine.branches import passed, traced_from_hopf
from engine.hybrid import ReducedModel, take
from engine.stability import critical_wind_speeds
from engine.torus import Tori, balance, lattice, phasors, resized, states, tori_of
from engine.torus_branches import born_at_torus_points, traced
from engine.torus_lines import base_frequencies, base_lines, line_strengths
from tests.engine.test_bifurcations import LIGHT, analysed
from tests.engine.tori import FREQUENCIES, coupled_circles

ONE = np.zeros(1, dtype=np.intp)
COUPLING, LINEAR = (0.4, 1.0), (2.0, 3.0)


def averaged(wind: float) -> FloatArray:
    """Return the radii of `coupled_circles` to first order in the growth.

    The mean of U q^2 + q'^2 / (U w^2) beside q' is r^2 (U + 3 / U) / 4 in its own motion, r^2 (U + 1 / U) / 2 in that
    of the other.
    """
    own, other = 0.25 * (wind + 3.0 / wind), 0.5 * (wind + 1.0 / wind)
    matrix = [[own, COUPLING[0] * other], [COUPLING[1] * other, own]]
    return np.asarray(np.sqrt(np.linalg.solve(matrix, [slope * wind - slope + 1.0 for slope in LINEAR])))


def test_branch_from_an_exact_torus_point() -> None:
    # The first oscillator alone runs on a circle of radius 1 at U = 1, where it just holds the second one at rest.
    model, winds = coupled_circles(COUPLING, LINEAR), np.array([1.02, 1.2])
    crossings = critical_wind_speeds(model, 5.0)
    trace = traced_from_hopf(model, crossings, np.array([0]), 5, winds)
    found = bifurcations((trace,), ONE, model, crossings)
    births = born_at_torus_points(model, (trace,), found, np.ones(found.member.size, dtype=np.bool_), (3, 2))
    assert births.tori.wind_speed == pytest.approx([1.0], abs=1e-6)
    points = traced(model, births, winds)
    _, wind, guess = passed(points, winds)
    tori, solution = balance(model, np.zeros(2, dtype=np.intp), tori_of(guess, 2, (3, 2)))
    assert solution.converged.all()
    assert wind.tolist() == [0, 1]
    for i, speed in enumerate(winds):
        torus = tori.pick(np.array([i]))
        assert base_frequencies(model, ONE, torus)[0] == pytest.approx(np.array([FREQUENCIES]), rel=2e-3)
        lines = base_lines(line_strengths(model, ONE, torus)[0], lattice(torus.order).pairs)
        amplitude = np.abs(phasors(torus.coefficients[0]))
        assert amplitude[[0, 1], lines] == pytest.approx(averaged(speed), rel=0.01)


def followed(model: ReducedModel, torus: Tori, periods: float) -> tuple[FloatArray, FloatArray]:
    """Integrate from a torus, and evaluate it at the same times: (samples, 2 m) each, of q and q'."""
    speed, m = float(torus.wind_speed[0]), model.mass.shape[-1]
    inverse = np.linalg.inv(model.mass[0])

    def rate(_: float, y: FloatArray) -> FloatArray:
        load = force(take(model, 0).load, np.append(y[:m], y[m:] / speed)[None])[0]
        return np.append(y[m:], inverse @ (speed**2 * load - model.stiffness[0] @ y[:m] - model.damping[0] @ y[m:]))

    times = np.linspace(0.0, periods * 2.0 * np.pi / torus.angular_frequency[0, 0], 200)
    expected = states(torus, times[:, None] * torus.angular_frequency[0])[0] * np.repeat([1.0, speed], m)
    run = solve_ivp(rate, (0.0, times[-1]), expected[0], method="DOP853", t_eval=times, rtol=1e-9, atol=1e-11)
    return run.y.T, expected


def test_branch_joins_both_torus_points_of_the_single_conductor() -> None:
    model, cycles, found = analysed(1, LIGHT, 2)
    births = born_at_torus_points(model, cycles.traces, found, found.may_end_stability, (3, 2))
    assert sorted(births.tori.wind_speed) == pytest.approx([7.8004, 10.1183], abs=1e-3)
    winds = np.array([7.0, 9.0, 12.0])
    points = traced(model, births, winds)
    for branch in (0, 1):  # from one end to the other, where it turns into the other cycle
        wind = points.z[points.branch == branch, -1]
        assert (wind.min(), wind.max()) == pytest.approx((7.80, 10.12), abs=0.02)
    _, at, guess = passed(points, winds)
    assert at.tolist() == [1, 1]
    tori, solution = balance(model, np.zeros(2, dtype=np.intp), resized(tori_of(guess, 3, (3, 2)), (5, 4)))
    assert solution.converged.all()
    frequencies, _ = base_frequencies(model, np.zeros(2, dtype=np.intp), tori)
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-6)
    reached, expected = followed(model, tori.pick(np.array([0])), 60.0)
    assert reached == pytest.approx(expected, abs=2e-4 * np.abs(expected).max())
